//! The camera.

use nalgebra::{Point3, Vector3};

use vibrissa_runtime::math;
use vibrissa_world::geometry::{BoundingBox, Point2};
use vibrissa_world::world::raised;

/// Vertical angle of view (rad).
const FIELD_OF_VIEW: f64 = 40.0_f64.to_radians();
/// Elevation of the direction of view (rad): steeply downwards, so that objects have sides and hide little.
const ELEVATION: f64 = -60.0_f64.to_radians();
/// The share of half the picture that the shown area takes at most.
const FILLED: f64 = 0.94;

/// A camera that looks down at an area of the plane. x of the world is to the right in the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// The position of the camera (m, world frame).
    pub position: Point3<f64>,
    /// The point in the middle of the picture (m, world frame).
    pub looks_at: Point3<f64>,
    /// Vertical angle of view (rad).
    pub field_of_view: f64,
}

impl Camera {
    /// The nearest camera that has the whole area at heights from `-top` to `top` (m) in its picture, whose width is `aspect` times its
    /// height.
    #[must_use]
    pub fn around(area: &BoundingBox, top: f64, aspect: f64) -> Self {
        let (ahead, right, up) = frame();
        let middle = area.min + 0.5 * (area.max - area.min);
        let looks_at = Point3::new(middle.x, middle.y, 0.0);
        let vertical = FILLED * math::tan(0.5 * FIELD_OF_VIEW);
        let horizontal = vertical * aspect;
        let corners = [area.min, area.max, Point2::new(area.min.x, area.max.y), Point2::new(area.max.x, area.min.y)];
        let corners = corners.into_iter().flat_map(|corner| [-top, top].map(|height| raised(corner, height)));
        // A corner is in the picture if its offset from the axis is at most its depth times the tangent of half the angle.
        let distances = corners.map(|corner| {
            let corner = corner - looks_at;
            let offset = (corner.dot(&right).abs() / horizontal).max(corner.dot(&up).abs() / vertical);
            offset - corner.dot(&ahead)
        });
        let distance = distances.fold(f64::MIN_POSITIVE, f64::max);
        Self { position: looks_at - distance * ahead, looks_at, field_of_view: FIELD_OF_VIEW }
    }

    /// The distance (m) of the camera from the point in the middle of the picture.
    pub(super) fn distance(&self) -> f64 {
        (self.looks_at - self.position).norm()
    }

    /// Elevation and azimuth of every camera's direction of view (degrees).
    pub(super) fn angles_deg() -> [f64; 2] {
        [ELEVATION.to_degrees(), 90.0]
    }
}

/// The directions of view, to the right and upwards in the picture (unit vectors, world frame).
fn frame() -> (Vector3<f64>, Vector3<f64>, Vector3<f64>) {
    let (sin, cos) = math::sin_cos(ELEVATION);
    (Vector3::new(0.0, cos, sin), Vector3::x(), Vector3::new(0.0, -sin, cos))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_area_is_in_the_picture_and_touches_its_margin(
            x in -5.0..5.0, y in -5.0..5.0, width in 0.01..3.0, height in 0.01..3.0, top in 0.0..1.0, aspect in 0.3..3.0
        ) {
            let area = BoundingBox::around(Point2::new(x, y), Point2::new(x + width, y + height));
            let camera = Camera::around(&area, top, aspect);
            // By a rotation matrix of nalgebra instead of the vectors of `frame`.
            let view = nalgebra::Isometry3::look_at_rh(&camera.position, &camera.looks_at, &Vector3::z());
            let projection = nalgebra::Perspective3::new(aspect, camera.field_of_view, 1e-3, 1e3);
            let corners = [(x, y), (x + width, y), (x, y + height), (x + width, y + height)];
            let corners = corners.into_iter().flat_map(|(x, y)| [-top, top].map(|z| Point3::new(x, y, z)));
            let farthest = corners.map(|corner| {
                let seen = projection.project_point(&(view * corner));
                seen.x.abs().max(seen.y.abs())
            });
            let farthest = farthest.fold(0.0, f64::max);
            prop_assert!((farthest - FILLED).abs() < 1e-9, "{farthest}");
        }
    }
}
