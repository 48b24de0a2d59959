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

/// The word that a field has along an axis, from 0 for X to 2 for Z. Counts stay within the output range.
pub(crate) fn field_word(registers: &Registers, axis: usize, field_microtesla: f64) -> u16 {
    let (xy, z) = NANOTESLA[usize::from(registers.gain())];
    let resolution = registers.resolution(axis);
    let four_phase = if axis == 2 { z } else { xy }[usize::from(resolution)];
    let nanotesla = if registers.hall() == 0 { four_phase * 98.0 / 75.0 } else { four_phase };
    let (zero, lowest, highest) = match (resolution, registers.temperature_compensation()) {
        (0 | 1, false) => (0, -32_768.0, 32_767.0),
        (0 | 1, true) => (32_768, -32_768.0, 32_767.0),
        (2, _) => (32_768, -22_000.0, 22_000.0),
        _ => (16_384, -11_000.0, 11_000.0),
    };
    let counts = (field_microtesla * 1000.0 / nanotesla).round().clamp(lowest, highest);
    word(counts + f64::from(zero))
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
        let ends = |registers: &Registers| [-1e9, 0.0, 1e9].map(|field| field_word(registers, 1, field));
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
    fn a_temperature_has_the_code_of_the_data_sheet() {
        assert_eq!([25.0, 35.0, -1e9, 1e9].map(temperature_word), [46_244, 46_696, 0, 65_535]);
    }
}
