//! Reader of the value of one key.

use vibrissa_declare::rig::{Access, RigKey};
use vibrissa_runtime::calibration::Calibration;
use vibrissa_text::diagnostic::{Diagnostic, NotUtf8, Span, utf8};

use crate::calibration::read_calibration;
use crate::fault;
use crate::node::{Entry, Node};
use crate::reader::Reader;
use crate::value::read_value;

/// Reads a value into a field of a part, and returns its place.
pub(super) fn read<T>(
    reader: &mut Reader<'_>,
    entry: &Entry,
    key: &RigKey,
    access: Access<T>,
    part: &mut T,
) -> Option<Span> {
    let node = &entry.value;
    match access {
        Access::Number(field) => *field(part) = reader.number(node, &key.key())?.value,
        Access::Optional(field) => *field(part) = Some(reader.number(node, &key.key())?.value),
        Access::Point(field) => *field(part) = reader.point(node, &key.key())?.value,
        Access::Triple(field, dimension, range) => {
            let items = reader.triple(node, key.example)?;
            let mut third = key.key();
            (third.dimension, third.range) = (dimension, range);
            for ((item, key), target) in items.iter().zip([key.key(), key.key(), third]).zip(field(part)) {
                if let Some(number) = reader.number(item, &key) {
                    *target = number.value;
                }
            }
        }
        Access::Count(field) => {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small counts")]
            let (least, greatest) = (key.range.0 as usize, key.range.1 as usize);
            let example = key.example.parse().unwrap_or(least);
            *field(part) = reader.count(node, key.name(), least..=greatest, example)?;
        }
        Access::Flag(field) => *field(part) = reader.flag(node)?,
        Access::Choice(choice) => {
            let word = reader.choice(node, choice.what, &(choice.words)())?;
            if let Err(refusal) = (choice.set)(part, word) {
                let fault = Diagnostic::error(fault::RIG, refusal.message, node.span, refusal.label);
                reader.report(fault.hint(refusal.hint));
            }
        }
        Access::Calibration(field) => *field(part) = Some(calibration(reader, entry)?),
    }
    Some(reader.extent(node))
}

/// Reads a calibration: its values, or those of a file.
fn calibration(reader: &mut Reader<'_>, entry: &Entry) -> Option<Calibration> {
    if matches!(entry.value.value, Node::Mapping(_)) {
        let read: Result<Calibration, _> = read_value(&entry.value);
        let checked = read.map_err(|fault| (fault.span(), fault.to_string())).and_then(|calibration| {
            let fault = calibration.check().map_err(|error| (entry.key.span, error.to_string()));
            fault.map(|()| calibration)
        });
        return checked
            .map_err(|(span, reason)| {
                let fault = Diagnostic::error(fault::TYPE, "the calibration cannot be used", span, reason);
                reader.report(fault.hint("copy the values that `vibrissa calibrate` writes into robot.yaml"));
            })
            .ok();
    }
    let path = reader.text(&entry.value)?;
    let found = reader.file(&path.value).and_then(|bytes| {
        let text = utf8(&bytes).map_err(|fault| format!("{fault}; {}", NotUtf8::ADVICE))?;
        read_calibration(text).map_err(|error| error.to_string())
    });
    found
        .map_err(|reason| {
            let fault = Diagnostic::error(fault::FILE, format!("cannot use `{}`", path.value), path.span, reason);
            reader.report(
                fault.hint("give the path of a file of `vibrissa calibrate`, relative to the folder of this file"),
            );
        })
        .ok()
}
