//! Numbers in messages.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A number. One that is not finite is `null` in JSON, and is read as NaN.
#[derive(Debug, Clone, Copy)]
pub(super) struct Number(Option<f64>);

impl From<f64> for Number {
    fn from(value: f64) -> Self {
        Self(Some(value).filter(|value| value.is_finite()))
    }
}

// Viewers accept only one type for a value, so the schema does not mention `null`.
#[cfg(test)]
impl schemars::JsonSchema for Number {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        f64::schema_name()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        f64::json_schema(generator)
    }
}

impl From<Number> for f64 {
    fn from(number: Number) -> Self {
        number.0.unwrap_or(Self::NAN)
    }
}

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Option::deserialize(deserializer).map(Self)
    }
}
