//! Damaged recordings.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use proptest::prelude::*;
use vibrissa_robot::emulation::{Injection, InjectionKind, Settings};
use vibrissa_robot::recording::{ReadError, Replayed};

use super::recording::{records, replayed, written};

/// A recording of several chunks with a stop, and its replay.
static WHOLE: LazyLock<(Vec<u8>, Replayed)> = LazyLock::new(|| {
    let injection = Injection { at_ms: 400, for_ms: 200, kind: InjectionKind::StaleSensor, part: 1 };
    let settings = Settings { injections: vec![injection], ..Settings::default() };
    let file = written(&settings, &records(&settings, 8000));
    let replayed = replayed(&file).unwrap();
    assert!(replayed.difference.is_none() && !replayed.is_cut);
    (file, replayed)
});

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn a_flipped_bit_of_a_file_is_never_taken_for_the_run(place: prop::sample::Index, bit in 0_u32..8) {
        let (file, whole) = &*WHOLE;
        let mut damaged = file.clone();
        damaged[place.index(file.len())] ^= 1 << bit;
        if let Ok(found) = replayed(&damaged) {
            // The summary is only for viewers. A length beyond the end looks like a missing end.
            prop_assert!(found == *whole || found.is_cut || found.difference.is_some());
        }
    }

    #[test]
    fn a_cut_file_is_read_up_to_its_last_complete_chunk(place: prop::sample::Index) {
        let (file, whole) = &*WHOLE;
        let cut = place.index(file.len());
        match replayed(&file[..cut]) {
            Ok(found) => {
                prop_assert!(found.is_cut && found.difference.is_none() && found.steps <= whole.steps);
                prop_assert!(whole.events.starts_with(&found.events));
            }
            Err(error) => prop_assert!(matches!(error, ReadError::Empty), "{}", error),
        }
    }

    #[test]
    fn other_bytes_are_refused(bytes: Vec<u8>) {
        prop_assert!(replayed(&bytes).is_err());
    }
}

#[test]
fn cuts_lose_one_chunk_after_the_other() {
    let (file, whole) = &*WHOLE;
    // For each number of readable steps, the first cut that has it.
    let mut counts = BTreeMap::new();
    for cut in (0..=file.len()).step_by(997).chain([file.len()]) {
        if let Ok(found) = replayed(&file[..cut]) {
            counts.entry(found.steps).or_insert(cut);
        }
    }
    assert!(counts.len() > 3, "{counts:?}");
    assert!(counts.values().is_sorted() && counts.contains_key(&whole.steps));
    // A chunk has about a second.
    let steps: Vec<u64> = counts.into_keys().collect();
    assert!(steps.windows(2).all(|pair| pair[1] - pair[0] < 100), "{steps:?}");
}

#[test]
fn an_mcap_file_of_another_program_is_named_so() {
    let mut writer = mcap::Writer::new(std::io::Cursor::new(Vec::new())).unwrap();
    writer.finish().unwrap();
    let file = writer.into_inner().into_inner();
    assert!(matches!(replayed(&file), Err(ReadError::Foreign)));
}
