//! The parameters of a policy, and values for them.

use serde::{Deserialize, Serialize};

use crate::units::{Dimension, Quantity, QuantityError, format_si, parse_quantity};

/// Maximum length of the description of a parameter, in bytes.
pub const DESCRIPTION_LIMIT: usize = 500;

/// A value that a run may set: a number within a range, or one of several choices.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Parameter {
    /// Name of the parameter.
    pub name: String,
    /// Description from the policy: one line of at most [`DESCRIPTION_LIMIT`] bytes. It may be empty.
    pub description: String,
    /// Physical dimension of the value.
    pub dimension: Dimension,
    /// Value if a run does not set it (SI).
    pub default: f64,
    /// Smallest and largest allowed value (SI).
    pub range: Option<(f64, f64)>,
    /// The names of the values 0, 1, 2 and so on, which the range covers: `false` and `true`, or those of an enumeration.
    /// Empty for a number.
    pub choices: Vec<String>,
}

impl Parameter {
    /// Checks that the parameter can be set to `value` (SI) of the given dimension.
    ///
    /// # Errors
    /// [`SetError`] if the dimension differs, or the value is out of range or not finite.
    pub fn check(&self, value: f64, dimension: Dimension) -> Result<(), SetError> {
        let name = self.name.clone();
        if !self.choices.is_empty() {
            return Err(self.no_choice(format_si(value, dimension)));
        }
        if self.dimension != dimension && dimension == Dimension::NUMBER {
            let (expected, example) = (self.dimension.to_string(), self.text(self.default));
            return Err(SetError::NoUnit { name, expected, example });
        }
        if self.dimension != dimension {
            let (expected, found) = (self.dimension.to_string(), dimension.to_string());
            return Err(SetError::Dimension { name, expected, found });
        }
        if !value.is_finite() {
            return Err(SetError::NotFinite { name });
        }
        match self.range {
            Some((low, high)) if !(low..=high).contains(&value) => {
                let [value, low, high] = [value, low, high].map(|value| format_si(value, dimension));
                Err(SetError::Range { name, value, low, high })
            }
            _ => Ok(()),
        }
    }

    /// The value (SI) that a user writes for the parameter. For a choice, its number.
    ///
    /// # Errors
    /// [`SetError`] if the parameter does not allow the value.
    pub fn read(&self, value: &ParameterValue) -> Result<f64, SetError> {
        match value {
            ParameterValue::Quantity(quantity) => {
                self.check(quantity.value_si, quantity.dimension).map(|()| quantity.value_si)
            }
            ParameterValue::Choice(word) if self.choices.is_empty() => {
                let example = self.text(self.default);
                Err(SetError::Word { name: self.name.clone(), example, value: word.clone() })
            }
            ParameterValue::Choice(word) => match self.choices.iter().position(|choice| choice == word) {
                Some(number) => Ok(number as f64),
                None => Err(self.no_choice(format!("`{word}`"))),
            },
        }
    }

    /// A value (SI) as text: a quantity, or the name of a choice.
    #[must_use]
    pub fn text(&self, value: f64) -> String {
        let choice = (0_u32..).zip(&self.choices).find(|(number, _)| f64::from(*number).to_bits() == value.to_bits());
        choice.map_or_else(|| format_si(value, self.dimension), |(_, choice)| choice.clone())
    }

    fn no_choice(&self, value: String) -> SetError {
        let known = self.choices.iter().map(|choice| format!("`{choice}`")).collect::<Vec<_>>().join(" or ");
        SetError::Choice { name: self.name.clone(), known, value }
    }
}

/// A value for a parameter, as a user writes it.
#[derive(Debug, Clone, PartialEq)]
pub enum ParameterValue {
    /// A number with its unit.
    Quantity(Quantity),
    /// The name of a choice.
    Choice(String),
}

impl ParameterValue {
    /// Reads a value: a word is the name of a choice, and any other text a quantity.
    ///
    /// # Errors
    /// [`QuantityError`] if the text is neither.
    pub fn parse(text: &str) -> Result<Self, QuantityError> {
        let is_word = text.starts_with(|first: char| first.is_ascii_alphabetic() || first == '_')
            && text.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_');
        if is_word { Ok(Self::Choice(text.to_owned())) } else { parse_quantity(text).map(Self::Quantity) }
    }
}

/// An error of setting a parameter.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SetError {
    /// The policy has no such parameter.
    #[error("the policy has no parameter `{name}`; it has {known}")]
    Unknown {
        /// Requested name.
        name: String,
        /// Existing parameters.
        known: String,
    },
    /// The value has the wrong dimension.
    #[error("`{name}` is {} {expected}, not {} {found}", article(expected), article(found))]
    Dimension {
        /// The parameter.
        name: String,
        /// Its dimension.
        expected: String,
        /// The value's dimension.
        found: String,
    },
    /// The value is a plain number, and the parameter has a dimension.
    #[error("`{name}` is {} {expected}: write the number with a unit, such as {example}", article(expected))]
    NoUnit {
        /// The parameter.
        name: String,
        /// Its dimension.
        expected: String,
        /// Its default value.
        example: String,
    },
    /// The value is not one of the choices.
    #[error("`{name}` is {known}, not {value}")]
    Choice {
        /// The parameter.
        name: String,
        /// Its choices.
        known: String,
        /// The value.
        value: String,
    },
    /// The value is a word, and the parameter is a number.
    #[error("`{name}` is a number, such as {example}, not `{value}`")]
    Word {
        /// The parameter.
        name: String,
        /// Its default value.
        example: String,
        /// The word.
        value: String,
    },
    /// The value is not a finite number.
    #[error("`{name}` must be a finite number")]
    NotFinite {
        /// The parameter.
        name: String,
    },
    /// The value is outside of the range.
    #[error("`{name}` must lie between {low} and {high}; {value} does not")]
    Range {
        /// The parameter.
        name: String,
        /// The value.
        value: String,
        /// The least value allowed.
        low: String,
        /// The greatest value allowed.
        high: String,
    },
}

/// The indefinite article of a noun.
fn article(noun: &str) -> &'static str {
    if noun.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" }
}
