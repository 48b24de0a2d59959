//! The recorder on the robot.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use proptest::prelude::*;
use vibrissa_robot::config::RecordConfig;
use vibrissa_robot::drive::{LoopRecord, RecordSink};
use vibrissa_robot::emulation::Settings;
use vibrissa_robot::recording::{Part, ReadError, Recorder, Recording, Replayed, WriteError, replay};
use vibrissa_robot::vitals::Vitals;

use super::recording::{origin, records, setup, written};

/// A recorder, and its warnings.
fn recorder(directory: &Path, limit_mb: u64) -> (Recorder, Arc<Mutex<Vec<String>>>) {
    let warnings = Arc::new(Mutex::new(Vec::new()));
    let warned = Arc::clone(&warnings);
    let warn = Box::new(move |warning: &str| warned.lock().unwrap().push(warning.to_owned()));
    let record = RecordConfig { directory: directory.to_owned(), limit_mb };
    (Recorder::new(&record, setup(&Settings::default()), &origin(), warn).unwrap(), warnings)
}

/// Passes records to a recorder as the telemetry thread does, and looks at the directory each time.
fn record(recorder: &mut Recorder, records: &[LoopRecord], mut look: impl FnMut()) {
    let mut now_ns = 0;
    for batch in records.chunks(10) {
        for record in batch {
            recorder.take(record);
            if let LoopRecord::Packet(packet) = record {
                now_ns = now_ns.max(packet.time_ns);
            }
        }
        recorder.pause(now_ns, &Vitals::default());
        look();
    }
}

/// The recordings in a directory, oldest first.
fn files(directory: &Path) -> Vec<PathBuf> {
    let mut files: Vec<_> = fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files
}

fn total(directory: &Path) -> u64 {
    files(directory).iter().map(|file| file.metadata().unwrap().len()).sum()
}

fn replayed(files: &[PathBuf]) -> Result<Replayed, ReadError> {
    let parts = files.iter().map(|file| Part::open(File::open(file).unwrap())).collect::<Result<_, _>>()?;
    replay(Recording::join(parts)?)
}

#[test]
fn a_run_in_several_parts_replays_as_the_run_in_one_file() {
    let (folder, settings) = (tempfile::tempdir().unwrap(), Settings::default());
    let records = records(&settings, 20_000);
    let (mut recorder, warnings) = recorder(folder.path(), 3);
    record(&mut recorder, &records, || {});
    recorder.finish();
    let mut parts = files(folder.path());
    assert!(parts.len() > 1 && warnings.lock().unwrap().is_empty(), "{parts:?}");
    let whole = replay(Recording::open(written(&settings, &records).as_slice()).unwrap()).unwrap();
    parts.reverse();
    assert_eq!(replayed(&parts).unwrap(), whole);
    assert!(whole.difference.is_none() && whole.steps > 550);
    // Every part is complete by itself, but a replay needs them from the first one on.
    parts.reverse();
    assert!(replayed(&parts[..1]).unwrap().difference.is_none());
    assert!(matches!(replayed(&parts[1..]), Err(ReadError::NoStart { .. })));
    let repeated = [parts[0].clone(), parts[0].clone()];
    assert!(matches!(replayed(&repeated), Err(ReadError::Twice { part: 0 })));
}

#[test]
fn a_missing_part_in_the_middle_is_a_gap() {
    let (folder, settings) = (tempfile::tempdir().unwrap(), Settings::default());
    let (mut recorder, _) = recorder(folder.path(), 2);
    record(&mut recorder, &records(&settings, 20_000), || {});
    recorder.finish();
    let mut parts = files(folder.path());
    assert!(parts.len() > 2);
    parts.remove(1);
    assert!(matches!(replayed(&parts), Err(ReadError::Gap { .. })));
}

