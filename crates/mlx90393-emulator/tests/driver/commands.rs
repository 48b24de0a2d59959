//! Commands and status bits, in plain bytes.

use crate::common::{ADDRESS, bus, constant};
use embedded_hal::i2c::{I2c, Operation};
use vibrissa_mlx90393_emulator::{EmulatedBus, FieldSource, SensorOptions};

/// A bus whose sensor has reported its reset.
fn idle() -> EmulatedBus<impl FieldSource> {
    let mut bus = bus(constant([15.0, 30.0, 45.0]), SensorOptions::default());
    assert_eq!(send(&mut bus, &[0x80]), 0x04);
    bus
}

/// The status of a command.
fn send<F: FieldSource>(bus: &mut EmulatedBus<F>, command: &[u8]) -> u8 {
    let mut status = [0];
    bus.write_read(ADDRESS, command, &mut status).unwrap();
    status[0]
}

/// The answer to a command.
fn answer<const LENGTH: usize, F: FieldSource>(bus: &mut EmulatedBus<F>, command: &[u8]) -> [u8; LENGTH] {
    let mut answer = [0; LENGTH];
    bus.write_read(ADDRESS, command, &mut answer).unwrap();
    answer
}

#[test]
fn a_reset_is_reported_by_exactly_one_status() {
    let mut bus = idle();
    assert_eq!(send(&mut bus, &[0x00]), 0x00);
    bus.write(ADDRESS, &[0xF0]).unwrap();
    bus.clock().advance_ns(1_500_000);
    assert_eq!((send(&mut bus, &[0x00]), send(&mut bus, &[0x00])), (0x04, 0x00));
}

#[test]
fn a_written_register_is_read_back_until_a_recall_or_a_reset() {
    let mut bus = idle();
    assert_eq!(send(&mut bus, &[0x60, 0x12, 0x34, 0x1F << 2]), 0x00);
    assert_eq!(answer(&mut bus, &[0x50, 0x1F << 2]), [0x00, 0x12, 0x34]);
    assert_eq!(send(&mut bus, &[0xD0]), 0x00);
    assert_eq!(answer(&mut bus, &[0x50, 0x1F << 2]), [0x00, 0x00, 0x00]);
}

#[test]
fn stored_registers_outlast_a_reset() {
    let mut bus = idle();
    send(&mut bus, &[0x60, 0x12, 0x34, 0x1F << 2]);
    assert_eq!(send(&mut bus, &[0xE0]), 0x00);
    assert!(bus.write(ADDRESS, &[0x00]).is_err(), "storing takes 15 ms");
    bus.clock().advance_ns(15_000_000);
    bus.write(ADDRESS, &[0xF0]).unwrap();
    bus.clock().advance_ns(1_500_000);
    assert_eq!(answer(&mut bus, &[0x50, 0x1F << 2]), [0x04, 0x12, 0x34]);
}

#[test]
fn an_overwritten_factory_trim_is_noticed() {
    let mut bus = idle();
    assert_eq!(answer(&mut bus, &[0x50, 0x00]), [0x00, 0x2D << 1, 0x0C]);
    assert!(bus.sensor(ADDRESS).unwrap().factory_trim_is_intact());
    send(&mut bus, &[0x60, 0x00, 0x7C, 0x00]);
    assert!(!bus.sensor(ADDRESS).unwrap().factory_trim_is_intact());
}

#[test]
fn invalid_commands_are_acknowledged_and_rejected() {
    let mut bus = idle();
    // Wake-up on change, an unknown code, wrong low bits, missing bytes, a register beyond the customer area, no quantity.
    for command in [&[0x2F][..], &[0x90], &[0x51, 0x00], &[0x50], &[0x60, 0, 0], &[0x60, 0, 0, 0x20 << 2], &[0x10]] {
        assert_eq!(send(&mut bus, command), 0x10, "{command:02x?}");
    }
}

#[test]
fn burst_mode_accepts_only_reads_and_its_end() {
    let mut bus = idle();
    assert_eq!(send(&mut bus, &[0x14]), 0x80);
    for command in [&[0x14][..], &[0x34], &[0x50, 0], &[0x60, 0, 0, 0], &[0xD0], &[0xE0]] {
        assert_eq!(send(&mut bus, command), 0x90, "{command:02x?}");
    }
    assert_eq!(send(&mut bus, &[0x80]), 0x00);
    assert_eq!(send(&mut bus, &[0x50, 0]), 0x00);
}

