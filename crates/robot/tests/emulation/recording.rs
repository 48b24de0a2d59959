//! Recorded runs for tests.

use std::collections::BTreeMap;
use std::io::Cursor;

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

/// The same recording as another program writes it: compressed otherwise, with its metadata and attachments behind the messages.
pub(crate) fn rewritten(file: &[u8], compression: Option<mcap::Compression>) -> Vec<u8> {
    let options = mcap::WriteOptions::new().compression(compression);
    let mut writer = options.create(Cursor::new(Vec::new())).unwrap();
    for message in mcap::MessageStream::new(file).unwrap() {
        writer.write(&message.unwrap()).unwrap();
    }
    let summary = mcap::Summary::read(file).unwrap().unwrap();
    for index in summary.attachment_indexes.iter().rev() {
        writer.attach(&mcap::read::attachment(file, index).unwrap()).unwrap();
    }
    for index in &summary.metadata_indexes {
        writer.write_metadata(&mcap::read::metadata(file, index).unwrap()).unwrap();
    }
    writer.finish().unwrap();
    writer.into_inner().into_inner()
}

/// The replay of a recording in one file.
pub(crate) fn replayed(file: &[u8]) -> Result<Replayed, ReadError> {
    replay(Recording::open(file)?)
}
