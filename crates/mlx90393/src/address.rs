//! Addresses of sensors.

use thiserror::Error;

/// The 7-bit I²C address of a sensor, from 0x0C to 0x1B.
///
/// The upper five bits depend on the order code: -011 has 0x0C to 0x0F, -012 0x10 to 0x13, -013 0x14 to 0x17 and
/// -014 0x18 to 0x1B. The pins A1 and A0 set the lower two bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Address(u8);

impl Address {
    /// Creates an address.
    ///
    /// # Errors
    /// [`InvalidAddress`] if no order code of the sensor has it.
    pub const fn new(address: u8) -> Result<Self, InvalidAddress> {
        if address >= 0x0C && address <= 0x1B { Ok(Self(address)) } else { Err(InvalidAddress { address }) }
    }

    /// The 7 bits of the address.
    #[must_use]
    pub const fn get(self) -> u8 {
        self.0
    }
}

/// An address that no MLX90393 has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error(
    "an MLX90393 has an address from 0x0C to 0x1B, not {address:#04x}. Write the address in 7 bits, without the bit for reading"
)]
pub struct InvalidAddress {
    /// The refused address.
    pub address: u8,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exactly_the_sixteen_addresses_of_the_order_codes_are_accepted() {
        for address in 0..=u8::MAX {
            let expected = (0x0C..=0x1B).contains(&address);
            assert_eq!(Address::new(address).map(Address::get).ok(), expected.then_some(address));
        }
    }
}
