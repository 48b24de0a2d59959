//! Faults, as the driver sees them.

use crate::common::{ADDRESS, array, next};
use embedded_hal::i2c::{Error, ErrorKind, I2c};
use proptest::prelude::*;
use vibrissa_mlx90393::{Axis, ReadError};
use vibrissa_mlx90393_emulator::{BusFault, EmulatedBusError, SensorFault};

#[test]
fn a_stopped_oscillator_is_stale_until_it_runs_again() {
    let (mut bus, mut sensor) = array();
    next(&mut bus, &mut sensor).unwrap();
    bus.inject_at(ADDRESS, SensorFault::ClockStopped).unwrap();
    // A conversion may have ended before the oscillator stopped.
    let _ = next(&mut bus, &mut sensor);
    for _ in 0..5 {
        assert!(matches!(next(&mut bus, &mut sensor), Err(ReadError::Stale { .. })));
    }
    bus.clear();
    assert!(next(&mut bus, &mut sensor).is_ok());
}

#[test]
fn conversions_continue_where_the_oscillator_stopped() {
    let (mut bus, mut sensor) = array();
    next(&mut bus, &mut sensor).unwrap();
    bus.inject_at(ADDRESS, SensorFault::ClockStopped).unwrap();
    bus.clock().advance_ns(1_000_000_000);
    bus.clear();
    // Without the pause, hundreds of conversions would have ended.
    assert!(matches!(sensor.read(&mut bus), Err(ReadError::Stale { .. })));
    assert!(next(&mut bus, &mut sensor).is_ok());
}

#[test]
fn a_sensor_that_is_started_without_an_oscillator_converts_when_it_has_one() {
    let (mut bus, mut sensor) = array();
    bus.inject_at(ADDRESS, SensorFault::ClockStopped).unwrap();
    bus.clock().advance_ns(1_000_000_000);
    let mut delay = bus.clock();
    sensor.start(&mut bus, &mut delay).unwrap();
    assert!(matches!(next(&mut bus, &mut sensor), Err(ReadError::Stale { .. })));
    bus.clear();
    assert!(matches!(sensor.read(&mut bus), Err(ReadError::Stale { .. })));
    // The first data needs a start and a conversion, 3.3 ms in all.
    assert!(next(&mut bus, &mut sensor).is_ok());
}

#[test]
fn a_brown_out_is_seen_once_as_a_reset_and_then_as_a_lost_mode() {
    let (mut bus, mut sensor) = array();
    bus.inject_at(ADDRESS, SensorFault::BrownOut).unwrap();
    assert!(matches!(next(&mut bus, &mut sensor), Err(ReadError::Reset { .. })));
    assert!(matches!(next(&mut bus, &mut sensor), Err(ReadError::ModeLost { .. })));
    assert_eq!(bus.sensor(ADDRESS).unwrap().register(2), Some(0));

    let mut delay = bus.clock();
    sensor.start(&mut bus, &mut delay).unwrap();
    bus.clock().advance_ns(5_000_000);
    assert_eq!(next(&mut bus, &mut sensor).unwrap().y, Some(200));
}

#[test]
fn a_lost_mode_keeps_the_registers() {
    let (mut bus, mut sensor) = array();
    bus.inject_at(ADDRESS, SensorFault::ModeLost).unwrap();
    assert!(matches!(next(&mut bus, &mut sensor), Err(ReadError::ModeLost { .. })));
    assert_eq!(bus.sensor(ADDRESS).unwrap().register(2), Some(0x000E));
}

#[test]
fn a_silent_sensor_answers_again_after_its_transactions() {
    let (mut bus, mut sensor) = array();
    bus.inject_at(ADDRESS, SensorFault::NoAcknowledge { transactions: Some(2) }).unwrap();
    let silent = Err(ReadError::Bus(EmulatedBusError::NoAcknowledge { address: ADDRESS }));
    assert_eq!(next(&mut bus, &mut sensor), silent);
    assert_eq!(next(&mut bus, &mut sensor), silent);
    assert!(next(&mut bus, &mut sensor).is_ok());

    bus.inject_at(ADDRESS, SensorFault::NoAcknowledge { transactions: None }).unwrap();
    for _ in 0..10 {
        assert_eq!(next(&mut bus, &mut sensor), silent);
    }
    bus.clear_at(ADDRESS).unwrap();
    assert!(next(&mut bus, &mut sensor).is_ok());
}