#[test]
fn burst_mode_without_quantities_uses_those_of_the_register() {
    let mut bus = idle();
    send(&mut bus, &[0x60, 0x01, 0x80, 1 << 2]);
    assert_eq!(send(&mut bus, &[0x10]), 0x80);
    bus.clock().advance_ns(10_000_000);
    // Gain 0 has 0.751 µT per count: 15 µT of X are 20 counts, and 30 µT of Y are 40.
    assert_eq!(answer(&mut bus, &[0x40]), [0x81, 0, 20, 0, 40]);
}

#[test]
fn a_single_measurement_ends_after_its_time_and_is_read_once() {
    let mut bus = idle();
    assert_eq!(send(&mut bus, &[0x3F]), 0x20);
    assert_eq!(send(&mut bus, &[0x4F]), 0x33);
    bus.clock().advance_ns(3_000_000);
    assert_eq!(send(&mut bus, &[0x00]), 0x00);
    // 45 µT of Z are 37 counts of 1.21 µT. The temperature of 25 °C is 46244.
    assert_eq!(answer(&mut bus, &[0x4F]), [0x03, 0xB4, 0xA4, 0, 20, 0, 40, 0, 37]);
    bus.clock().advance_ns(50_000_000);
    assert_eq!(send(&mut bus, &[0x4F]), 0x13);
}

#[test]
fn an_axis_that_is_not_converted_keeps_its_old_value() {
    let mut bus = idle();
    send(&mut bus, &[0x14]);
    bus.clock().advance_ns(10_000_000);
    assert_eq!(answer(&mut bus, &[0x46]), [0x81, 0, 0, 0, 40]);
}

#[test]
fn the_length_code_counts_the_requested_quantities() {
    let mut bus = idle();
    send(&mut bus, &[0x1F]);
    for nibble in 1..16_u8 {
        bus.clock().advance_ns(10_000_000);
        let length = usize::try_from(nibble.count_ones()).unwrap() * 2;
        let mut bytes = vec![0; 1 + length + 2];
        bus.write_read(ADDRESS, &[0x40 | nibble], &mut bytes).unwrap();
        assert_eq!(usize::from(bytes[0] & 3) * 2 + 2, length);
        assert_eq!(bytes[1 + length..], [0xFF, 0xFF], "nobody drives the bus after the answer");
    }
}

#[test]
fn a_read_without_quantities_is_rejected() {
    let mut bus = idle();
    send(&mut bus, &[0x14]);
    bus.clock().advance_ns(10_000_000);
    assert_eq!(send(&mut bus, &[0x40]), 0x90);
}

#[test]
fn a_reset_clears_the_data() {
    let mut bus = idle();
    send(&mut bus, &[0x14]);
    bus.clock().advance_ns(10_000_000);
    assert_eq!(answer(&mut bus, &[0x44]), [0x80, 0, 40]);
    assert_eq!(answer(&mut bus, &[0x44]), [0x90, 0, 40], "stale data is sent again");
    bus.write(ADDRESS, &[0xF0]).unwrap();
    bus.clock().advance_ns(1_500_000);
    assert_eq!(answer(&mut bus, &[0x44]), [0x14, 0, 0]);
}

#[test]
fn a_stop_between_command_and_answer_changes_nothing() {
    let mut bus = idle();
    let mut bytes = [0; 3];
    bus.write(ADDRESS, &[0x50, 0x00]).unwrap();
    bus.read(ADDRESS, &mut bytes).unwrap();
    assert_eq!(bytes, [0x00, 0x2D << 1, 0x0C]);
}

#[test]
fn adjacent_operations_of_one_direction_are_one_message() {
    let mut bus = idle();
    let (mut status, mut value) = ([0], [0; 2]);
    let start_ns = bus.now_ns();
    let mut operations = [
        Operation::Write(&[0x50]),
        Operation::Write(&[0x00]),
        Operation::Read(&mut status),
        Operation::Read(&mut value),
    ];
    bus.transaction(ADDRESS, &mut operations).unwrap();
    assert_eq!((status, value), ([0x00], [0x2D << 1, 0x0C]));
    assert_eq!(bus.now_ns() - start_ns, 66 * 2500);
}
