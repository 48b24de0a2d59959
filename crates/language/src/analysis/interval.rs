//! Intervals: sets of values that a register may have.

/// A margin for functions that do not round monotonically (relative, or absolute near 1).
pub(super) const SLACK: f64 = 1e-14;

/// All values from `low` to `high`, and NaN if `nan` is set. It contains no number if `low` exceeds `high`.
///
/// Every operation is sound: its interval contains each result of the machine's evaluator for operands in the given
/// intervals. Sums, products, quotients and roots round monotonically, so their ends need no margin.
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

    pub(super) fn truth(may_hold: bool, may_fail: bool) -> Self {
        Self::new(f64::from(u8::from(!may_fail)), f64::from(u8::from(may_hold)))
    }

    pub(super) fn or_nan(self, nan: bool) -> Self {
        Self { nan: self.nan || nan, ..self }
    }

    pub(super) fn is_empty(self) -> bool {
        self.low > self.high
    }

    #[cfg(test)]
    fn holds(self, value: f64) -> bool {
        if value.is_nan() { self.nan } else { (self.low..=self.high).contains(&value) }
    }

    pub(super) fn has(self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }

    pub(super) fn has_infinity(self) -> bool {
        self.has(f64::INFINITY) || self.has(f64::NEG_INFINITY)
    }

    /// The only value of the interval, if there is only one.
    #[expect(clippy::float_cmp, reason = "the ends are the same number")]
    pub(super) fn single(self) -> Option<f64> {
        (self.low == self.high && !self.nan).then_some(self.low)
    }

    /// True if the interval contains a value that the evaluator treats as true.
    pub(super) fn may_hold(self) -> bool {
        !self.is_empty() && self.high > 0.5
    }

    /// True if the interval contains a value that the evaluator treats as false.
    pub(super) fn may_fail(self) -> bool {
        self.nan || self.is_empty() || self.low <= 0.5
    }

    /// The smallest interval that contains both.
    pub(super) fn join(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high), nan: self.nan || other.nan }
    }

    /// The intersection.
    pub(super) fn meet(self, other: Self) -> Self {
        Self { low: self.low.max(other.low), high: self.high.min(other.high), nan: self.nan && other.nan }
    }

    /// True if the interval is not empty.
    pub(super) fn has_any(self) -> bool {
        self.nan || !self.is_empty()
    }

    /// True if the interval contains only finite numbers.
    pub(super) fn is_finite(self) -> bool {
        !self.nan && !self.has_infinity()
    }

    /// The interval without NaN.
    pub(super) fn number(self) -> Self {
        Self { nan: false, ..self }
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

    /// The interval with a margin for rounding.
    pub(super) fn widened(self) -> Self {
        if self.is_empty() {
            return self;
        }
        let out = |end: f64| end.abs() * SLACK + f64::MIN_POSITIVE;
        Self { low: self.low - out(self.low), high: self.high + out(self.high), nan: self.nan }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;
    use proptest::prelude::*;
    use vibrissa_runtime::geometry::{Vector2, rotate, wrap};
    use vibrissa_runtime::math;

    /// A number for tests. Special values are as likely as ordinary ones.
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
                ("sine", x.sine(), math::sin(a)),
                ("cosine", x.cosine(), math::cos(a)),
                ("wrap", x.wrapped(), wrap(a)),
                ("<", x.less(y), truth(a < b)),
                ("<=", x.less_or_equal(y), truth(a <= b)),
                ("==", x.equal(y), truth(a == b)),
                ("and", x.and(y), truth(a > 0.5 && b > 0.5)),
                ("or", x.or(y), truth(a > 0.5 || b > 0.5)),
                ("not", x.not(), truth(a <= 0.5 || a.is_nan())),
                ("norm", Interval::norm([x, y]), Vector2::new(a, b).norm()),
                ("angle", Interval::angle([x, y]), math::atan2(b, a)),
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
