//! Transcripts and their replay.

use crate::common::{ADDRESS, bus, constant, driver, next};
use embedded_hal::i2c::I2c;
use vibrissa_mlx90393::{ReadError, Settings};
use vibrissa_mlx90393_emulator::{
    BusFault, EmulatedBusError, EmulatedClock, RecordedOperation, ReplayBus, ReplayError, SensorOptions, Transcript,
};

/// The transcript of a start, a stale read, a failed read and a good read.
fn transcript() -> Transcript {
    let mut bus = bus(constant([0.0, 30.0, 0.0]), SensorOptions::default());
    bus.record();
    let (mut sensor, mut delay) = (driver(Settings::array()), bus.clock());
    sensor.start(&mut bus, &mut delay).unwrap();
    sensor.read(&mut bus).unwrap_err();
    bus.inject(BusFault::ArbitrationLost { transactions: Some(1) });
    sensor.read(&mut bus).unwrap_err();
    bus.clock().advance_ns(5_000_000);
    next(&mut bus, &mut sensor).unwrap();
    bus.take_transcript()
}

#[test]
fn a_replay_gives_the_driver_the_same_results() {
    let mut bus = ReplayBus::new(transcript());
    let mut sensor = driver(Settings::array());
    sensor.start(&mut bus, &mut EmulatedClock::new()).unwrap();
    assert!(matches!(sensor.read(&mut bus), Err(ReadError::Stale { .. })));
    let lost = ReplayError::Recorded(EmulatedBusError::ArbitrationLost);
    assert_eq!(sensor.read(&mut bus), Err(ReadError::Bus(lost)));
    assert_eq!(sensor.read(&mut bus).unwrap().y, Some(200));
    assert_eq!(bus.remaining(), 0);
    assert!(matches!(sensor.read(&mut bus), Err(ReadError::Bus(ReplayError::Ended { index: 13, .. }))));
}

#[test]
fn a_different_transaction_is_refused_and_not_consumed() {
    let mut bus = ReplayBus::new(transcript());
    let remaining = bus.remaining();
    let mut status = [0];
    let error = bus.write_read(ADDRESS, &[0x81], &mut status).unwrap_err();
    assert_eq!(
        error,
        ReplayError::Mismatch {
            index: 0,
            expected: "address 0x0c, write [80], read 1 bytes".to_owned(),
            actual: "address 0x0c, write [81], read 1 bytes".to_owned(),
        }
    );
    assert!(bus.write_read(0x0D, &[0x80], &mut status).is_err());
    assert!(bus.write_read(ADDRESS, &[0x80], &mut [0; 2]).is_err());
    assert_eq!(bus.remaining(), remaining);
    bus.write_read(ADDRESS, &[0x80], &mut status).unwrap();
    assert_eq!(status, [0x04]);
}

#[test]
fn a_transcript_has_times_bytes_and_errors() {
    let transcript = transcript();
    let last = transcript.transactions.last().unwrap();
    let operations = [RecordedOperation::Write(vec![0x44]), RecordedOperation::Read(vec![0x80, 0, 200])];
    assert_eq!((last.address, &last.operations[..], last.error), (ADDRESS, &operations[..], None));
    assert!(transcript.transactions.is_sorted_by(|a, b| a.time_ns < b.time_ns));
    let errors = transcript.transactions.iter().filter(|transaction| transaction.error.is_some());
    assert_eq!(errors.count(), 1);
}
