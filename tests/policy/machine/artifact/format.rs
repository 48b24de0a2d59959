//! The layout that the format's number stands for.

use std::fmt::Debug;

use serde::de::DeserializeOwned;
use sha2::{Digest, Sha256};
use vibrissa_runtime::machine::{
    Artifact, ArtifactError, BodyScalar, ContourVector, FORMAT, MapQuestion, MapScalar, MapVector, Op, WhiskerScalar,
    WhiskerVector,
};

use crate::snapshots::snapshots;

use super::policies;

/// The variants of an enum with the numbers that stand for them in an artifact.
fn numbered<T: DeserializeOwned + Debug>() -> Vec<String> {
    (0..128_u8)
        .map_while(|number| postcard::from_bytes::<T>(&[&[number][..], &[0; 32]].concat()).ok())
        .enumerate()
        .map(|(number, variant)| format!("{number} {variant:?}"))
        .collect()
}

/// A policy in which every part of an artifact has something, and next to nothing is computed.
const SMALL: &str = r#"
machine small
whisker a, b by sliding if fitted
contour c of 3 points 5 mm apart
needs control_rate in 20 .. 30 Hz
needs sample_age in 0 .. 10 ms
param low = 1 in 0 .. 2  # described
type Side = left or right
param side = Side.right
var n = low
monitor seen { var x = low  set x = 3 }
record a
record a.tip in c
initial Rest
state Outer(w: whisker) { initial Inner(low)  failsafe -> Rest  state Inner(x: number) { stop } }
state Rest { entry { set n = 1 }  hold  exit { set n = 2 }  after 1 s -> resume Outer(a) }
always when a.touching for 1 s -> Failure("touched")
always when a.loop_closed(1 m, 1 s) -> Success("closed")
failsafe -> Rest
"#;

/// Where this fails, and not because the compiler writes other code, the layout is another: raise [`FORMAT`], as below.
#[test]
fn the_layout_belongs_to_the_format() {
    let mut artifact = policies::artifact("small.fsm", SMALL);
    artifact.origin.compiler = "any".to_owned();
    let bytes = artifact.to_bytes().unwrap();
    let rows: Vec<String> = bytes.chunks(24).map(|row| format!("{row:02x?}")).collect();
    snapshots("artifact").bind(|| insta::assert_snapshot!(format!("layout_{FORMAT}"), rows.join("\n")));
}

/// Where this fails and artifacts have been handed out, raise [`FORMAT`]: what they say would be taken for something else.
#[test]
fn the_numbers_of_operations_and_quantities_belong_to_the_format() {
    let lists = [
        numbered::<Op>(),
        numbered::<BodyScalar>(),
        numbered::<WhiskerScalar>(),
        numbered::<WhiskerVector>(),
        numbered::<ContourVector>(),
        numbered::<MapScalar>(),
        numbered::<MapVector>(),
        numbered::<MapQuestion>(),
    ];
    let text = lists.map(|list| list.join("\n")).join("\n\n");
    snapshots("artifact").bind(|| insta::assert_snapshot!(format!("format_{FORMAT}"), text));
}

/// Format 13 has only added operations behind those of format 12.
#[test]
fn a_machine_of_the_format_before_is_the_same_machine() {
    let artifact = policies::artifact("small.fsm", SMALL);
    let in_format = |format: u32| {
        let mut bytes = artifact.to_bytes().unwrap();
        bytes[8..12].copy_from_slice(&format.to_le_bytes());
        let content = bytes.len() - 32;
        let checksum = Sha256::digest(&bytes[..content]);
        bytes[content..].copy_from_slice(&checksum);
        Artifact::from_bytes(&bytes)
    };
    assert_eq!(in_format(12).unwrap().to_bytes(), artifact.to_bytes());
    for format in [11, FORMAT + 1] {
        assert!(matches!(in_format(format), Err(ArtifactError::Format { found }) if found == format), "{format}");
    }
}
