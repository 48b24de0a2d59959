//! Units that exist but are not supported.

/// Unsupported units and their values in supported units.
const FOREIGN: &[(&str, &str)] = &[
    ("km", "1000 m"),
    ("dm", "100 mm"),
    ("nm", "0.001 um"),
    ("in", "25.4 mm"),
    ("ft", "304.8 mm"),
    ("h", "3600 s"),
    ("min", "60 s"),
    ("ns", "0.001 us"),
    ("MHz", "1000 kHz"),
    ("mHz", "0.001 Hz"),
    ("kN", "1000 N"),
    ("uN", "0.001 mN"),
    ("t", "1000 kg"),
    ("mg", "0.001 g"),
    ("ug", "0.000001 g"),
    ("kPa", "1000 Pa"),
];

/// Returns the value of an unsupported unit in supported ones. Such a unit is not a misspelt one.
pub(super) fn foreign(name: &str) -> Option<&'static str> {
    FOREIGN.iter().find(|(symbol, _)| *symbol == name).map(|(_, same)| *same)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::{parse_quantity, simple_units};

    #[test]
    fn the_value_of_an_unsupported_unit_can_be_parsed_and_the_unit_cannot() {
        for (symbol, same) in FOREIGN {
            assert!(parse_quantity(same).is_ok(), "{same}");
            assert!(simple_units().all(|unit| unit != *symbol), "{symbol}");
        }
    }
}
