//! The tip position as a polynomial in the base angle, for bends to both sides.

use nalgebra::Matrix2;
use serde::{Deserialize, Serialize};

use super::contact_set::ContactSet;
use super::least_squares;
use crate::geometry::Vector2;
use crate::math;

/// Contacts up to this multiple of the limit are fitted, so that the limit is between contacts.
const BEYOND: f64 = 1.1;

/// The position of the tip as a polynomial of order five in the base angle `z`: `x = L + a z² + b z⁴` and
/// `y = c z + d z³ + e z⁵`. The contact estimator `polynomial` uses it.
///
/// A straight shaft is symmetric, so `x` is even and `y` is odd. The polynomial passes through the end of the straight
/// shaft. So it needs no contacts at small base angles, and has no jump where the bend changes its side.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DeflectionPolynomial {
    /// Largest base angle (rad): that of the contacts, or the limit.
    pub range: f64,
    /// Length of the straight shaft (m).
    pub length: f64,
    /// Coefficients (m) of the second and fourth power of the base angle over the range, for x in the frame of the base.
    pub x: [f64; 2],
    /// Coefficients (m) of the first, third and fifth power, for y.
    pub y: [f64; 3],
    /// Covariance of the residual positions (m²): xx, xy, yy.
    pub covariance: [f64; 3],
}

impl DeflectionPolynomial {
    /// Largest base angle (rad) in the baseline's report (section 3.3), of a bend to the usual side and to the other one.
    /// Beyond them the polynomial is not used.
    pub const LIMITS: (f64, f64) = (5e-4, 5e-5);

    /// Fits the polynomial to contacts with weights by least squares, for a shaft of `length` (m). All bends are to the
    /// left. Contacts far beyond the limit are omitted. `None` if the others do not determine it.
    #[must_use]
    pub fn fit(sets: &[(ContactSet, f64)], length: f64) -> Option<Self> {
        let sets = || sets.iter().filter(|(set, _)| set.base_angle <= BEYOND * Self::LIMITS.0);
        let range = math::min(sets().map(|(set, _)| set.base_angle).fold(0.0, math::max), Self::LIMITS.0);
        let along = |set: &ContactSet| set.base_angle / range;
        let xs: Vec<_> = sets().map(|(set, weight)| (even(along(set)), set.contact_base.x - length, *weight)).collect();
        let ys: Vec<_> = sets().map(|(set, weight)| (odd(along(set)), set.contact_base.y, *weight)).collect();
        let (x, y) = (least_squares::fit(&xs)?, least_squares::fit(&ys)?);
        let mut polynomial = Self { range, length, x, y, covariance: [0.0; 3] };
        let (mut sum, mut total) = (Matrix2::zeros(), 0.0);
        for (set, weight) in sets() {
            let off = set.contact_base - polynomial.at(set.base_angle);
            sum += *weight * off * off.transpose();
            total += weight;
        }
        sum /= total;
        polynomial.covariance = [sum.m11, sum.m12, sum.m22];
        Some(polynomial)
    }

    /// The position of the tip (m, frame of the base) at a base angle (rad) within the range.
    #[must_use]
    pub fn at(&self, base_angle: f64) -> Vector2 {
        let along = base_angle / self.range;
        let sum = |powers: &[f64], coefficients: &[f64]| -> f64 {
            powers.iter().zip(coefficients).map(|(power, coefficient)| power * coefficient).sum()
        };
        Vector2::new(self.length + sum(&even(along), &self.x), sum(&odd(along), &self.y))
    }

    /// True if all numbers are finite and in their valid ranges.
    pub(super) fn is_sound(&self) -> bool {
        let [xx, xy, yy] = self.covariance;
        let numbers = self.x.iter().chain(&self.y).chain(&self.covariance);
        numbers.clone().all(|number| number.is_finite())
            && [self.range, self.length].iter().all(|number| number.is_finite() && *number > 0.0)
            && self.range <= Self::LIMITS.0
            && xx >= 0.0
            && yy >= 0.0
            && xy * xy <= xx * yy * (1.0 + 1e-9)
    }
}

/// The second and fourth power.
fn even(value: f64) -> [f64; 2] {
    let square = value * value;
    [square, square * square]
}

/// The first, third and fifth power.
fn odd(value: f64) -> [f64; 3] {
    let square = value * value;
    [value, value * square, value * square * square]
}
