//! Reader of `texture`: the roughness of an object.

use super::fault;
use super::reader::Reader;
use crate::geometry::{Texture, TextureKind};
use vibrissa_runtime::units::{Dimension, Key, format_si};
use vibrissa_text::diagnostic::Diagnostic;
use vibrissa_yaml::{Entry, Fields};

const AMPLITUDE: Key = Key::new("amplitude", Dimension::LENGTH, (1e-7, 1e-2), "0.02 mm");
const WAVELENGTH: Key = Key::new("wavelength", Dimension::LENGTH, (1e-4, 1.0), "4 mm");

/// The largest ratio of amplitude and wavelength. The sides of ridges then have slopes of up to 24°. On steeper ones, the
/// arcs would follow the height less accurately.
const STEEPEST: f64 = 0.05;

/// Reads a texture.
pub(super) fn read(reader: &mut Reader<'_>, entry: &Entry) -> Option<Texture> {
    let mut fields = Fields::of(reader, &entry.value, "a texture", entry.key.span)?;
    let kind = match fields.entry("kind") {
        Some(entry) => {
            let index = reader.choice(&entry.value, "a kind of texture", &TextureKind::ALL.map(TextureKind::name));
            index.and_then(|index| TextureKind::ALL.get(index)).copied()
        }
        None => Some(TextureKind::Random),
    };
    let amplitude = fields.number(reader, &AMPLITUDE);
    let wavelength = fields.number(reader, &WAVELENGTH);
    let seed = match fields.entry("seed") {
        Some(entry) => reader.count(&entry.value, "seed", 0..=u64::MAX, 1),
        None => Some(0),
    };
    fields.finish(reader);
    let (amplitude, wavelength) = (amplitude?, wavelength?);
    let highest = STEEPEST * wavelength.value;
    if amplitude.value > highest {
        let label = format!("must be at most {}", format_si(highest, Dimension::LENGTH));
        let fault = Diagnostic::error(fault::SHAPE, "the texture is too steep", amplitude.span, label);
        reader
            .report(fault.note(wavelength.span, "a twentieth of this").hint("use a smaller amplitude or longer waves"));
        return None;
    }
    Some(Texture { kind: kind?, amplitude: amplitude.value, wavelength: wavelength.value, seed: seed? })
}
