//! The part of a known object that a whisker touches.

use crate::geometry::{Point2, Pose};

/// The part of a known object that a whisker touches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Obstacle {
    /// A round pin, or an edge if the radius is 0.
    Pin {
        /// Position of the axis (m).
        centre: Point2,
        /// Radius (m).
        radius: f64,
    },
    /// A flat face. Only the tip touches it.
    Face {
        /// A point of the face (m).
        point: Point2,
        /// Direction of the surface normal, towards the whisker (rad).
        normal: f64,
    },
}

impl Obstacle {
    /// The obstacle in a local frame with the pose `frame`.
    #[must_use]
    pub fn seen_from(&self, frame: Pose) -> Self {
        match *self {
            Self::Pin { centre, radius } => Self::Pin { centre: frame.point_from_world(centre), radius },
            Self::Face { point, normal } => {
                Self::Face { point: frame.point_from_world(point), normal: normal - frame.heading }
            }
        }
    }

    /// The mirror image at the first axis.
    pub(super) fn mirrored(&self) -> Self {
        let mirror = |point: Point2| Point2::new(point.x, -point.y);
        match *self {
            Self::Pin { centre, radius } => Self::Pin { centre: mirror(centre), radius },
            Self::Face { point, normal } => Self::Face { point: mirror(point), normal: -normal },
        }
    }
}
