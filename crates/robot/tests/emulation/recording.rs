//! Recorded runs for tests.

use std::collections::BTreeMap;

use vibrissa_robot::drive::LoopRecord;
use vibrissa_robot::emulation::Settings;
use vibrissa_robot::recording::{Origin, ReadError, Recording, RecordingWriter, Replayed, Setup, replay};

use vibrissa_runtime::machine::Artifact;

use super::robot::{MACHINE, MS, config, robot};

/// The records of a run with these settings, until a time (ms).
pub(crate) fn records(settings: &Settings, until_ms: u64) -> Vec<LoopRecord> {
    let mut robot = robot(settings);
    let mut records = Vec::new();
    while robot.now_ns() < until_ms * MS {
        let until_ns = robot.now_ns() + 100 * MS;
        robot.run(until_ns, |_, _, _, _| true).unwrap();
        records.extend(std::iter::from_fn(|| robot.next_record()));
    }
    records
}

pub(crate) fn setup(settings: &Settings) -> Setup {
    let artifact = Artifact::from_bytes(MACHINE).unwrap();
    Setup::new(config(settings), Some("name: emulated".to_owned()), artifact).unwrap()
}

pub(crate) fn origin() -> Origin {
    let details = BTreeMap::from([("scenario".to_owned(), "grass".to_owned())]);
    Origin { program: "test".to_owned(), program_sha256: None, details }
}

/// A recording of these records.
pub(crate) fn written(settings: &Settings, records: &[LoopRecord]) -> Vec<u8> {
    let mut writer = RecordingWriter::new(Vec::new(), &setup(settings), &origin()).unwrap();
    for record in records {
        writer.take(record).unwrap();
    }
    writer.finish().unwrap()
}

/// The replay of a recording in one file.
pub(crate) fn replayed(file: &[u8]) -> Result<Replayed, ReadError> {
    replay(Recording::open(file)?)
}
