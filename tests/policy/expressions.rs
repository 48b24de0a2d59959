//! Random well-typed expressions mean in a machine what they mean to a plain evaluator.

use std::fmt::Write as _;

use crate::common::{Feel, Script, run};
use proptest::prelude::*;
use vibrissa_runtime::geometry::{Vector2, rotate, wrap};
use vibrissa_runtime::machine::{Action, Turn};
use vibrissa_runtime::math;

/// An expression: its text, how tightly it binds, and its value.
struct Shown<T> {
    text: String,
    power: u8,
    value: T,
}

const OR: u8 = 1;
const AND: u8 = 2;
const COMPARE: u8 = 3;
const SUM: u8 = 4;
const PRODUCT: u8 = 5;
const PREFIX: u8 = 6;
const ATOM: u8 = 7;

fn shown<T>(power: u8, text: impl Into<String>, value: T) -> Shown<T> {
    Shown { text: text.into(), power, value }
}

impl<T> Shown<T> {
    /// The text, in parentheses if it binds less than `least`.
    fn at(&self, least: u8) -> String {
        if self.power < least { format!("({})", self.text) } else { self.text.clone() }
    }
}

fn infix<A, B, T>(power: u8, sign: &str, left: &Shown<A>, right: &Shown<B>, value: T) -> Shown<T> {
    shown(power, format!("{} {sign} {}", left.at(power), right.at(power + 1)), value)
}

/// Grows expressions from bytes, which say at every point what comes next.
struct Grower<'a> {
    bytes: std::slice::Iter<'a, u8>,
    feel: Feel,
}

