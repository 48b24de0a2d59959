//! Units that exist, and that are not written here.

/// Such units, and what one of each is.
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

/// What one of a unit is in units that can be written, if it is one that exists and cannot: no misspelt one, whatever it looks like.
pub(super) fn foreign(name: &str) -> Option<&'static str> {
    FOREIGN.iter().find(|(symbol, _)| *symbol == name).map(|(_, same)| *same)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::{parse_quantity, simple_units};

    #[test]
    fn what_is_told_of_a_foreign_unit_can_be_written_and_the_unit_cannot() {
        for (symbol, same) in FOREIGN {
            assert!(parse_quantity(same).is_ok(), "{same}");
            assert!(simple_units().all(|unit| unit != *symbol), "{symbol}");
        }
    }
}
