//! Interval arithmetic.

use vibrissa_runtime::math;

use super::interval::{Interval, SLACK};

impl Interval {
    /// The possible operands of an operation with a result in this interval, given the other operand and the inverse
    /// operation. It has a margin for the rounding of both operations.
    pub(super) fn undo(self, other: Self, inverse: fn(Self, Self) -> Self) -> Self {
        let origin = inverse(self, other.number());
        let room = (self.size() + other.size() + origin.size()) * SLACK + 1e-200;
        if origin.nan || !room.is_finite() {
            return Self::new(f64::NEG_INFINITY, f64::INFINITY);
        }
        Self::new(origin.low - room, origin.high + room)
    }

    /// The possible factors of a product in this interval, given the other factor.
    pub(super) fn undo_product(self, other: Self) -> Self {
        // With a factor of almost zero, the other factor is arbitrary.
        let is_plain = !other.is_empty() && other.absolute().low > 1e-100;
        if is_plain { self.undo(other, Self::divide) } else { Self::new(f64::NEG_INFINITY, f64::INFINITY) }
    }

    fn size(self) -> f64 {
        if self.is_empty() { 0.0 } else { self.low.abs().max(self.high.abs()) }
    }

    pub(super) fn add(self, other: Self) -> Self {
        let nan = self.nan || other.nan || self.opposes(other.negate()) || other.opposes(self.negate());
        if self.is_empty() || other.is_empty() {
            return Self::NO_NUMBER;
        }
        let low = self.low + other.low;
        let high = self.high + other.high;
        Self {
            low: if low.is_nan() { f64::NEG_INFINITY } else { low },
            high: if high.is_nan() { f64::INFINITY } else { high },
            nan,
        }
    }

    /// True if the difference of the two intervals can be that of two equal infinities.
    fn opposes(self, other: Self) -> bool {
        [f64::INFINITY, f64::NEG_INFINITY].iter().any(|&end| self.has(end) && other.has(end))
    }

    pub(super) fn subtract(self, other: Self) -> Self {
        self.add(other.negate())
    }

    pub(super) fn multiply(self, other: Self) -> Self {
        if self.is_empty() || other.is_empty() {
            return Self::NO_NUMBER;
        }
        let nan = (self.has(0.0) && other.has_infinity()) || (other.has(0.0) && self.has_infinity());
        self.ends(other, |a, b| a * b).or_nan(self.nan || other.nan || nan)
    }

    pub(super) fn divide(self, other: Self) -> Self {
        if self.is_empty() || other.is_empty() {
            return Self::NO_NUMBER;
        }
        let nan = self.nan || other.nan || (self.has_infinity() && other.has_infinity());
        if other.has(0.0) {
            return Self { nan: nan || self.has(0.0), ..Self::ANYTHING };
        }
        self.ends(other, |a, b| a / b).or_nan(nan)
    }

    /// The hull of an operation's values at the ends of the intervals. If a value there is NaN, nearby values approach
    /// zero.
    fn ends(self, other: Self, operation: impl Fn(f64, f64) -> f64) -> Self {
        let corners = [(self.low, other.low), (self.low, other.high), (self.high, other.low), (self.high, other.high)];
        corners.iter().fold(Self::new(f64::INFINITY, f64::NEG_INFINITY), |hull, &(a, b)| {
            let value = operation(a, b);
            hull.join(Self::point(if value.is_nan() { 0.0 } else { value }))
        })
    }

    pub(super) fn negate(self) -> Self {
        Self { low: -self.high, high: -self.low, nan: self.nan }
    }

    pub(super) fn absolute(self) -> Self {
        if self.is_empty() || self.low >= 0.0 {
            self
        } else if self.high <= 0.0 {
            self.negate()
        } else {
            Self { low: 0.0, high: self.high.max(-self.low), nan: self.nan }
        }
    }

    pub(super) fn sign(self) -> Self {
        let sign = |value: f64| if value == 0.0 { 0.0 } else { value.signum() };
        if self.is_empty() { self } else { Self { low: sign(self.low), high: sign(self.high), nan: self.nan } }
    }

    pub(super) fn square_root(self) -> Self {
        let nan = self.nan || (!self.is_empty() && self.low < 0.0);
        if self.is_empty() || self.high < 0.0 {
            return Self::NO_NUMBER;
        }
        Self { low: self.low.max(0.0).sqrt(), high: self.high.sqrt(), nan }
    }

    pub(super) fn minimum(self, other: Self) -> Self {
        if self.is_empty() || other.is_empty() {
            return Self::NO_NUMBER;
        }
        Self { low: self.low.min(other.low), high: self.high.min(other.high), nan: self.nan || other.nan }
    }

    pub(super) fn maximum(self, other: Self) -> Self {
        self.negate().minimum(other.negate()).negate()
    }

    pub(super) fn exponential(self) -> Self {
        let Self { low, high, .. } = self.rising(math::exp).widened();
        Self { low: low.max(0.0), high, nan: self.nan }
    }

    pub(super) fn floor(self) -> Self {
        self.rising(f64::floor)
    }

    /// The image under a monotonically increasing function.
    fn rising(self, function: fn(f64) -> f64) -> Self {
        if self.is_empty() { self } else { Self { low: function(self.low), high: function(self.high), nan: self.nan } }
    }
}
