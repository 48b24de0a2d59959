//! Quantities with units in the configuration.

use serde::de::{Deserialize, Deserializer, Error};
use serde::ser::Serializer;
use vibrissa_runtime::units::{Dimension, parse_quantity};

/// Reads text such as `75 mm` as a number in SI units. A unit of another dimension is an error.
fn read<'de, D: Deserializer<'de>>(deserializer: D, dimension: Dimension) -> Result<f64, D::Error> {
    let text = String::deserialize(deserializer)?;
    let quantity = parse_quantity(&text).map_err(|error| D::Error::custom(format!("{error}; {}", error.hint())))?;
    if quantity.dimension == dimension {
        Ok(quantity.value_si)
    } else {
        let wanted = dimension.phrase();
        Err(D::Error::custom(format!("`{text}` is not {wanted}; write it in {} or a multiple", dimension.si_unit())))
    }
}

/// Writes a number in SI units with its unit. [`read`] gives exactly this number again.
fn write<S: Serializer>(value_si: f64, serializer: S, dimension: Dimension) -> Result<S::Ok, S::Error> {
    serializer.collect_str(&format_args!("{value_si} {}", dimension.si_unit()))
}

/// Defines a module for each dimension, for `#[serde(with = ...)]`.
macro_rules! dimensions {
    ($($name:ident: $dimension:ident;)*) => {
        $(
            #[doc = concat!("Quantities of the dimension ", stringify!($dimension), ".")]
            pub(super) mod $name {
                use super::{Deserializer, Dimension};

                pub(in super::super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
                    super::read(deserializer, Dimension::$dimension)
                }

                pub(in super::super) fn serialize<S: super::Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
                    super::write(*value, serializer, Dimension::$dimension)
                }
            }
        )*
    };
}

dimensions! {
    length: LENGTH;
    angle: ANGLE;
    time: TIME;
    speed: SPEED;
    angular_speed: ANGULAR_SPEED;
    frequency: FREQUENCY;
}
