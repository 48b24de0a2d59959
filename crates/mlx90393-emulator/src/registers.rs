//! The registers.

/// Number of registers in the customer area.
const COUNT: u8 = 0x20;

/// The registers of the customer area, with the fields that conversions depend on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Registers([u16; COUNT as usize]);

impl Registers {
    /// The values of a new chip: the factory trim, `HALLCONF` 0xC, and 0 elsewhere.
    pub(crate) fn new(factory_trim: u8) -> Self {
        let mut values = [0; COUNT as usize];
        values[0] = u16::from(factory_trim & 0x7F) << 9 | 0x000C;
        Self(values)
    }

    /// A register, or `None` outside the customer area.
    pub(crate) fn get(&self, address: u8) -> Option<u16> {
        self.0.get(usize::from(address)).copied()
    }

    /// Writes a register. False outside the customer area.
    pub(crate) fn set(&mut self, address: u8, value: u16) -> bool {
        match self.0.get_mut(usize::from(address)) {
            Some(register) => {
                *register = value;
                true
            }
            None => false,
        }
    }

    /// The bits of a register from `lowest`, as many as `mask` has.
    fn field(&self, address: usize, lowest: u8, mask: u16) -> u16 {
        self.0[address] >> lowest & mask
    }

    /// Bits 15 to 9 of register 0.
    pub(crate) fn factory_trim(&self) -> u16 {
        self.field(0, 9, 0x7F)
    }

    /// `GAIN_SEL`.
    pub(crate) fn gain(&self) -> u16 {
        self.field(0, 4, 7)
    }

    /// `HALLCONF`.
    pub(crate) fn hall(&self) -> u16 {
        self.field(0, 0, 0xF)
    }

    /// `TCMP_EN`.
    pub(crate) fn temperature_compensation(&self) -> bool {
        self.field(1, 10, 1) == 1
    }

    /// `BURST_SEL`, as the nibble of commands.
    pub(crate) fn burst_axes(&self) -> u8 {
        let [_, nibble] = self.field(1, 6, 0xF).to_be_bytes();
        nibble
    }

    /// Pause between sets in burst mode (µs).
    pub(crate) fn interval_us(&self) -> u64 {
        20_000 * u64::from(self.field(1, 0, 0x3F))
    }

    /// RES of an axis, from 0 for X to 2 for Z.
    pub(crate) fn resolution(&self, axis: usize) -> u16 {
        let lowest = [5, 7, 9][axis];
        self.field(2, lowest, 3)
    }

    /// Conversion of one axis, `TCONVM` (µs).
    pub(crate) fn axis_us(&self) -> u64 {
        let (osr, filter) = (self.field(2, 0, 3), self.field(2, 2, 7));
        67 + (64 << osr) * (2 + (1 << filter))
    }

    /// Conversion of the temperature, `TCONVT` (µs).
    pub(crate) fn temperature_us(&self) -> u64 {
        67 + (192 << self.field(2, 11, 3))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[allow(clippy::unusual_byte_groupings, reason = "the groups are the fields of the registers")]
    fn fields_have_the_places_of_the_data_sheet() {
        let mut registers = Registers::new(0x2D);
        assert_eq!((registers.factory_trim(), registers.gain(), registers.hall()), (0x2D, 0, 0xC));
        registers.set(0, 0b0000_0000_0101_0000);
        assert_eq!((registers.gain(), registers.hall()), (5, 0));
        registers.set(1, 0b0000_0101_1010_0011);
        assert!(registers.temperature_compensation());
        assert_eq!((registers.burst_axes(), registers.interval_us()), (0b0110, 35 * 20_000));
        registers.set(2, 0b000_10_11_10_01_011_01);
        assert_eq!([0, 1, 2].map(|axis| registers.resolution(axis)), [1, 2, 3]);
        assert_eq!((registers.axis_us(), registers.temperature_us()), (67 + 64 * 2 * 10, 67 + 192 * 4));
    }

    #[test]
    fn only_the_customer_area_exists() {
        let mut registers = Registers::new(0);
        assert!(registers.set(0x1F, 9) && !registers.set(0x20, 9));
        assert_eq!((registers.get(0x1F), registers.get(0x20)), (Some(9), None));
    }
}