impl Grower<'_> {
    fn pick(&mut self, depth: u8, leaves: u8, all: u8) -> u8 {
        let byte = self.bytes.next().copied().unwrap_or(0);
        if depth == 0 { byte % leaves } else { byte % all }
    }

    fn number(&mut self, depth: u8) -> Shown<f64> {
        let choice = self.pick(depth, 4, 28);
        if choice >= 4 {
            return self.larger_number(choice, depth - 1);
        }
        match choice {
            0 => shown(ATOM, "w.side", self.feel.side),
            1 => shown(ATOM, "w.sense", self.feel.sense),
            2 => shown(ATOM, "p", 2.5),
            _ => {
                let value = f64::from(self.pick(0, 250, 250)) / 8.0;
                shown(ATOM, format!("{value:?}"), value)
            }
        }
    }

    fn larger_number(&mut self, choice: u8, depth: u8) -> Shown<f64> {
        let a = self.number(depth);
        match choice {
            4 => shown(PREFIX, format!("-{}", a.at(ATOM)), -a.value),
            5 => shown(ATOM, format!("|{}|", a.text), a.value.abs()),
            6 => shown(ATOM, format!("abs({})", a.text), a.value.abs()),
            7 => shown(ATOM, format!("sign({})", a.text), if a.value == 0.0 { 0.0 } else { a.value.signum() }),
            8 => shown(ATOM, format!("sqrt({})", a.text), a.value.sqrt()),
            9 => shown(ATOM, format!("sin(({}) * 1 rad)", a.text), math::sin(a.value)),
            10 => shown(ATOM, format!("cos(({}) * 1 rad)", a.text), math::cos(a.value)),
            11 => {
                let v = self.vector(depth);
                shown(ATOM, format!("|{}|", v.text), v.value.norm())
            }
            12 => {
                let v = self.vector(depth);
                shown(PRODUCT, format!("angle({}) / 1 rad", v.text), math::atan2(v.value.y, v.value.x))
            }
            13 => {
                let (v, u) = (self.vector(depth), self.vector(depth));
                shown(ATOM, format!("dot({}, {})", v.text, u.text), v.value.dot(&u.value))
            }
            14 => {
                let (v, u) = (self.vector(depth), self.vector(depth));
                shown(ATOM, format!("cross({}, {})", v.text, u.text), v.value.perp(&u.value))
            }
            15 => {
                let (b, c) = (self.number(depth), self.number(depth));
                let value = lesser(greater(a.value, b.value), c.value);
                shown(ATOM, format!("clamp({}, {}, {})", a.text, b.text, c.text), value)
            }
            20 => shown(ATOM, format!("tan(({}) * 1 rad)", a.text), tangent(a.value)),
            21 => shown(PRODUCT, format!("asin({}) / 1 rad", a.text), arc_sine(a.value)),
            22 => shown(PRODUCT, format!("acos({}) / 1 rad", a.text), arc_cosine(a.value)),
            23 => shown(ATOM, format!("exp({})", a.text), math::exp(a.value)),
            24 => shown(ATOM, format!("floor({})", a.text), a.value.floor()),
            25 => shown(PRODUCT, format!("wrap(({}) * 1 rad) / 1 rad", a.text), wrap(a.value)),
            26 => {
                let (v, u) = (self.vector(depth), self.vector(depth));
                let text = format!("|{}|", infix(SUM, "-", &v, &u, ()).text);
                shown(ATOM, text, (v.value - u.value).norm())
            }
            27 => {
                let (b, share) = (self.number(depth), self.number(depth));
                let value = (1.0 - share.value) * a.value + share.value * b.value;
                shown(ATOM, format!("blend({}, {}, {})", a.text, b.text, share.text), value)
            }
            _ => self.pair(choice, &a, depth),
        }
    }

    fn pair(&mut self, choice: u8, a: &Shown<f64>, depth: u8) -> Shown<f64> {
        let b = self.number(depth);
        match (choice, self.pick(0, 4, 4)) {
            (16, 0) => shown(ATOM, format!("min({}, {})", a.text, b.text), lesser(a.value, b.value)),
            (16, 1) => shown(ATOM, format!("max({}, {})", a.text, b.text), greater(a.value, b.value)),
            (16, _) => {
                let text = format!("turn(({}) * 1 rad, ({}) * 1 rad) / 1 rad", a.text, b.text);
                shown(PRODUCT, text, wrap(b.value - a.value))
            }
            (_, 0) => infix(SUM, "+", a, &b, a.value + b.value),
            (_, 1) => infix(SUM, "-", a, &b, a.value - b.value),
            (_, 2) => infix(PRODUCT, "*", a, &b, a.value * b.value),
            _ => infix(PRODUCT, "/", a, &b, a.value / b.value),
        }
    }

    fn vector(&mut self, depth: u8) -> Shown<Vector2> {
        let choice = self.pick(depth, 1, 11);
        if choice == 0 {
            return shown(ATOM, "w.contour.tangent", self.feel.tangent);
        }
        let depth = depth - 1;
        let v = self.vector(depth);
        let a = self.number(depth);
        match choice {
            1 => shown(PREFIX, format!("-{}", v.at(ATOM)), -v.value),
            2 => {
                let norm = v.value.norm();
                let value = if norm == 0.0 { Vector2::zeros() } else { v.value / norm };
                shown(ATOM, format!("unit({})", v.text), value)
            }
            3 => {
                let text = format!("direction(({}) * 1 rad)", a.text);
                shown(ATOM, text, Vector2::new(math::cos(a.value), math::sin(a.value)))
            }
            4 => {
                let b = self.number(depth);
                shown(ATOM, format!("vector({}, {})", a.text, b.text), Vector2::new(a.value, b.value))
            }
            5 => shown(ATOM, format!("rotate({}, ({}) * 1 rad)", v.text, a.text), rotate(v.value, a.value)),
            6 => infix(PRODUCT, "*", &a, &v, v.value * a.value),
            7 => infix(PRODUCT, "/", &v, &a, v.value / a.value),
            10 => {
                let u = self.vector(depth);
                let text = format!("blend({}, {}, {})", v.text, u.text, a.text);
                shown(ATOM, text, (1.0 - a.value) * v.value + a.value * u.value)
            }
            8 => {
                let u = self.vector(depth);
                infix(SUM, "+", &v, &u, v.value + u.value)
            }
            _ => {
                let u = self.vector(depth);
                infix(SUM, "-", &v, &u, v.value - u.value)
            }
        }
    }

    #[expect(clippy::float_cmp, reason = "the language compares exactly")]
    fn truth(&mut self, depth: u8) -> Shown<bool> {
        let choice = self.pick(depth, 3, 13);
        if choice < 3 {
            return match choice {
                0 => shown(ATOM, "w.touching", self.feel.touching),
                1 => shown(ATOM, "w.contour.ready", self.feel.ready),
                _ => shown(ATOM, "true", true),
            };
        }
        let depth = depth - 1;
        if choice < 9 {
            let (a, b) = (self.number(depth), self.number(depth));
            return match choice {
                3 => infix(COMPARE, "<", &a, &b, a.value < b.value),
                4 => infix(COMPARE, "<=", &a, &b, a.value <= b.value),
                5 => infix(COMPARE, ">", &a, &b, a.value > b.value),
                6 => infix(COMPARE, ">=", &a, &b, a.value >= b.value),
                7 => infix(COMPARE, "==", &a, &b, a.value == b.value),
                _ => infix(COMPARE, "!=", &a, &b, a.value != b.value),
            };
        }
        let a = self.truth(depth);
        if choice == 9 {
            // `not` takes a whole comparison, and stands in a conjunction without parentheses.
            let inner = if a.text.starts_with("not") { format!("({})", a.text) } else { a.at(COMPARE) };
            return shown(AND, format!("not {inner}"), !a.value);
        }
        let b = self.truth(depth);
        match choice {
            10 => infix(OR, "or", &a, &b, a.value || b.value),
            11 => infix(AND, "and", &a, &b, a.value && b.value),
            _ => infix(COMPARE, "==", &a, &b, a.value == b.value),
        }
    }
}

