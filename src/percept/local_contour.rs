//! The contour just behind a tip.

use nalgebra::{Matrix3, Vector3};

use crate::geometry::{Point2, Vector2};

/// Keypoints that the curve is fitted to.
const WINDOW: usize = 7;
/// Least distance between keypoints (m).
const SPACING: f64 = 1e-3;

/// A local curve through the newest points of a contour.
///
/// It is the parabola, in the length along the keypoints, that fits the newest seven best; keypoints lie at least a
/// millimetre apart. The curve's end is where the tip is, its tangent there is the direction of travel.
#[derive(Debug, Clone, Default)]
pub struct LocalContour {
    /// The newest keypoints, oldest first.
    keypoints: [Point2; WINDOW],
    count: usize,
    end: Option<End>,
}

/// The curve at its end.
#[derive(Debug, Clone, Copy)]
struct End {
    tangent: Vector2,
    curvature: f64,
}

impl LocalContour {
    /// Forgets everything.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// Takes a point, if it is far enough from the newest keypoint.
    pub fn add(&mut self, point: Point2) {
        if self.newest().is_some_and(|newest| (point - newest).norm() < SPACING) {
            return;
        }
        if self.count == WINDOW {
            self.keypoints.rotate_left(1);
            self.count -= 1;
        }
        self.keypoints[self.count] = point;
        self.count += 1;
        if self.count == WINDOW {
            self.end = self.fit();
        }
    }

    /// Whether there are enough keypoints for a curve.
    #[must_use]
    pub fn is_ready(&self) -> bool {
        self.end.is_some()
    }

    /// The newest keypoint.
    #[must_use]
    pub fn newest(&self) -> Option<Point2> {
        self.count.checked_sub(1).map(|last| self.keypoints[last])
    }

    /// Direction of travel at the end (unit vector), once ready.
    #[must_use]
    pub fn tangent(&self) -> Option<Vector2> {
        self.end.map(|end| end.tangent)
    }

    /// Curvature at the end (1/m, counter-clockwise positive), once ready.
    #[must_use]
    pub fn curvature(&self) -> Option<f64> {
        self.end.map(|end| end.curvature)
    }

    /// Least squares for `x` and `y` as parabolas in the length along the keypoints, counted back from the newest.
    fn fit(&self) -> Option<End> {
        let mut normal = Matrix3::zeros();
        let (mut right_x, mut right_y) = (Vector3::zeros(), Vector3::zeros());
        let newest = self.keypoints[WINDOW - 1];
        let mut back = 0.0;
        for index in (0..WINDOW).rev() {
            let point = self.keypoints[index];
            if index + 1 < WINDOW {
                back -= (self.keypoints[index + 1] - point).norm();
            }
            // Millimetres keep the normal equations well conditioned.
            let length = back * 1e3;
            let basis = Vector3::new(1.0, length, length * length);
            normal += basis * basis.transpose();
            right_x += basis * (point.x - newest.x);
            right_y += basis * (point.y - newest.y);
        }
        let factors = normal.cholesky()?;
        let (x, y) = (factors.solve(&right_x), factors.solve(&right_y));
        let first = 1e3 * Vector2::new(x[1], y[1]);
        let second = 2e6 * Vector2::new(x[2], y[2]);
        let speed = first.norm();
        if !(speed.is_finite() && speed > 0.0) {
            return None;
        }
        Some(End { tangent: first / speed, curvature: first.perp(&second) / speed.powi(3) })
    }
}
