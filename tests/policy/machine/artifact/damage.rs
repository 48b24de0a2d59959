//! Bytes that are not what was written, by accident or on purpose.

use proptest::prelude::*;
use sha2::{Digest, Sha256};
use vibrissa_runtime::machine::{ARTIFACT_LIMIT, Artifact, ArtifactError, FORMAT, MAGIC};

use super::{erratic, policies};

const HEADER_LENGTH: usize = 16;
const CHECKSUM_LENGTH: usize = 32;

/// Content with a header and a checksum that fit it.
fn sealed(content: &[u8]) -> Vec<u8> {
    let length = u32::try_from(content.len()).unwrap();
    let mut bytes = [&MAGIC[..], &FORMAT.to_le_bytes(), &length.to_le_bytes(), content].concat();
    let checksum = Sha256::digest(&bytes);
    bytes.extend(checksum);
    bytes
}

fn content(bytes: &[u8]) -> &[u8] {
    &bytes[HEADER_LENGTH..bytes.len() - CHECKSUM_LENGTH]
}

/// Whether an artifact with this content is accepted; if it is, it must run well.
fn is_accepted(content: &[u8]) -> bool {
    match Artifact::from_bytes(&sealed(content)) {
        Ok(artifact) => {
            erratic::run(artifact.program);
            true
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            false
        }
    }
}

#[test]
fn no_single_bit_can_flip_unnoticed() {
    for artifact in [policies::swiping(), policies::everything()] {
        let mut bytes = artifact.to_bytes().unwrap();
        for at in 0..bytes.len() {
            for bit in 0..8 {
                bytes[at] ^= 1 << bit;
                assert!(Artifact::from_bytes(&bytes).is_err(), "byte {at}, bit {bit}");
                bytes[at] ^= 1 << bit;
            }
        }
        assert_eq!(Artifact::from_bytes(&bytes), Ok(artifact));
    }
}

#[test]
fn whatever_bit_an_attacker_flips_the_machine_is_refused_or_safe() {
    let mut accepted = 0;
    for artifact in [policies::swiping(), policies::everything(), policies::nested()] {
        let bytes = artifact.to_bytes().unwrap();
        let mut content = content(&bytes).to_vec();
        for at in 0..content.len() {
            for bit in 0..8 {
                content[at] ^= 1 << bit;
                accepted += usize::from(is_accepted(&content));
                content[at] ^= 1 << bit;
            }
        }
    }
    assert!(accepted > 1000, "numbers can be changed, {accepted}");
}

#[test]
fn nothing_can_be_missing_and_nothing_added() {
    let bytes = policies::swiping().to_bytes().unwrap();
    for length in 0..bytes.len() {
        let error = Artifact::from_bytes(&bytes[..length]).unwrap_err();
        let expected = if length < MAGIC.len() { ArtifactError::NotAnArtifact } else { ArtifactError::Length };
        assert_eq!(error, expected);
    }
    assert_eq!(Artifact::from_bytes(&[&bytes[..], &[0]].concat()), Err(ArtifactError::Length));
    let content = content(&bytes);
    for length in 0..content.len() {
        assert!(!is_accepted(&content[..length]));
    }
    assert!(!is_accepted(&[content, &[0]].concat()));
}

#[test]
fn another_format_is_told_from_damage() {
    let mut bytes = policies::swiping().to_bytes().unwrap();
    bytes[MAGIC.len()] += 1;
    assert_eq!(Artifact::from_bytes(&bytes), Err(ArtifactError::Format { found: FORMAT + 1 }));
}

#[test]
fn a_number_cannot_be_spelt_in_two_ways() {
    let bytes = policies::swiping().to_bytes().unwrap();
    let content = content(&bytes);
    // The content begins with the length of the file's name; 0x80 says that more of the number follows.
    assert_eq!(usize::from(content[0]), "thesis.fsm".len());
    assert!(!is_accepted(&[&[content[0] | 0x80, 0], &content[1..]].concat()));
}

#[test]
fn lengths_that_nothing_follows_and_files_without_end_are_refused_at_once() {
    let endless = [0xFF; 9];
    let bytes = policies::swiping().to_bytes().unwrap();
    let content = content(&bytes);
    // The last number is a column, which may be any.
    for at in 0..content.len() - 1 {
        assert!(!is_accepted(&[&content[..at], &endless, &[1]].concat()));
    }
    assert_eq!(Artifact::from_bytes(&sealed(&vec![0; ARTIFACT_LIMIT])), Err(ArtifactError::TooLarge));
    assert!(!is_accepted(&vec![0; ARTIFACT_LIMIT - 1000]));
    assert!(!is_accepted(&vec![1; ARTIFACT_LIMIT - 1000]));
}

/// `bytes` with a stretch of them replaced.
fn spliced(bytes: &[u8], start: prop::sample::Index, length: usize, piece: &[u8]) -> Vec<u8> {
    let start = start.index(bytes.len());
    let end = (start + length).min(bytes.len());
    [&bytes[..start], piece, &bytes[end..]].concat()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn a_splice_is_refused_and_one_with_a_true_checksum_refused_or_safe(
        which in 0_usize..2, start: prop::sample::Index, from: prop::sample::Index, length in 0_usize..12,
        same in any::<bool>(), random in prop::collection::vec(prop_oneof![any::<u8>(), 0_u8..4], 0..12),
    ) {
        let bytes = [policies::thesis, policies::everything][which]().to_bytes().unwrap();
        let from = from.index(bytes.len());
        let copied = &bytes[from..(from + length).min(bytes.len())];
        for piece in [&random[..], copied] {
            let replaced = if same { piece.len() } else { length };
            let broken = spliced(&bytes, start, replaced, piece);
            prop_assert!(broken == bytes || Artifact::from_bytes(&broken).is_err());
            is_accepted(&spliced(content(&bytes), start, replaced, piece));
        }
    }

    #[test]
    fn any_bytes_are_refused(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        prop_assert!(Artifact::from_bytes(&bytes).is_err());
        prop_assert!(Artifact::from_bytes(&[&MAGIC[..], &bytes].concat()).is_err());
        prop_assert!(!is_accepted(&bytes));
    }
}
