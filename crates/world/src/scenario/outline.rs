//! Reader of `outline`: outlines from a file.

use super::fault;
use super::reader::Reader;
use super::start;
use crate::geometry::{Contour, Pose};
use crate::outline::{self, Format, Holes, OutlineError, OutlineFault, ReadOptions};
use vibrissa_runtime::units::{Dimension, Key};
use vibrissa_text::diagnostic::{Diagnostic, Span};
use vibrissa_yaml::{Entry, Fields, Placed, list};

const UNIT: Key = Key::new("unit", Dimension::LENGTH, (1e-6, 10.0), "1 mm");
const HEIGHT: Key = Key::new("height", Dimension::LENGTH, (-100.0, 100.0), "12 mm");

/// Reads the outlines of a file, in world coordinates.
pub(super) fn read(reader: &mut Reader<'_>, entry: &Entry) -> Option<impl Iterator<Item = Contour> + use<>> {
    let mut fields = Fields::of(reader, &entry.value, "an outline", entry.key.span)?;
    let path = fields.required("file", "gripper.svg").and_then(|entry| reader.text(&entry.value));
    let format = path.as_ref().and_then(|path| format(reader, path));
    let unit = match fields.entry(UNIT.name) {
        Some(entry) => reader.number(&entry.value, &UNIT).map(|unit| Some(unit.value)),
        None => Some(None),
    };
    let has_elements = matches!(format, None | Some(Format::Svg | Format::Dxf));
    let element = match if has_elements { fields.entry("element") } else { None } {
        Some(entry) => reader.text(&entry.value).map(Some),
        None => Some(None),
    };
    let height = match format {
        Some(Format::Stl) => fields.number(reader, &HEIGHT).map(|height| height.value),
        Some(_) => Some(0.0),
        None => fields.entry(HEIGHT.name).and(None),
    };
    let holes = match fields.entry("holes") {
        Some(entry) => {
            let index = reader.choice(&entry.value, "the treatment of holes", &Holes::ALL.map(Holes::name));
            index.and_then(|index| Holes::ALL.get(index)).copied()
        }
        None => Some(Holes::default()),
    };
    let frame = match fields.entry("frame") {
        Some(entry) => start::pose(reader, entry, "the frame of an outline").map(|frame| frame.value),
        None => Some(Pose::default()),
    };
    fields.finish(reader);
    let (path, format, unit, element) = (path?, format?, unit?, element?);
    let (height, holes, frame) = (height?, holes?, frame?);
    let bytes = reader.outline_file(&path.value).map_err(|reason| {
        let message = format!("cannot read `{}`", path.value);
        let fault = Diagnostic::error(fault::FILE, message, path.span, reason);
        reader.report(fault.hint("a path is relative to the folder of the scenario"));
    });
    let options = ReadOptions { unit, element: element.as_ref().map(|element| element.value.as_str()), height, holes };
    match outline::read(&bytes.ok()?, format, &options) {
        Ok(contours) => {
            reader.make(contours.iter().map(|contour| contour.pieces().len()).sum(), path.span)?;
            Some(contours.into_iter().map(move |contour| contour.transformed(&frame)))
        }
        Err(error) => {
            let place = match (&error.fault, &element) {
                (OutlineFault::NoElement { .. }, Some(element)) => element.span,
                _ => path.span,
            };
            reader.report(diagnose(&error, &path.value, place));
            None
        }
    }
}

/// The format of a file, by its extension.
fn format(reader: &mut Reader<'_>, path: &Placed<String>) -> Option<Format> {
    let format = Format::of(&path.value);
    if format.is_none() {
        let endings = Format::ALL.map(|format| format!(".{}", format.ending()));
        let message = format!("`{}` is not in a supported format", path.value);
        let label = format!("must end in {}", list(&endings, "or"));
        let fault = Diagnostic::error(fault::FILE, message, path.span, label);
        reader.report(fault.hint("save the drawing in one of these formats"));
    }
    format
}

fn diagnose(error: &OutlineError, path: &str, place: Span) -> Diagnostic {
    let (code, message) = match error.fault {
        OutlineFault::NotBuilt => (fault::NOT_BUILT, format!("cannot read `{path}`")),
        _ => (fault::OUTLINE, format!("`{path}` cannot be used")),
    };
    Diagnostic::error(code, message, place, error.to_string()).hint(error.fault.advice())
}
