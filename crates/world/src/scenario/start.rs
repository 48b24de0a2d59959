//! Reader of `start`: the initial pose of the platform.

use super::reader::Reader;
use crate::geometry::Pose;
use std::f64::consts::TAU;
use vibrissa_runtime::units::{Dimension, Key};
use vibrissa_yaml::{Entry, Fields, Placed};

/// Coordinates in the world frame, limited to 100 m.
pub(super) const POSITION: Key = Key::new("position", Dimension::LENGTH, (-100.0, 100.0), "[0 mm, 72 mm]");
/// A heading in the world frame.
pub(super) const HEADING: Key = Key::new("heading", Dimension::ANGLE, (-TAU, TAU), "90 deg");

/// Reads a pose. Both keys are required. `what` describes it in messages.
pub(super) fn pose(reader: &mut Reader<'_>, entry: &Entry, what: &'static str) -> Option<Placed<Pose>> {
    let mut fields = Fields::of(reader, &entry.value, what, entry.key.span)?;
    let position = fields.required(POSITION.name, POSITION.example);
    let position = position.and_then(|entry| reader.point(&entry.value, &POSITION));
    let heading = fields.number(reader, &HEADING);
    fields.finish(reader);
    let position = position?;
    Some(Placed { value: Pose { position: position.value, heading: heading?.value }, span: position.span })
}
