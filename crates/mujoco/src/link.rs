//! The links of a whisker in the world.

use nalgebra::{Rotation3, Vector3};

use vibrissa_runtime::math;
use vibrissa_runtime::rig::Whisker;
use vibrissa_world::geometry::{Point2, Pose, unit};

/// A link of a whisker.
#[derive(Debug, Clone, Copy)]
pub(super) struct Link {
    /// Near end (m, world frame).
    pub(super) start: Point2,
    /// Height of the near end above the plane of the bases (m).
    pub(super) height: f64,
    /// Direction in the plane (rad, world frame).
    pub(super) direction: f64,
    /// Angle above the plane (rad).
    elevation: f64,
}

impl Link {
    /// The point of the axis at this distance (m) from the near end, and its height above the plane (m).
    pub(super) fn point(&self, along: f64) -> (Point2, f64) {
        let (sin, cos) = math::sin_cos(self.elevation);
        (self.start + along * cos * unit(self.direction), self.height + along * sin)
    }

    /// The distance (m) of a point of the plane from the near end, along the axis.
    pub(super) fn along(&self, point: Point2) -> f64 {
        (point - self.start).dot(&unit(self.direction)) / math::cos(self.elevation)
    }
}

/// Computes the links one after the other.
#[derive(Debug)]
pub(super) struct LinkEnds {
    start: Point2,
    height: f64,
    /// Direction of the last link in the plane (rad, world frame).
    direction: f64,
    /// The frame of the last link in a spatial chain.
    frame: Option<Rotation3<f64>>,
    length: f64,
}

impl LinkEnds {
    /// Begins at the base of a whisker of a platform at `body`. The base hinge has the angles `hinge` (rad).
    pub(super) fn new(whisker: &Whisker, body: &Pose, hinge: [f64; 2], is_spatial: bool) -> Self {
        let direction = body.heading + whisker.direction_body;
        let base = || rotation([direction, -whisker.pitch]) * rotation(hinge);
        Self {
            start: body.point_to_world(whisker.base_body),
            height: 0.0,
            direction: direction + hinge[0],
            frame: is_spatial.then(base),
            length: whisker.shaft.link_length(),
        }
    }

    /// The next link. Relative to its predecessor, it has the angle `rest` (rad) at rest, and is deflected by `angles`
    /// (rad).
    pub(super) fn next_link(&mut self, rest: f64, [vertical, transverse]: [f64; 2]) -> Link {
        let mut elevation = 0.0;
        if let Some(frame) = &mut self.frame {
            *frame *= rotation([rest + vertical, transverse]);
            let axis = *frame * Vector3::x();
            self.direction = math::atan2(axis.y, axis.x);
            elevation = math::atan2(axis.z, math::hypot(axis.x, axis.y));
        } else {
            self.direction += rest + vertical;
        }
        let link = Link { start: self.start, height: self.height, direction: self.direction, elevation };
        (self.start, self.height) = link.point(self.length);
        link
    }
}

/// The rotation by an angle about the vertical axis, and then by one about the transverse axis (rad).
fn rotation([vertical, transverse]: [f64; 2]) -> Rotation3<f64> {
    Rotation3::from_axis_angle(&Vector3::z_axis(), vertical)
        * Rotation3::from_axis_angle(&Vector3::y_axis(), transverse)
}
