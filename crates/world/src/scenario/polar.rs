//! Reader of `polar`: smooth closed curves.

use super::fault;
use super::object::{RADIUS, centre, made};
use super::reader::Reader;
use crate::geometry::{Contour, Harmonic, polar_curve, polar_curve_pieces};
use std::f64::consts::TAU;
use vibrissa_runtime::units::{Dimension, Key};
use vibrissa_text::diagnostic::{Diagnostic, Span};
use vibrissa_yaml::{Entry, Fields, Node, Placed};

const AMPLITUDE: Key = Key::new("amplitude", Dimension::LENGTH, (-10.0, 10.0), "20 mm");
const PHASE: Key = Key::new("phase", Dimension::ANGLE, (-TAU, TAU), "30 deg");

const HARMONICS: &str = "[{order: 3, amplitude: 20 mm, phase: 30 deg}]";

/// The largest number of harmonics, one per possible order.
const MAX_HARMONICS: usize = 100;

/// Reads a curve in polar coordinates.
pub(super) fn read(reader: &mut Reader<'_>, entry: &Entry) -> Option<Contour> {
    let mut fields = Fields::of(reader, &entry.value, "a polar curve", entry.key.span)?;
    let centre = centre(reader, &mut fields);
    let radius = fields.number(reader, &RADIUS);
    let harmonics = fields.required("harmonics", HARMONICS);
    fields.finish(reader);
    let harmonics = harmonics?;
    let items = reader.items(&harmonics.value, "a list of harmonics", HARMONICS)?;
    if items.len() > MAX_HARMONICS {
        let message = format!("a polar curve cannot have {} harmonics", items.len());
        let label = format!("must be at most {MAX_HARMONICS}");
        let fault = Diagnostic::error(fault::RANGE, message, harmonics.key.span, label);
        reader.report(fault.hint("combine harmonics of the same order"));
        return None;
    }
    let harmonics: Vec<_> = items.iter().map(|item| harmonic(reader, item, harmonics.key.span)).collect();
    let harmonics: Vec<_> = harmonics.into_iter().collect::<Option<_>>()?;
    let (centre, radius) = (centre?, radius?.value);
    reader.make(polar_curve_pieces(radius, &harmonics), entry.key.span)?;
    made(reader, polar_curve(centre, radius, &harmonics), entry.key.span, &[])
}

fn harmonic(reader: &mut Reader<'_>, item: &Placed<Node>, place: Span) -> Option<Harmonic> {
    let mut fields = Fields::of(reader, item, "a harmonic", place)?;
    let order = fields.required("order", "3").and_then(|entry| reader.count(&entry.value, "order", 1..=100, 3));
    let amplitude = fields.number(reader, &AMPLITUDE);
    let phase = fields.number(reader, &PHASE);
    fields.finish(reader);
    Some(Harmonic { order: order?, amplitude: amplitude?.value, phase: phase?.value })
}
