//! A value that a policy shows, in a JSON document.

use serde::Serialize;
use vibrissa_runtime::machine::Shown;

/// A value that a policy plots or logs.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ShownValue {
    /// The value in SI units: a number, a bool, a name, or two numbers for a vector. A number that is not finite is `null`.
    pub value: ShownNumber,
    /// The SI unit. It is empty for a plain number. `None` for a bool or a name.
    pub unit: Option<String>,
}

/// The value of a [`ShownValue`].
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum ShownNumber {
    /// A number.
    Number(f64),
    /// A bool.
    Truth(bool),
    /// A value of an enumeration, or the name of a whisker.
    Name(String),
    /// A vector.
    Vector([f64; 2]),
}

impl ShownValue {
    /// The document of a value.
    #[must_use]
    pub fn new(shown: &Shown) -> Self {
        let (value, dimension) = match shown {
            Shown::Number(number, dimension) => (ShownNumber::Number(*number), Some(dimension)),
            Shown::Truth(truth) => (ShownNumber::Truth(*truth), None),
            Shown::Name(name) => (ShownNumber::Name(name.clone()), None),
            Shown::Vector(vector, dimension) => (ShownNumber::Vector((*vector).into()), Some(dimension)),
        };
        Self { value, unit: dimension.map(|dimension| dimension.si_unit()) }
    }
}