#[test]
fn a_stuck_bus_blocks_each_transaction_for_its_timeout() {
    let (mut bus, mut sensor) = array();
    bus.inject(BusFault::STUCK);
    for _ in 0..2 {
        let start_ns = bus.now_ns();
        let Err(ReadError::Bus(error)) = sensor.read(&mut bus) else { panic!("the bus is stuck") };
        assert_eq!(error.kind(), ErrorKind::Other);
        assert_eq!(bus.now_ns() - start_ns, 1_024_000_000);
    }
    bus.clear();
    assert!(next(&mut bus, &mut sensor).is_ok());
}

#[test]
fn errors_of_the_bus_last_for_their_transactions() {
    let cases = [
        (BusFault::ArbitrationLost { transactions: Some(1) }, ErrorKind::ArbitrationLoss),
        (BusFault::Misplaced { transactions: Some(1) }, ErrorKind::Bus),
    ];
    for (fault, kind) in cases {
        let (mut bus, mut sensor) = array();
        bus.inject(fault);
        let Err(ReadError::Bus(error)) = next(&mut bus, &mut sensor) else { panic!("the bus has a fault") };
        assert_eq!(error.kind(), kind);
        assert!(next(&mut bus, &mut sensor).is_ok());
    }
}

#[test]
fn a_frozen_value_has_a_fresh_status() {
    let (mut bus, mut sensor) = array();
    let before = next(&mut bus, &mut sensor).unwrap();
    bus.inject_at(ADDRESS, SensorFault::Frozen).unwrap();
    bus.inject_at(ADDRESS, SensorFault::OffsetJump { microtesla: [0.0, 15.0, 0.0] }).unwrap();
    assert_eq!(next(&mut bus, &mut sensor).unwrap(), before);
    bus.clear();
    bus.inject_at(ADDRESS, SensorFault::OffsetJump { microtesla: [0.0, 15.0, 0.0] }).unwrap();
    assert_eq!(next(&mut bus, &mut sensor).unwrap().y, Some(300));
}

#[test]
fn a_saturated_field_is_told_by_the_measurement() {
    for (negative, counts) in [(false, 32767), (true, -32768)] {
        let (mut bus, mut sensor) = array();
        bus.inject_at(ADDRESS, SensorFault::Saturated { negative }).unwrap();
        let measurement = next(&mut bus, &mut sensor).unwrap();
        assert_eq!((measurement.y, measurement.is_saturated(Axis::Y)), (Some(counts), true));
    }
}

#[test]
fn a_corrected_bit_is_reported_with_valid_data() {
    let (mut bus, mut sensor) = array();
    bus.inject_at(ADDRESS, SensorFault::CorrectedBit).unwrap();
    let measurement = next(&mut bus, &mut sensor).unwrap();
    assert_eq!((measurement.y, measurement.status.corrected_bit()), (Some(200), true));
}

#[test]
fn a_fault_needs_a_sensor() {
    let (mut bus, _) = array();
    let absent = Err(EmulatedBusError::NoAcknowledge { address: 0x1B });
    assert_eq!(bus.inject_at(0x1B, SensorFault::BrownOut), absent);
    assert_eq!(bus.clear_at(0x1B), absent);
}

proptest! {
    #[test]
    fn wrong_bits_change_exactly_their_byte_for_their_answers(byte in 0_usize..3, mask in 1_u8.., answers in 1_u32..4) {
        let (mut bus, mut sensor) = array();
        bus.inject_at(ADDRESS, SensorFault::BitFlip { byte, mask, answers }).unwrap();
        let mut expected = [0x80, 0, 200];
        expected[byte] ^= mask;
        for _ in 0..answers {
            let result = next(&mut bus, &mut sensor);
            let raw = match &result {
                Ok(measurement) => measurement.raw,
                Err(error) => *error.raw().unwrap(),
            };
            prop_assert_eq!(raw.as_bytes(), &expected);
            // Only SED may change without an error, because the protocol has no checksum for the data.
            prop_assert_eq!(result.is_ok(), byte > 0 || mask == 0x08);
        }
        prop_assert!(next(&mut bus, &mut sensor).is_ok());
    }

    #[test]
    fn no_transaction_panics(
        exchanges in prop::collection::vec((prop::collection::vec(any::<u8>(), 0..6), 0_usize..12), 0..40),
    ) {
        let (mut bus, mut sensor) = array();
        for (written, read) in exchanges {
            let _ = bus.write_read(ADDRESS, &written, &mut vec![0; read]);
            let _ = next(&mut bus, &mut sensor);
        }
    }
}
