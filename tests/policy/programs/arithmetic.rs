//! Operators, parts of records and lists, and units, as the interpreter computes them.

use vibrissa_runtime::geometry::Vector2;

use super::evaluate::Value;
use super::tree::LIST_LENGTH;

/// A member of a record or a list. `None` for another value.
pub(crate) fn part(owner: Value, member: &str, values: &[Value]) -> Option<Value> {
    Some(match (owner, member) {
        (Value::Record(number, ..), "n") => Value::Number(number),
        (Value::Record(_, position, _), "p") => Value::Vector(position),
        (Value::Record(.., truth), _) => Value::Truth(truth),
        (Value::List(count, _), "count") => Value::Number(count as f64),
        (Value::List(count, mut positions), "with") => {
            positions.rotate_right(1);
            positions[0] = values[0].vector();
            Value::List(LIST_LENGTH.min(count + 1), positions)
        }
        (Value::List(count, positions), "nearest") => {
            let distance = |position: &Vector2| (position - values[0].vector()).norm();
            let nearer = |best: Vector2, next: &Vector2| if distance(next) < distance(&best) { *next } else { best };
            Value::Vector(positions[..count].iter().fold(positions[0], nearer))
        }
        (Value::List(count, positions), _) => {
            let index = match member {
                "newest" => Some(0),
                "oldest" => count.checked_sub(1),
                _ => (0..LIST_LENGTH).find(|&index| (values[0].number() - index as f64).abs() < 1e-9),
            };
            let unknown = Vector2::new(f64::NAN, f64::NAN);
            Value::Vector(index.filter(|&index| index < count).map_or(unknown, |index| positions[index]))
        }
        _ => return None,
    })
}

pub(crate) fn binary(sign: &str, left: Value, right: Value) -> Value {
    use Value::{Choice, Number, Truth, Vector, Whisker};
    match (sign, left, right) {
        ("or", Truth(a), Truth(b)) => Truth(a || b),
        ("and", Truth(a), Truth(b)) => Truth(a && b),
        ("==", Truth(a), Truth(b)) => Truth(a == b),
        ("!=", Truth(a), Truth(b)) => Truth(a != b),
        ("==", Whisker(a), Whisker(b)) | ("==", Choice(a), Choice(b)) => Truth(a == b),
        ("!=", Whisker(a), Whisker(b)) | ("!=", Choice(a), Choice(b)) => Truth(a != b),
        ("+", Vector(a), Vector(b)) => Vector(a + b),
        ("-", Vector(a), Vector(b)) => Vector(a - b),
        ("*", Vector(a), Number(b)) | ("*", Number(b), Vector(a)) => Vector(a * b),
        ("/", Vector(a), Number(b)) => Vector(a / b),
        (_, Number(a), Number(b)) => numbers(sign, a, b),
        _ => panic!("{left:?} {sign} {right:?}"),
    }
}

#[expect(clippy::float_cmp, reason = "the language compares exactly")]
fn numbers(sign: &str, a: f64, b: f64) -> Value {
    match sign {
        "+" => Value::Number(a + b),
        "-" => Value::Number(a - b),
        "*" => Value::Number(a * b),
        "/" => Value::Number(a / b),
        "<" => Value::Truth(a < b),
        "<=" => Value::Truth(a <= b),
        ">" => Value::Truth(a > b),
        ">=" => Value::Truth(a >= b),
        "==" => Value::Truth(a == b),
        _ => Value::Truth(a != b),
    }
}

/// The lesser of two numbers; not a number if either is not.
/// Of two zeros it is the second, as in the machine. A quotient by it depends on its sign.
pub(crate) fn lesser(a: f64, b: f64) -> f64 {
    match (a.is_nan() || b.is_nan(), a < b) {
        (true, _) => f64::NAN,
        (_, true) => a,
        _ => b,
    }
}

pub(crate) fn greater(a: f64, b: f64) -> f64 {
    -lesser(-a, -b)
}

/// What one of a unit is in SI units: a factor and a divisor.
pub(crate) fn unit_in_si(unit: &str) -> (f64, f64) {
    if let Some((above, below)) = unit.split_once('/') {
        let ((a, b), (c, d)) = (unit_in_si(above), unit_in_si(below));
        return (a * d, b * c);
    }
    match unit {
        "deg" => (std::f64::consts::PI / 180.0, 1.0),
        "cm" => (1.0, 1e2),
        "mm" | "mrad" | "ms" => (1.0, 1e3),
        "um" | "urad" | "us" => (1.0, 1e6),
        "kHz" => (1e3, 1.0),
        _ => (1.0, 1.0),
    }
}
