//! The contact position as polynomials in the base angle.

use nalgebra::Matrix2;
use serde::{Deserialize, Serialize};

use super::contact_set::ContactSet;
use super::least_squares;
use crate::geometry::Vector2;
use crate::math;

/// Coefficients of a polynomial of order five.
const COUNT: usize = 6;

/// The contact position as polynomials of order five in the base angle, for a bend to the left. The contact estimator
/// `one_channel` uses it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ContactCurve {
    /// Smallest and largest base angle (rad) of the contacts.
    pub range: [f64; 2],
    /// Coefficients (m) of x in the frame of the base, by powers of the base angle over the end of the range.
    pub x: [f64; COUNT],
    /// Coefficients (m) of y, in the same form.
    pub y: [f64; COUNT],
    /// Covariance of the residual positions (m²): xx, xy, yy.
    pub covariance: [f64; 3],
}

impl ContactCurve {
    /// Fits the curve to contacts with weights by least squares. `None` if there are too few contacts or too few
    /// different base angles.
    #[must_use]
    pub fn fit(sets: &[(ContactSet, f64)]) -> Option<Self> {
        let angles = || sets.iter().map(|(set, _)| set.base_angle);
        let range = [angles().fold(f64::INFINITY, math::min), angles().fold(0.0, math::max)];
        let rows = |value: fn(&ContactSet) -> f64| -> Vec<_> {
            sets.iter().map(|(set, weight)| (powers(set.base_angle / range[1]), value(set), *weight)).collect()
        };
        let x = least_squares::fit(&rows(|set| set.contact_base.x))?;
        let y = least_squares::fit(&rows(|set| set.contact_base.y))?;
        let mut curve = Self { range, x, y, covariance: [0.0; 3] };
        let (mut sum, mut total) = (Matrix2::zeros(), 0.0);
        for (set, weight) in sets {
            let off = set.contact_base - curve.at(set.base_angle);
            sum += *weight * off * off.transpose();
            total += weight;
        }
        sum /= total;
        curve.covariance = [sum.m11, sum.m12, sum.m22];
        Some(curve)
    }

    /// The contact position (m, frame of the base) at a base angle (rad) within the range.
    #[must_use]
    pub fn at(&self, base_angle: f64) -> Vector2 {
        let powers = powers(base_angle / self.range[1]);
        let value = |coefficients: &[f64; COUNT]| coefficients.iter().zip(powers).map(|(a, power)| a * power).sum();
        Vector2::new(value(&self.x), value(&self.y))
    }

    /// True if all numbers are finite, the range is valid and the covariance is positive semidefinite.
    pub(super) fn is_sound(&self) -> bool {
        let [xx, xy, yy] = self.covariance;
        let numbers = self.x.iter().chain(&self.y).chain(&self.covariance).chain(&self.range);
        numbers.clone().all(|number| number.is_finite())
            && 0.0 <= self.range[0]
            && self.range[0] < self.range[1]
            && xx >= 0.0
            && yy >= 0.0
            && xy * xy <= xx * yy * (1.0 + 1e-9)
    }
}

/// The powers of a value from 0 to 5.
fn powers(value: f64) -> [f64; COUNT] {
    let mut powers = [1.0; COUNT];
    for index in 1..COUNT {
        powers[index] = powers[index - 1] * value;
    }
    powers
}