// Not those of `f64`, which may round otherwise: the sine of a huge angle shows each rounding in all its digits.
fn tangent(angle: f64) -> f64 {
    math::sin(angle) / math::cos(angle)
}

fn arc_sine(x: f64) -> f64 {
    math::atan2(x, ((1.0 - x) * (1.0 + x)).sqrt())
}

fn arc_cosine(x: f64) -> f64 {
    math::atan2(((1.0 - x) * (1.0 + x)).sqrt(), x)
}

/// The lesser of two numbers, the second of two zeros; not a number if either is not.
fn lesser(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else if a < b {
        a
    } else {
        b
    }
}

fn greater(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else if a > b {
        a
    } else {
        b
    }
}

/// A number that expressions meet; the odd ones are as likely as the plain ones.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![-10.0..10.0, Just(0.0), Just(-1.0), Just(f64::NAN), Just(f64::INFINITY), Just(1e-200), Just(1e200)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn a_machine_evaluates_as_a_plain_evaluator_does(
        bytes in prop::collection::vec(any::<u8>(), 1..120),
        (side, sense, x, y) in (number(), number(), number(), number()),
        (touching, ready) in any::<(bool, bool)>(),
    ) {
        let feel = Feel { touching, ready, base_angle: 0.0, side, sense, tangent: Vector2::new(x, y) };
        let mut grower = Grower { bytes: bytes.iter(), feel };
        let (truth, along) = (grower.truth(4), grower.vector(4));
        let (speed, rate) = (grower.number(5), grower.number(4));
        let mut text = String::from("machine m whisker w param p = 2.5 initial S state S {");
        let (v, s, r) = (along.text, speed.at(PRODUCT), rate.at(PRODUCT));
        write!(text, " if {} {{ steer body along {v} at {s} * 1 m/s turning {r} * 1 rad/s }} }}", truth.text).unwrap();

        let (machine, ticks) = run(&text, &mut Script::new(vec![vec![feel]]));
        let numbers = [along.value.x, along.value.y, speed.value, rate.value];
        match ticks[0].1 {
            Action::Steer { along_world, speed, turn: Turn::Rate(rate), .. } => {
                prop_assert!(truth.value, "{}", text);
                #[expect(clippy::float_cmp, reason = "each is computed in the same way")]
                let is_same = [along_world.x, along_world.y, speed, rate] == numbers;
                prop_assert!(is_same, "{along_world} {speed} {rate}, {numbers:?}: {text}");
            }
            Action::Hold => prop_assert!(!truth.value, "{}", text),
            _ => {
                prop_assert!(machine.failure().is_some() && truth.value, "{}", text);
                prop_assert!(numbers.iter().any(|number| !number.is_finite()), "{} {:?}", text, numbers);
            }
        }
    }

    #[test]
    fn the_plain_evaluators_trigonometry_is_that_of_the_standard_library_but_for_rounding(
        x in -1.0..=1.0, angle in -1e3..1e3,
    ) {
        prop_assert!((arc_sine(x) - x.asin()).abs() < 1e-15);
        prop_assert!((arc_cosine(x) - x.acos()).abs() < 1e-15);
        prop_assert!((tangent(angle) - angle.tan()).abs() <= 1e-15 * angle.tan().abs());
    }
}
