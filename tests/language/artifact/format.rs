//! The layout that the format's number stands for.

use std::fmt::Debug;

use serde::de::DeserializeOwned;
use vibrissa::machine::{BodyScalar, ContourVector, FORMAT, Op, WhiskerScalar, WhiskerVector};

use crate::snapshots::snapshots;

/// The variants of an enum with the numbers that stand for them in an artifact.
fn numbered<T: DeserializeOwned + Debug>() -> Vec<String> {
    (0..128_u8)
        .map_while(|number| postcard::from_bytes::<T>(&[&[number][..], &[0; 32]].concat()).ok())
        .enumerate()
        .map(|(number, variant)| format!("{number} {variant:?}"))
        .collect()
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
    ];
    let text = lists.map(|list| list.join("\n")).join("\n\n");
    snapshots("artifact").bind(|| insta::assert_snapshot!(format!("format_{FORMAT}"), text));
}
