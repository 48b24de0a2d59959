//! Registers, and the fields of the registers with settings.

use crate::checked_settings::CheckedSettings;
use crate::code::{OutOfRange, code};
use crate::settings::TriggerPin;

code! {
    /// Address of a 16-bit register in the customer area, from 0 to 31.
    Register, "a register address", 31, [
        GAIN = 0 "Gain, plates and the factory trim.",
        MODE = 1 "Burst mode, pin and temperature compensation.",
        CONVERSION = 2 "Resolution, filter and oversampling."
    ]
}

impl CheckedSettings {
    /// The values of registers 0, 2 and 1, in the order of writing. Register 0 keeps the factory trim of `current_gain`.
    pub(crate) fn register_values(&self, current_gain: u16) -> [(Register, u16); 3] {
        /// Bits 15 to 9 of register 0 are calibrated in the factory.
        const FACTORY_TRIM: u16 = 0xFE00;
        let s = self.get();
        let gain = current_gain & FACTORY_TRIM | u16::from(s.gain.get()) << 4 | u16::from(s.hall.code());
        let conversion = u16::from(s.temperature_oversampling.get()) << 11
            | u16::from(s.resolution.z.code()) << 9
            | u16::from(s.resolution.y.code()) << 7
            | u16::from(s.resolution.x.code()) << 5
            | u16::from(s.filter.get()) << 2
            | u16::from(s.oversampling.get());
        let mode = u16::from(s.trigger_pin == TriggerPin::DataReady) << 15
            | u16::from(s.external_trigger) << 11
            | u16::from(s.temperature_compensation) << 10
            | u16::from(s.axes.nibble()) << 6
            | u16::from(s.burst_interval.get());
        [(Register::GAIN, gain), (Register::CONVERSION, conversion), (Register::MODE, mode)]
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use crate::{Axes, BurstInterval, DigitalFilter, Gain, Hall, Oversampling, Resolution, Resolutions, Settings};

    #[test]
    fn an_address_has_five_bits() {
        for address in 0..=u8::MAX {
            assert_eq!(Register::new(address).is_ok(), address <= 0x1F);
        }
    }

    #[test]
    #[allow(clippy::unusual_byte_groupings, reason = "the groups are the fields of the registers")]
    fn every_field_has_its_place_in_the_registers_and_the_factory_trim_is_kept() {
        let settings = Settings {
            gain: Gain::new(5).unwrap(),
            resolution: Resolutions { x: Resolution::R1, y: Resolution::R2, z: Resolution::R3 },
            oversampling: Oversampling::OSR_1,
            temperature_oversampling: Oversampling::OSR_2,
            filter: DigitalFilter::new(5).unwrap(),
            hall: Hall::FourPhase,
            axes: Axes::from_nibble(0b1010),
            burst_interval: BurstInterval::new(0b10_0001).unwrap(),
            temperature_compensation: false,
            trigger_pin: TriggerPin::Input,
            external_trigger: true,
        };
        let values = settings.check().unwrap().register_values(0b1010_101_1_1_000_1111).map(|(_, value)| value);
        assert_eq!(values[0], 0b1010_101_0_0_101_1100);
        assert_eq!(values[1], 0b000_10_11_10_01_101_01);
        assert_eq!(values[2], 0b0_00_0_1_0_1010_100001);
        let array = Settings::array().check().unwrap();
        let output = Settings { trigger_pin: TriggerPin::DataReady, ..*array.get() }.check().unwrap();
        assert_eq!(output.register_values(0).map(|(_, value)| value), [0x007C, 0x000E, 0x8100]);
        assert_eq!(array.register_values(0).map(|(_, value)| value), [0x007C, 0x000E, 0x0100]);
    }
}
