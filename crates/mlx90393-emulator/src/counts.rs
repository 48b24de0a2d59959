//! Conversion of fields to counts.

use crate::registers::Registers;

/// Field per count with `HALLCONF` 0xC (nT). Rows are `GAIN_SEL`, columns are RES. X and Y come first, then Z.
///
/// One cell of the data sheet, `GAIN_SEL` 1 and RES 3 of X and Y, is 4840. It breaks the doubling of its row, so 4807
/// stands here.
const NANOTESLA: [([f64; 4], [f64; 4]); 8] = [
    ([751.0, 1502.0, 3004.0, 6009.0], [1210.0, 2420.0, 4840.0, 9680.0]),
    ([601.0, 1202.0, 2403.0, 4807.0], [968.0, 1936.0, 3872.0, 7744.0]),
    ([451.0, 901.0, 1803.0, 3605.0], [726.0, 1452.0, 2904.0, 5808.0]),
    ([376.0, 751.0, 1502.0, 3004.0], [605.0, 1210.0, 2420.0, 4840.0]),
    ([300.0, 601.0, 1202.0, 2403.0], [484.0, 968.0, 1936.0, 3872.0]),
    ([250.0, 501.0, 1001.0, 2003.0], [403.0, 807.0, 1613.0, 3227.0]),
    ([200.0, 401.0, 801.0, 1602.0], [323.0, 645.0, 1291.0, 2581.0]),
    ([150.0, 300.0, 601.0, 1202.0], [242.0, 484.0, 968.0, 1936.0]),
];

/// Largest counts of the converter with RES 0. It has 19 bits, and 22000 counts with RES 2 are its end.
const CONVERTER_END: f64 = 88_000.0;

/// The word that a field has along an axis, from 0 for X to 2 for Z. With RES 0 and 1, it is the lower 16 bits of what
/// the converter has, so a field beyond the range wraps.
pub(crate) fn field_word(registers: &Registers, axis: usize, field_microtesla: f64) -> u16 {
    let (xy, z) = NANOTESLA[usize::from(registers.gain())];
    let resolution = registers.resolution(axis);
    let four_phase = if axis == 2 { z } else { xy }[usize::from(resolution)];
    let nanotesla = if registers.hall() == 0 { four_phase * 98.0 / 75.0 } else { four_phase };
    let end = CONVERTER_END / f64::from(1_u32 << resolution);
    let counts = (field_microtesla * 1000.0 / nanotesla).round().clamp(-end, end);
    word(counts + f64::from(code(registers, axis).0))
}

/// The word at an end of the output range of an axis.
pub(crate) fn end_word(registers: &Registers, axis: usize, negative: bool) -> u16 {
    let (zero, lowest, highest) = code(registers, axis);
    word(f64::from(zero + if negative { lowest } else { highest }))
}

/// The code of an axis: that of a zero field, and the counts at the ends of the output range.
fn code(registers: &Registers, axis: usize) -> (i32, i32, i32) {
    match (registers.resolution(axis), registers.temperature_compensation()) {
        (0 | 1, false) => (0, -32_768, 32_767),
        (0 | 1, true) => (32_768, -32_768, 32_767),
        (2, _) => (32_768, -22_000, 22_000),
        _ => (16_384, -11_000, 11_000),
    }
}

/// The word of a temperature (°C): 46244 at 25 °C, and 45.2 per degree.
pub(crate) fn temperature_word(celsius: f64) -> u16 {
    word((46_244.0 + 45.2 * (celsius - 25.0)).round().clamp(0.0, 65_535.0))
}

/// The lower 16 bits of a whole number, in two's complement.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the number is whole, and its lower 16 bits are meant"
)]
fn word(number: f64) -> u16 {
    number as i32 as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_code_has_its_zero_and_its_ends() {
        let mut registers = Registers::new(0);
        let ends = |registers: &Registers| {
            [end_word(registers, 1, true), field_word(registers, 1, 0.0), end_word(registers, 1, false)]
        };
        assert_eq!(ends(&registers), [0x8000, 0, 0x7FFF]);
        registers.set(2, 2 << 7);
        assert_eq!(ends(&registers), [10_768, 32_768, 54_768]);
        registers.set(2, 3 << 7);
        assert_eq!(ends(&registers), [5_384, 16_384, 27_384]);
        registers.set(2, 1 << 7);
        registers.set(1, 1 << 10);
        assert_eq!(ends(&registers), [0, 0x8000, 0xFFFF]);
    }

    #[test]
    fn a_field_beyond_the_range_has_the_lower_16_bits_of_the_converter() {
        let mut registers = Registers::new(0);
        registers.set(0, 7 << 4 | 0xC);
        // 0.15 µT per count: 6000 µT are 40,000 counts, as reports of the real sensor have them.
        let counts = |registers: &Registers, field| field_word(registers, 1, field).cast_signed();
        assert_eq!(
            [4914.0, 6000.0, -6000.0, 9900.0].map(|field| counts(&registers, field)),
            [32_760, -25_536, 25_536, 464]
        );
        assert_eq!(counts(&registers, 1e9), counts(&registers, 88_000.0 * 0.15), "the end of the converter");
        for resolution in [2, 3] {
            registers.set(2, resolution << 7);
            assert_eq!(field_word(&registers, 1, 1e9), end_word(&registers, 1, false));
            assert_eq!(field_word(&registers, 1, -1e9), end_word(&registers, 1, true));
        }
    }

    #[test]
    fn a_temperature_has_the_code_of_the_data_sheet() {
        assert_eq!([25.0, 35.0, -1e9, 1e9].map(temperature_word), [46_244, 46_696, 0, 65_535]);
    }
}
