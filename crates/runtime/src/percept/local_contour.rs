//! The local contour behind a tip.

use nalgebra::{Matrix3, Vector3};

use crate::geometry::{Point2, Vector2};
use crate::math;

/// Number of keypoints to which the curve is fitted.
const WINDOW: usize = 7;
/// Minimum distance between keypoints (m).
const SPACING: f64 = 1e-3;

/// The local curve through the newest points of a contour.
///
/// It is the least-squares parabola through the newest seven keypoints, as a function of the length along them.
/// Keypoints are at least 1 mm apart. The curve ends at the tip, and its tangent there is the direction of travel.
#[derive(Debug, Clone, Default)]
pub struct LocalContour {
    /// The newest keypoints, oldest first.
    keypoints: [Point2; WINDOW],
    /// Number of keypoints.
    count: usize,
    /// The curve, if there are enough keypoints.
    curve: Option<Curve>,
}

/// The curve as parabolas in the length along it (mm). The length is zero at the newest keypoint and negative behind
/// it.
#[derive(Debug, Clone, Copy)]
struct Curve {
    /// The newest keypoint (m).
    newest: Point2,
    /// Coefficients of the position relative to the newest keypoint (m), by powers of the length.
    parts: [Vector2; 3],
    /// Length of the curve (mm).
    reach: f64,
}

impl Curve {
    /// Length parameter (mm) at the distance `back` (m) behind the end, limited to the curve.
    fn length_at(&self, back: f64) -> f64 {
        -(back * 1e3).clamp(0.0, self.reach)
    }

    /// The point at the distance `back` (m) behind the end.
    fn point(&self, back: f64) -> Point2 {
        let length = self.length_at(back);
        self.newest + self.parts[0] + self.parts[1] * length + self.parts[2] * length * length
    }

    /// Derivative of the position by the length (m/m).
    fn slope(&self, back: f64) -> Vector2 {
        1e3 * (self.parts[1] + 2.0 * self.length_at(back) * self.parts[2])
    }
}

impl LocalContour {
    /// Forgets everything.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// Adds a point if it is far enough from the newest keypoint.
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
            self.curve = self.fit();
        }
    }

    /// True if there are enough keypoints for a curve.
    #[must_use]
    pub fn is_ready(&self) -> bool {
        self.curve.is_some()
    }

    /// The newest keypoint.
    #[must_use]
    pub fn newest(&self) -> Option<Point2> {
        self.count.checked_sub(1).map(|last| self.keypoints[last])
    }

    /// Direction of travel at the end (unit vector). `None` until the curve is ready.
    #[must_use]
    pub fn tangent(&self) -> Option<Vector2> {
        self.tangent_at(0.0)
    }

    /// The point at the distance `back` (m) behind the end, limited to the curve. `None` until the curve is ready.
    #[must_use]
    pub fn point_at(&self, back: f64) -> Option<Point2> {
        self.curve.map(|curve| curve.point(back))
    }

    /// Direction of travel (unit vector) at the distance `back` (m) behind the end, limited as in
    /// [`point_at`](Self::point_at).
    #[must_use]
    pub fn tangent_at(&self, back: f64) -> Option<Vector2> {
        self.curve.map(|curve| curve.slope(back).normalize())
    }

    /// Curvature at the end (1/m, counter-clockwise positive). `None` until the curve is ready.
    #[must_use]
    pub fn curvature(&self) -> Option<f64> {
        self.curve.map(|curve| {
            let (first, second) = (curve.slope(0.0), 2e6 * curve.parts[2]);
            first.perp(&second) / math::powi(first.norm(), 3)
        })
    }

    /// Fits `x` and `y` as parabolas in the length along the keypoints, counted back from the newest.
    fn fit(&self) -> Option<Curve> {
        let mut normal = Matrix3::zeros();
        let (mut right_x, mut right_y) = (Vector3::zeros(), Vector3::zeros());
        let newest = self.keypoints[WINDOW - 1];
        let mut back = 0.0;
        for index in (0..WINDOW).rev() {
            let point = self.keypoints[index];
            if index + 1 < WINDOW {
                back -= (self.keypoints[index + 1] - point).norm();
            }
            // In millimetres the normal equations are well conditioned.
            let length = back * 1e3;
            let basis = Vector3::new(1.0, length, length * length);
            normal += basis * basis.transpose();
            right_x += basis * (point.x - newest.x);
            right_y += basis * (point.y - newest.y);
        }
        let factors = normal.cholesky()?;
        let (x, y) = (factors.solve(&right_x), factors.solve(&right_y));
        let curve =
            Curve { newest, parts: [0, 1, 2].map(|power| Vector2::new(x[power], y[power])), reach: -back * 1e3 };
        let speed = curve.slope(0.0).norm();
        (speed.is_finite() && speed > 0.0).then_some(curve)
    }
}