#[test]
fn parts_of_different_runs_are_not_joined() {
    let (folder, settings) = (tempfile::tempdir().unwrap(), Settings::default());
    let records = records(&settings, 1500);
    let (mut first, _) = recorder(folder.path(), 10);
    record(&mut first, &records, || {});
    first.finish();
    let mut details = origin();
    details.details.insert("started_unix_s".to_owned(), "1".to_owned());
    let record_config = RecordConfig { directory: folder.path().to_owned(), limit_mb: 10 };
    let mut second = Recorder::new(&record_config, setup(&settings), &details, Box::new(|_| {})).unwrap();
    record(&mut second, &records, || {});
    second.finish();
    let files = files(folder.path());
    assert_eq!(files.len(), 2);
    assert!(files[1].ends_with("run-00002-00000.mcap"));
    assert!(matches!(replayed(&files), Err(ReadError::OtherRun)));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]

    #[test]
    fn the_recordings_never_exceed_their_limit(limit_mb in 1_u64..3, runs in 1_usize..4, until_ms in 2000_u64..40_000) {
        let folder = tempfile::tempdir().unwrap();
        let records = records(&Settings::default(), until_ms);
        for _ in 0..runs {
            let (mut recorder, warnings) = recorder(folder.path(), limit_mb);
            let mut largest = 0;
            record(&mut recorder, &records, || largest = largest.max(total(folder.path())));
            recorder.finish();
            prop_assert!(largest.max(total(folder.path())) <= limit_mb * 1_000_000, "{largest}");
            prop_assert!(warnings.lock().unwrap().is_empty());
        }
        // The newest part is there, and all files can be read.
        for file in files(folder.path()) {
            match replayed(&[file]) {
                Ok(found) => prop_assert!(found.difference.is_none() && !found.is_cut),
                Err(error) => prop_assert!(matches!(error, ReadError::NoStart { .. }), "{}", error),
            }
        }
    }
}

#[test]
fn a_limit_without_room_for_one_file_is_refused() {
    let record = RecordConfig { directory: "/nonexistent".into(), limit_mb: 0 };
    let refused = Recorder::new(&record, setup(&Settings::default()), &origin(), Box::new(|_| {}));
    assert!(matches!(refused.err(), Some(WriteError::Limit { limit_bytes: 0 })));
}

#[test]
fn a_stop_is_on_the_disk_before_the_run_ends() {
    use vibrissa_robot::emulation::{Injection, InjectionKind};
    let folder = tempfile::tempdir().unwrap();
    let injection = Injection { at_ms: 300, for_ms: 200, kind: InjectionKind::StaleSensor, part: 0 };
    let settings = Settings { injections: vec![injection], ..Settings::default() };
    let (mut recorder, _) = recorder(folder.path(), 100);
    record(&mut recorder, &records(&settings, 1700), || {});
    // As after a loss of power: nobody has ended the recording.
    std::mem::forget(recorder);
    let found = replayed(&files(folder.path())).unwrap();
    assert!(found.is_cut && !found.events.is_empty() && found.difference.is_none(), "{found:?}");
}

#[test]
fn a_disk_that_fails_is_one_warning_and_is_tried_again() {
    let (folder, settings) = (tempfile::tempdir().unwrap(), Settings::default());
    let directory = folder.path().join("recordings");
    // A file in the place of the directory.
    fs::write(&directory, "").unwrap();
    let (mut recorder, warnings) = recorder(&directory, 10);
    let records = records(&settings, 25_000);
    let half = records.len() / 2;
    record(&mut recorder, &records[..half], || {});
    assert_eq!(warnings.lock().unwrap().len(), 1, "{warnings:?}");
    fs::remove_file(&directory).unwrap();
    record(&mut recorder, &records[half..], || {});
    recorder.finish();
    let said = warnings.lock().unwrap().clone();
    assert!(said.len() == 2 && said[1].contains("goes on"), "{said:?}");
    let error = replayed(&files(&directory)).unwrap_err();
    assert!(matches!(error, ReadError::NoStart { time_s } if time_s > 12.0), "{error}");
}

#[test]
fn files_of_the_user_in_the_directory_stay() {
    let folder = tempfile::tempdir().unwrap();
    let mine = folder.path().join("thesis.mcap");
    fs::write(&mine, vec![0; 2_000_000]).unwrap();
    let (mut recorder, warnings) = recorder(folder.path(), 1);
    record(&mut recorder, &records(&Settings::default(), 5000), || {});
    recorder.finish();
    assert!(mine.exists() && warnings.lock().unwrap().is_empty());
    assert!(total(folder.path()) - 2_000_000 <= 1_000_000);
}
