//! Intervals: all values that a register may hold.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::geometry::wrap;

/// Room for the rounding of functions whose rounding is not monotone (relative, or absolute next to 1).
const SLACK: f64 = 1e-14;
/// Beyond this magnitude (rad) an angle's rounding shows when it is wrapped.
const GREATEST_ANGLE: f64 = 1e6;
/// How far a wrapped angle of at most that magnitude can lie from where it belongs (rad).
const WRAP_SLACK: f64 = 1e-8;

/// All values from `low` to `high`, and perhaps "not a number". No number at all if `low` is above `high`.
///
/// Every operation gives an interval that holds each result that the machine's evaluator can give for values of its
/// operands. Sums, products, quotients and roots round monotonically, so that their ends need no room.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Interval {
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) nan: bool,
}

impl Interval {
    pub(super) const ANYTHING: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY, nan: true };
    pub(super) const NO_NUMBER: Self = Self { low: f64::INFINITY, high: f64::NEG_INFINITY, nan: true };

    pub(super) const fn new(low: f64, high: f64) -> Self {
        Self { low, high, nan: false }
    }

    pub(super) const fn point(value: f64) -> Self {
        if value.is_nan() { Self::NO_NUMBER } else { Self::new(value, value) }
    }

    fn truth(may_hold: bool, may_fail: bool) -> Self {
        Self::new(f64::from(u8::from(!may_fail)), f64::from(u8::from(may_hold)))
    }

    fn or_nan(self, nan: bool) -> Self {
        Self { nan: self.nan || nan, ..self }
    }

    fn is_empty(self) -> bool {
        self.low > self.high
    }

    #[cfg(test)]
    fn holds(self, value: f64) -> bool {
        if value.is_nan() { self.nan } else { (self.low..=self.high).contains(&value) }
    }

    fn has(self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }

    fn has_infinity(self) -> bool {
        self.has(f64::INFINITY) || self.has(f64::NEG_INFINITY)
    }

    /// The one value that it holds, if it holds but one.
    #[expect(clippy::float_cmp, reason = "the ends are the same number")]
    pub(super) fn single(self) -> Option<f64> {
        (self.low == self.high && !self.nan).then_some(self.low)
    }

    /// Whether it holds a value that the evaluator takes for true.
    pub(super) fn may_hold(self) -> bool {
        !self.is_empty() && self.high > 0.5
    }

    /// Whether it holds a value that the evaluator takes for false.
    pub(super) fn may_fail(self) -> bool {
        self.nan || self.is_empty() || self.low <= 0.5
    }

    /// The smallest interval that holds both.
    pub(super) fn join(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high), nan: self.nan || other.nan }
    }

    /// What lies in both.
    pub(super) fn meet(self, other: Self) -> Self {
        Self { low: self.low.max(other.low), high: self.high.min(other.high), nan: self.nan && other.nan }
    }

    /// Whether it holds anything at all.
    pub(super) fn has_any(self) -> bool {
        self.nan || !self.is_empty()
    }

    /// Whether it holds numbers only, and finite ones.
    pub(super) fn is_finite(self) -> bool {
        !self.nan && !self.has_infinity()
    }

    /// Its numbers.
    pub(super) fn number(self) -> Self {
        Self { nan: false, ..self }
    }

    /// What an operation came from whose result lies in it, given its other operand and the inverse operation. There is
    /// room for the rounding of both.
    pub(super) fn undo(self, other: Self, inverse: fn(Self, Self) -> Self) -> Self {
        let origin = inverse(self, other.number());
        let room = (self.size() + other.size() + origin.size()) * SLACK + 1e-200;
        if origin.nan || !room.is_finite() {
            return Self::new(f64::NEG_INFINITY, f64::INFINITY);
        }
        Self::new(origin.low - room, origin.high + room)
    }

    /// What a product came from that lies in it, given the other factor.
    pub(super) fn undo_product(self, other: Self) -> Self {
        // Next to a factor of nothing, anything goes.
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

    /// Whether the difference of the two can be that of two equal infinities.
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

    /// The hull of an operation's values at the ends. Where that is no number, values near it come down to zero.
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

    pub(super) fn sine(self) -> Self {
        self.wave(f64::sin, FRAC_PI_2)
    }

    pub(super) fn cosine(self) -> Self {
        self.wave(f64::cos, 0.0)
    }

    /// A wave of period 2π that is 1 at `crest`.
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

    pub(super) fn exponential(self) -> Self {
        let Self { low, high, .. } = self.rising(f64::exp).widened();
        Self { low: low.max(0.0), high, nan: self.nan }
    }

    pub(super) fn floor(self) -> Self {
        self.rising(f64::floor)
    }

    /// What a function gives that never falls.
    fn rising(self, function: fn(f64) -> f64) -> Self {
        if self.is_empty() { self } else { Self { low: function(self.low), high: function(self.high), nan: self.nan } }
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

    pub(super) fn less(self, other: Self) -> Self {
        let some = !self.is_empty() && !other.is_empty();
        Self::truth(some && self.low < other.high, !some || self.nan || other.nan || self.high >= other.low)
    }

    pub(super) fn less_or_equal(self, other: Self) -> Self {
        let some = !self.is_empty() && !other.is_empty();
        Self::truth(some && self.low <= other.high, !some || self.nan || other.nan || self.high > other.low)
    }

    #[expect(clippy::float_cmp, reason = "the language's == is exact")]
    pub(super) fn equal(self, other: Self) -> Self {
        let meet = self.low.max(other.low) <= self.high.min(other.high);
        let same = self.single().zip(other.single()).is_some_and(|(a, b)| a == b);
        Self::truth(meet, !same)
    }

    pub(super) fn and(self, other: Self) -> Self {
        Self::truth(self.may_hold() && other.may_hold(), self.may_fail() || other.may_fail())
    }

    pub(super) fn or(self, other: Self) -> Self {
        Self::truth(self.may_hold() || other.may_hold(), self.may_fail() && other.may_fail())
    }

    pub(super) fn not(self) -> Self {
        Self::truth(self.may_fail(), self.may_hold())
    }

    /// The same with room for rounding.
    pub(super) fn widened(self) -> Self {
        if self.is_empty() {
            return self;
        }
        let out = |end: f64| end.abs() * SLACK + f64::MIN_POSITIVE;
        Self { low: self.low - out(self.low), high: self.high + out(self.high), nan: self.nan }
    }

    /// The length of the vector `[x, y]`.
    pub(super) fn norm([x, y]: [Self; 2]) -> Self {
        let (x, y) = (x.absolute(), y.absolute());
        let norm = x.multiply(x).add(y.multiply(y)).square_root().widened();
        let nan = x.nan || y.nan;
        if norm.is_empty() { Self::NO_NUMBER } else { Self { low: norm.low.max(0.0), high: norm.high, nan } }
    }

    /// The vector `[x, y]` at unit length; zero for zero.
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
            (Some(x), Some(y)) => Self::point(y.atan2(x)),
            _ => Self { low: -PI, high: PI, nan: x.nan || y.nan },
        }
    }

    /// The vector `[x, y]` turned by `angle`.
    pub(super) fn rotate([x, y]: [Self; 2], angle: Self) -> [Self; 2] {
        let (sine, cosine) = (angle.sine(), angle.cosine());
        // An infinite part is as good as any after turning.
        if x.has_infinity() || y.has_infinity() {
            return [Self::ANYTHING; 2];
        }
        let error = (x.absolute().high + y.absolute().high) * SLACK;
        let room = Self::new(-error, error);
        let turned = [x.multiply(cosine).subtract(y.multiply(sine)), x.multiply(sine).add(y.multiply(cosine))];
        turned.map(|part| if part.is_empty() { Self::NO_NUMBER } else { part.add(room).or_nan(part.nan) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Vector2, rotate};
    use proptest::prelude::*;

    /// A number that the evaluator may meet; the odd ones are as likely as the plain ones.
    fn number() -> impl Strategy<Value = f64> {
        prop_oneof![
            4 => -10.0..10.0,
            2 => -1e7..1e7,
            1 => prop::sample::select(&[
                0.0, -0.0, 1.0, -1.0, PI, -PI, TAU, 1e-200, -1e200, 1e200, f64::MAX, f64::INFINITY, f64::NEG_INFINITY,
            ]),
        ]
    }

    /// An interval and a value in it.
    fn member() -> impl Strategy<Value = (Interval, f64)> {
        (number(), number(), number(), 0..6_u8).prop_map(|(a, b, c, kind)| {
            let mut sorted = [a, b, c];
            sorted.sort_by(f64::total_cmp);
            let [low, middle, high] = sorted;
            match kind {
                0 => (Interval::point(middle), middle),
                1 => (Interval::new(low, high).or_nan(true), f64::NAN),
                2 => (Interval::new(low, high).or_nan(true), middle),
                3 => (Interval::new(middle, high), middle),
                _ => (Interval::new(low, high), middle),
            }
        })
    }

    fn lesser(a: f64, b: f64) -> f64 {
        if a.is_nan() || b.is_nan() { f64::NAN } else { a.min(b) }
    }

    fn truth(truth: bool) -> f64 {
        f64::from(u8::from(truth))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        #[test]
        #[expect(clippy::float_cmp, reason = "the language compares exactly")]
        fn what_a_value_gives_lies_in_what_its_interval_gives((x, a) in member(), (y, b) in member()) {
            let sign = |a: f64| if a == 0.0 { 0.0 } else { a.signum() };
            for (name, interval, value) in [
                ("+", x.add(y), a + b),
                ("-", x.subtract(y), a - b),
                ("*", x.multiply(y), a * b),
                ("/", x.divide(y), a / b),
                ("negate", x.negate(), -a),
                ("absolute", x.absolute(), a.abs()),
                ("sign", x.sign(), sign(a)),
                ("root", x.square_root(), a.sqrt()),
                ("minimum", x.minimum(y), lesser(a, b)),
                ("maximum", x.maximum(y), -lesser(-a, -b)),
                ("sine", x.sine(), a.sin()),
                ("cosine", x.cosine(), a.cos()),
                ("wrap", x.wrapped(), wrap(a)),
                ("<", x.less(y), truth(a < b)),
                ("<=", x.less_or_equal(y), truth(a <= b)),
                ("==", x.equal(y), truth(a == b)),
                ("and", x.and(y), truth(a > 0.5 && b > 0.5)),
                ("or", x.or(y), truth(a > 0.5 || b > 0.5)),
                ("not", x.not(), truth(a <= 0.5 || a.is_nan())),
                ("norm", Interval::norm([x, y]), Vector2::new(a, b).norm()),
                ("angle", Interval::angle([x, y]), b.atan2(a)),
                ("join", x.join(y), a),
            ] {
                prop_assert!(interval.holds(value), "{name}: {x:?} {a:?}, {y:?} {b:?}: {value:?} not in {interval:?}");
            }
            let unit = Vector2::new(a, b).try_normalize(0.0).unwrap_or_default();
            let units = Interval::unit([x, y]);
            prop_assert!(units[0].holds(unit.x) && units[1].holds(unit.y), "{x:?} {y:?} {unit:?} {units:?}");
        }

        #[test]
        fn what_is_turned_lies_in_what_its_interval_turns_to(
            (x, a) in member(), (y, b) in member(), (z, c) in member(),
        ) {
            let turned = rotate(Vector2::new(a, b), c);
            let intervals = Interval::rotate([x, y], z);
            prop_assert!(
                intervals[0].holds(turned.x) && intervals[1].holds(turned.y),
                "{x:?} {y:?} {z:?} {turned:?} {intervals:?}"
            );
        }
    }
}
