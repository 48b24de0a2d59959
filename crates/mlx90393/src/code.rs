//! Codes in register fields.

use thiserror::Error;

/// A code that does not fit its register field.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("{field} is from 0 to {highest}, not {value}")]
pub struct OutOfRange {
    /// Name of the field in the data sheet.
    pub field: &'static str,
    /// The refused code.
    pub value: u8,
    /// The highest code.
    pub highest: u8,
}

/// Defines a code from 0 to a highest value, with named constants.
macro_rules! code {
    ($(#[$doc:meta])* $name:ident, $field:literal, $highest:literal, [$($constant:ident = $value:literal $text:literal),*]) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(u8);

        impl $name {
            $(
                #[doc = $text]
                pub const $constant: Self = Self($value);
            )*

            /// Creates a code.
            ///
            /// # Errors
            /// [`OutOfRange`] if it does not fit the field.
            pub const fn new(code: u8) -> Result<Self, OutOfRange> {
                if code <= $highest {
                    Ok(Self(code))
                } else {
                    Err(OutOfRange { field: $field, value: code, highest: $highest })
                }
            }

            /// The code.
            #[must_use]
            pub const fn get(self) -> u8 {
                self.0
            }
        }
    };
}
pub(crate) use code;

code! {
    /// Gain of the analog path (`GAIN_SEL`), from 0 to 7. Code 7 is the most sensitive: a count is the smallest field.
    Gain, "GAIN_SEL", 7, [LEAST_SENSITIVE = 0 "Code 0, with 0.751 µT per count of X and Y.",
        MOST_SENSITIVE = 7 "Code 7, with 0.15 µT per count of X and Y."]
}

code! {
    /// Oversampling (`OSR` and `OSR2`), from 0 to 3. A conversion takes about 2^code as long.
    Oversampling, "OSR", 3, [OSR_0 = 0 "The shortest conversion.", OSR_1 = 1 "Twice as long.",
        OSR_2 = 2 "Four times as long.", OSR_3 = 3 "Eight times as long."]
}

code! {
    /// Digital filter (`DIG_FILT`), from 0 to 7. A conversion takes 2 + 2^code steps.
    DigitalFilter, "DIG_FILT", 7, [WEAKEST = 0 "Code 0, with 3 steps.", FILTER_2 = 2 "Code 2, with 6 steps.",
        FILTER_3 = 3 "Code 3, with 10 steps.", STRONGEST = 7 "Code 7, with 130 steps."]
}

code! {
    /// Pause between the conversions of burst mode (`BURST_DATA_RATE`), from 0 to 63, in steps of 20 ms.
    BurstInterval, "BURST_DATA_RATE", 63, [CONTINUOUS = 0 "No pause. All rates of 50 Hz and more need it."]
}

impl BurstInterval {
    /// The pause in microseconds.
    #[must_use]
    pub const fn microseconds(self) -> u32 {
        20_000 * self.0 as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_code_fits_its_field() {
        for code in 0..=u8::MAX {
            assert_eq!(Gain::new(code).is_ok(), code <= 0b111);
            assert_eq!(Oversampling::new(code).is_ok(), code <= 0b11);
            assert_eq!(DigitalFilter::new(code).is_ok(), code <= 0b111);
            assert_eq!(BurstInterval::new(code).is_ok(), code <= 0b11_1111);
        }
    }
}
