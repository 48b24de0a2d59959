//! The kept recordings of the folder `tests/recordings`: each one must replay bit for bit.
//!
//! `INSTA_UPDATE=always` writes the two that are made here anew. Copy a kept recording of your robot into the folder, and
//! it is replayed as well.

use std::fs::{self, File};
use std::io::BufReader;
use std::path::{Path, PathBuf};

use vibrissa_robot::emulation::{Injection, InjectionKind, Settings};
use vibrissa_robot::fault::{FaultChange, FaultKind};
use vibrissa_robot::recording::{Recording, first_stop, keep, replay};

use super::recording::{records, written};
use super::robot::MS;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/recordings")
}

/// The recordings that are made here: their names, faults and kinds.
const MADE: [(&str, InjectionKind, FaultKind); 2] = [
    ("stale-sensor.mcap", InjectionKind::StaleSensor, FaultKind::SensorStale),
    ("brown-out.mcap", InjectionKind::BrownOut, FaultKind::SensorLost),
];

/// A recording until half a second after its stop.
fn made(kind: InjectionKind) -> Vec<u8> {
    let injection = Injection { at_ms: 600, for_ms: 150, kind, part: 0 };
    let settings = Settings { injections: vec![injection], ..Settings::default() };
    let file = written(&settings, &records(&settings, 4000));
    let open = || Recording::open(file.as_slice()).unwrap();
    let stop_ns = first_stop(open()).unwrap().unwrap();
    keep(open(), stop_ns + 500 * MS, Vec::new()).unwrap().0
}

#[test]
fn every_kept_recording_replays_bit_for_bit() {
    if std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
        for (name, kind, _) in MADE {
            fs::write(folder().join(name), made(kind)).unwrap();
        }
    }
    let mut names = Vec::new();
    for entry in fs::read_dir(folder()).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|ending| ending == "mcap") {
            let recording = Recording::open(BufReader::new(File::open(&path).unwrap())).unwrap();
            let result = replay(recording).unwrap();
            assert_eq!(result.difference, None, "{}", path.display());
            assert!(result.ticks > 0 && !result.is_cut, "{}", path.display());
            names.push((path.file_name().unwrap().to_str().unwrap().to_owned(), result));
        }
    }
    for (name, _, fault) in MADE {
        let (_, result) = names.iter().find(|(found, _)| found == name).unwrap();
        let changes = result.events.iter().filter(|event| event.fault.kind == fault).map(|event| event.change);
        assert!(changes.clone().eq([FaultChange::Detected, FaultChange::Reacted, FaultChange::Recovered]), "{name}");
    }
}
