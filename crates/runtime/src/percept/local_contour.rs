//! The local contour behind a tip.
//!
//! Why: docs/decisions/local-contour.md#the-local-contour-is-a-parabola-not-a-b-spline.

use nalgebra::{Matrix3, Vector3};

use crate::geometry::{Point2, Vector2};
use crate::machine::Keypoints;
use crate::math;

/// Space for keypoints.
const CAPACITY: usize = *Keypoints::COUNT.end();

/// The local curve through the newest points of a contour.
///
/// It is the least-squares parabola through the newest keypoints, as a function of the length along them. [`Keypoints`]
/// are their number and spacing. The curve ends at the tip, and its tangent there is the direction of travel.
#[derive(Debug, Clone, Default)]
pub struct LocalContour {
    settings: Keypoints,
    /// The newest keypoints, oldest first.
    keypoints: [Point2; CAPACITY],
    /// Number of keypoints so far, at most that of the settings.
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
    /// Creates a contour without points. A number of keypoints outside of [`Keypoints::COUNT`] is limited to it.
    #[must_use]
    pub fn new(keypoints: Keypoints) -> Self {
        let count = keypoints.count.clamp(*Keypoints::COUNT.start(), CAPACITY);
        Self { settings: Keypoints { count, ..keypoints }, ..Self::default() }
    }

    /// Forgets all points.
    pub fn clear(&mut self) {
        *self = Self { settings: self.settings, ..Self::default() };
    }

    /// Adds a point if it is far enough from the newest keypoint.
    pub fn add(&mut self, point: Point2) {
        if self.newest().is_some_and(|newest| (point - newest).norm() < self.settings.spacing) {
            return;
        }
        let needed = self.settings.count;
        if self.count == needed {
            self.keypoints[..needed].rotate_left(1);
            self.count -= 1;
        }
        self.keypoints[self.count] = point;
        self.count += 1;
        if self.count == needed {
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

    /// Fits `x` and `y` as parabolas in the length along all keypoints, counted back from the newest.
    fn fit(&self) -> Option<Curve> {
        let mut normal = Matrix3::zeros();
        let (mut right_x, mut right_y) = (Vector3::zeros(), Vector3::zeros());
        let keypoints = &self.keypoints[..self.count];
        let newest = *keypoints.last()?;
        let mut back = 0.0;
        for (index, point) in keypoints.iter().enumerate().rev() {
            if let Some(next) = keypoints.get(index + 1) {
                back -= (next - point).norm();
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
