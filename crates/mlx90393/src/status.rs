//! The status byte.

use core::fmt;

/// The status byte, with which each answer of the sensor begins.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct Status(u8);

impl Status {
    /// The status of a byte.
    #[must_use]
    pub const fn from_byte(byte: u8) -> Self {
        Self(byte)
    }

    /// The byte.
    #[must_use]
    pub const fn byte(self) -> u8 {
        self.0
    }

    /// True in burst mode.
    #[must_use]
    pub const fn burst_mode(self) -> bool {
        self.0 & 0x80 != 0
    }

    /// True in the mode that wakes up on a change of the field.
    #[must_use]
    pub const fn wake_up_mode(self) -> bool {
        self.0 & 0x40 != 0
    }

    /// True during a single measurement.
    #[must_use]
    pub const fn single_measurement(self) -> bool {
        self.0 & 0x20 != 0
    }

    /// True if the command was rejected, if a read found no new data, or if the sensor's memory is damaged.
    #[must_use]
    pub const fn error(self) -> bool {
        self.0 & 0x10 != 0
    }

    /// True if the sensor corrected a single wrong bit of its memory (`SED`).
    #[must_use]
    pub const fn corrected_bit(self) -> bool {
        self.0 & 0x08 != 0
    }

    /// True in the first status after a reset (`RS`).
    #[must_use]
    pub const fn reset(self) -> bool {
        self.0 & 0x04 != 0
    }

    /// Number of data bytes after the status: 2, 4, 6 or 8. It is valid only after reads of registers and measurements.
    #[must_use]
    pub const fn length(self) -> u8 {
        2 * (self.0 & 0x03) + 2
    }

    /// True if no sensor sends this status, because it is in more than one mode.
    #[must_use]
    pub const fn is_impossible(self) -> bool {
        (self.0 & 0xE0).count_ones() > 1
    }
}

impl fmt::Debug for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Status({:#04x})", self.0)
    }
}

impl fmt::Display for Status {
    /// Writes the byte and the names of its flags.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:#04x}", self.0)?;
        let flags = [
            (self.burst_mode(), "BURST_MODE"),
            (self.wake_up_mode(), "WOC_MODE"),
            (self.single_measurement(), "SM_MODE"),
            (self.error(), "ERROR"),
            (self.corrected_bit(), "SED"),
            (self.reset(), "RS"),
        ];
        for (_, name) in flags.into_iter().filter(|(set, _)| *set) {
            write!(f, " {name}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::string::ToString;

    #[test]
    fn each_bit_has_the_name_of_the_data_sheet() {
        for (bit, name) in [(7, "BURST_MODE"), (6, "WOC_MODE"), (5, "SM_MODE"), (4, "ERROR"), (3, "SED"), (2, "RS")] {
            let status = Status::from_byte(1 << bit);
            assert_eq!(status.to_string().split_once(' ').map(|(_, flags)| flags), Some(name));
        }
        assert_eq!([0, 1, 2, 3].map(|d| Status::from_byte(d).length()), [2, 4, 6, 8]);
    }

    #[test]
    fn a_bus_that_nobody_drives_gives_an_impossible_status() {
        assert!(Status::from_byte(0xFF).is_impossible());
        assert!(!Status::from_byte(0x00).is_impossible() && !Status::from_byte(0x9F).is_impossible());
    }
}
