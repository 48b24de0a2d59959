//! Interval arithmetic of angles and vectors.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use vibrissa_runtime::math;

use vibrissa_runtime::geometry::wrap;

use super::interval::{Interval, SLACK};

/// Above this magnitude (rad), rounding affects the wrapping of an angle.
const GREATEST_ANGLE: f64 = 1e6;
/// The maximum error of a wrapped angle up to that magnitude (rad).
const WRAP_SLACK: f64 = 1e-8;

impl Interval {
    pub(super) fn sine(self) -> Self {
        self.wave(math::sin, FRAC_PI_2)
    }

    pub(super) fn cosine(self) -> Self {
        self.wave(math::cos, 0.0)
    }

    /// The image under a wave of period 2π with its maximum 1 at `crest`.
    fn wave(self, wave: fn(f64) -> f64, crest: f64) -> Self {
        if self.is_empty() {
            return Self::NO_NUMBER;
        }
        if let Some(angle) = self.single() {
            return Self::point(wave(angle));
        }
        let nan = self.nan || self.has_infinity();
        if self.high - self.low >= TAU || self.low.abs().max(self.high.abs()) > GREATEST_ANGLE {
            return Self { low: -1.0, high: 1.0, nan };
        }
        let reaches = |angle: f64| ((self.low - angle) / TAU - SLACK).ceil() <= (self.high - angle) / TAU + SLACK;
        let (low, high) = (wave(self.low), wave(self.high));
        Self {
            low: if reaches(crest + PI) { -1.0 } else { (low.min(high) - SLACK).max(-1.0) },
            high: if reaches(crest) { 1.0 } else { (low.max(high) + SLACK).min(1.0) },
            nan,
        }
    }

    pub(super) fn wrapped(self) -> Self {
        let nan = self.nan || self.has_infinity();
        if self.is_empty() || (self.low > WRAP_SLACK - PI && self.high <= PI) {
            self
        } else if let Some(angle) = self.single() {
            Self::point(wrap(angle))
        } else if self.low.abs().max(self.high.abs()) <= GREATEST_ANGLE {
            Self { low: -PI - WRAP_SLACK, high: PI + WRAP_SLACK, nan }
        } else {
            Self { nan, ..Self::ANYTHING }
        }
    }

    /// The length of the vector `[x, y]`.
    pub(super) fn norm([x, y]: [Self; 2]) -> Self {
        let (x, y) = (x.absolute(), y.absolute());
        let norm = x.multiply(x).add(y.multiply(y)).square_root().widened();
        let nan = x.nan || y.nan;
        if norm.is_empty() { Self::NO_NUMBER } else { Self { low: norm.low.max(0.0), high: norm.high, nan } }
    }

    /// The unit vector of `[x, y]`. Zero for zero.
    pub(super) fn unit([x, y]: [Self; 2]) -> [Self; 2] {
        let nan = x.nan || y.nan || x.has_infinity() || y.has_infinity();
        [x, y].map(|part| {
            if x.is_empty() || y.is_empty() {
                return Self::NO_NUMBER;
            }
            let low = if part.low >= 0.0 { 0.0 } else { -1.0 - SLACK };
            let high = if part.high <= 0.0 { 0.0 } else { 1.0 + SLACK };
            Self { low, high, nan }
        })
    }

    /// The direction of the vector `[x, y]`.
    pub(super) fn angle([x, y]: [Self; 2]) -> Self {
        if x.is_empty() || y.is_empty() {
            return Self::NO_NUMBER;
        }
        match (x.single(), y.single()) {
            // In the negative direction, the sign of zero decides between −π and π, and an interval does not know it.
            (Some(x), Some(y)) if y != 0.0 || x > 0.0 => Self::point(math::atan2(y, x)),
            _ => Self { low: -PI, high: PI, nan: x.nan || y.nan },
        }
    }

    /// The vector `[x, y]`, rotated by `angle`.
    pub(super) fn rotate([x, y]: [Self; 2], angle: Self) -> [Self; 2] {
        let (sine, cosine) = (angle.sine(), angle.cosine());
        // After a rotation, an infinite component makes both components arbitrary.
        if x.has_infinity() || y.has_infinity() {
            return [Self::ANYTHING; 2];
        }
        let error = (x.absolute().high + y.absolute().high) * SLACK;
        let room = Self::new(-error, error);
        let turned = [x.multiply(cosine).subtract(y.multiply(sine)), x.multiply(sine).add(y.multiply(cosine))];
        turned.map(|part| if part.is_empty() { Self::NO_NUMBER } else { part.add(room).or_nan(part.nan) })
    }
}
