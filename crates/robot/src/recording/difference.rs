//! Differences between a recorded tick and its replay.

use serde::Serialize;
use serde_json::Value;

/// The first difference between a recording and its replay.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Difference {
    /// Number of the step, from 0.
    pub step: u64,
    /// Start of the step since the start of the program (ns).
    pub time_ns: u64,
    /// The field, such as `command.x` or `base_angles[1]`.
    pub field: String,
    /// The recorded value.
    pub recorded: String,
    /// The value of the replay.
    pub replayed: String,
}

/// A field with two values.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct FieldDifference {
    pub(super) field: String,
    pub(super) recorded: String,
    pub(super) replayed: String,
}

/// The first field in which two messages differ in a bit. Numbers that are not finite are equal.
///
/// The shortest decimal number that is read as a given one is unique, so texts are compared.
pub(super) fn first_difference<M: Serialize>(
    recorded: &M,
    replayed: &M,
) -> Result<Option<FieldDifference>, serde_json::Error> {
    let (recorded, replayed) = (serde_json::to_value(recorded)?, serde_json::to_value(replayed)?);
    Ok(differing(String::new(), &recorded, &replayed))
}

fn differing(field: String, recorded: &Value, replayed: &Value) -> Option<FieldDifference> {
    match (recorded, replayed) {
        (Value::Object(left), Value::Object(right)) if left.len() == right.len() => {
            left.iter().find_map(|(key, value)| {
                let separator = if field.is_empty() { "" } else { "." };
                differing(format!("{field}{separator}{key}"), value, right.get(key).unwrap_or(&Value::Null))
            })
        }
        (Value::Array(left), Value::Array(right)) if left.len() == right.len() => {
            let mut pairs = left.iter().zip(right).enumerate();
            pairs.find_map(|(index, (left, right))| differing(format!("{field}[{index}]"), left, right))
        }
        _ => {
            let (recorded, replayed) = (recorded.to_string(), replayed.to_string());
            (recorded != replayed).then_some(FieldDifference { field, recorded, replayed })
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use super::*;
    use crate::recording::number::Number;
    use proptest::prelude::*;

    #[derive(Serialize)]
    struct Outer {
        name: &'static str,
        inner: Vec<Inner>,
    }

    #[derive(Serialize)]
    struct Inner {
        x: Number,
    }

    fn outer(numbers: &[f64]) -> Outer {
        Outer { name: "a", inner: numbers.iter().map(|&x| Inner { x: x.into() }).collect() }
    }

    proptest! {
        #[test]
        fn numbers_differ_exactly_if_their_bits_do(bits: u64, flipped in 0_u32..64) {
            let (value, other) = (f64::from_bits(bits), f64::from_bits(bits ^ (1 << flipped)));
            prop_assert_eq!(first_difference(&outer(&[value]), &outer(&[value])).unwrap(), None);
            let found = first_difference(&outer(&[1.0, value]), &outer(&[1.0, other])).unwrap();
            let differs = value.is_finite() || other.is_finite();
            prop_assert_eq!(found.map(|found| found.field), differs.then(|| "inner[1].x".to_owned()));
        }
    }

    #[test]
    fn lists_of_different_length_differ() {
        let found = first_difference(&outer(&[1.0]), &outer(&[])).unwrap().unwrap();
        assert_eq!((found.field.as_str(), found.replayed.as_str()), ("inner", "[]"));
    }
}
