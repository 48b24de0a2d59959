//! Whole numbers of the configuration. Their messages have the range of the key, not that of a byte.

use std::fmt;

use serde::de::{Deserializer, Error, Unexpected, Visitor};

/// Reads a whole number from 0 to `GREATEST`.
pub(crate) fn up_to<'de, const GREATEST: u8, D: Deserializer<'de>>(deserializer: D) -> Result<u8, D::Error> {
    let range = |formatter: &mut fmt::Formatter<'_>| write!(formatter, "a whole number from 0 to {GREATEST}");
    deserializer.deserialize_u8(Whole { greatest: GREATEST, range })
}

/// Reads a number that may be an address on a bus. Whether the sensor can have it is checked with the other values.
pub(super) fn address<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u8, D::Error> {
    let range = |formatter: &mut fmt::Formatter<'_>| formatter.write_str("an address from 0x0C to 0x1B");
    deserializer.deserialize_u8(Whole { greatest: u8::MAX, range })
}

/// The reader of a number up to `greatest`, which `range` describes.
struct Whole<F> {
    greatest: u8,
    range: F,
}

impl<F: Fn(&mut fmt::Formatter<'_>) -> fmt::Result> Visitor<'_> for Whole<F> {
    type Value = u8;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        (self.range)(formatter)
    }

    fn visit_u64<E: Error>(self, number: u64) -> Result<u8, E> {
        let within = u8::try_from(number).ok().filter(|number| *number <= self.greatest);
        within.ok_or_else(|| E::invalid_value(Unexpected::Unsigned(number), &self))
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<u8, E> {
        let positive = u64::try_from(number).map_err(|_| E::invalid_value(Unexpected::Signed(number), &self))?;
        self.visit_u64(positive)
    }
}
