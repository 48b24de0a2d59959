//! Quantities with units in the configuration.

use serde::de::{Deserialize, Deserializer, Error};
use vibrissa_runtime::units::{Dimension, parse_quantity};

/// Reads text such as `75 mm` as a number in SI units. A unit of another dimension is an error.
fn quantity<'de, D: Deserializer<'de>>(deserializer: D, dimension: Dimension) -> Result<f64, D::Error> {
    let text = String::deserialize(deserializer)?;
    let quantity = parse_quantity(&text).map_err(|error| D::Error::custom(format!("{error}; {}", error.hint())))?;
    if quantity.dimension == dimension {
        Ok(quantity.value_si)
    } else {
        let wanted = dimension.phrase();
        Err(D::Error::custom(format!("`{text}` is not {wanted}; write it in {} or a multiple", dimension.si_unit())))
    }
}

/// Defines the reader of one dimension, for `#[serde(deserialize_with = ...)]`.
macro_rules! readers {
    ($($name:ident: $dimension:ident,)*) => {
        $(
            #[doc = concat!("Reads a quantity of the dimension ", stringify!($dimension), ".")]
            pub(super) fn $name<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
                quantity(deserializer, Dimension::$dimension)
            }
        )*
    };
}

readers! {
    length: LENGTH,
    angle: ANGLE,
    time: TIME,
    mass: MASS,
    speed: SPEED,
    angular_speed: ANGULAR_SPEED,
    frequency: FREQUENCY,
    inertia: INERTIA,
    torsion_stiffness: TORSION_STIFFNESS,
    pressure: PRESSURE,
}

/// Reads two lengths, such as `[53 mm, -30 mm]`.
pub(super) fn two_lengths<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[f64; 2], D::Error> {
    #[derive(serde::Deserialize)]
    struct Length(#[serde(deserialize_with = "length")] f64);
    let [first, second] = <[Length; 2]>::deserialize(deserializer)?;
    Ok([first.0, second.0])
}
