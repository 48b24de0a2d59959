//! Reader of `mismatch`: the differences between the true array and the assumed one.

use super::fault;
use super::reader::Reader;
use crate::mismatch::{Difference, Loss, Mismatch, Range, Ranges};
use vibrissa_declare::mismatch::Scope;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::units::Key;
use vibrissa_text::diagnostic::{Diagnostic, NotUtf8, Source, Span, utf8};
use vibrissa_yaml::{Entry, Fields, Node, Placed, parse, root_place};

/// Reads a file that has a mismatch alone.
///
/// # Errors
/// As for [`read`](super::read).
pub fn read_mismatch(source: &Source) -> Result<Mismatch, Vec<Diagnostic>> {
    let (tree, faults) = parse(source, "mismatch")?;
    let mut files = |_: &str| Err("a file of a mismatch cannot name another file".to_owned());
    let mut reader = Reader::new(source, &mut files, faults);
    let hint = "write at least one key, such as `stiffness: 5 %`; see scenarios/mismatch/plausible.yaml";
    let place = root_place(&mut reader, &tree, "mismatch", hint);
    let mismatch = place.and_then(|place| read_tree(&mut reader, &tree, place));
    reader.finish(mismatch).map(|mismatch| Mismatch { file: Some(source.name.clone()), ..mismatch })
}

/// Reads the section of a scenario.
pub(super) fn read_section(reader: &mut Reader<'_>, entry: &Entry) -> Option<Mismatch> {
    read_tree(reader, &entry.value, entry.key.span)
}

/// Checks that the array of a mismatch at `place` can be simulated for this rig.
pub(super) fn check(reader: &mut Reader<'_>, mismatch: &Mismatch, rig: &Rig, place: Span) {
    let checked = if reader.is_mujoco { mismatch.check(rig) } else { mismatch.check_without_inertia(rig) };
    if let Err(error) = checked {
        let fault = Diagnostic::error(fault::RIG, error.to_string(), place, "of this mismatch");
        reader.report(fault.hint("a mismatch describes the whiskers of the rig of the scenario"));
    }
}

fn read_tree(reader: &mut Reader<'_>, node: &Placed<Node>, place: Span) -> Option<Mismatch> {
    let mut fields = Fields::of(reader, node, "a mismatch", place)?;
    let mut mismatch = Mismatch::default();
    if let Some(entry) = fields.entry("seed") {
        mismatch.seed = reader.count(&entry.value, "seed", 0..=u64::MAX, 1);
    }
    let base = fields.entry("from").and_then(|entry| from_file(reader, entry));
    let common = &mut mismatch.common;
    mismatch.loss = read_keys(reader, &mut fields, "", |_| true, common);
    if let Some(entry) = fields.entry("whiskers") {
        single_whiskers(reader, entry, &mut mismatch);
    }
    fields.finish(reader);
    if let Some(base) = base {
        mismatch.complete(&base);
    }
    Some(mismatch)
}

/// Reads the file that a section names.
fn from_file(reader: &mut Reader<'_>, entry: &Entry) -> Option<Mismatch> {
    let path = reader.text(&entry.value)?;
    let found = reader.file(&path.value).and_then(|bytes| {
        let text = utf8(&bytes).map_err(|fault| format!("{fault}; {}", NotUtf8::ADVICE))?;
        let faults = |faults: Vec<Diagnostic>| faults.first().map_or_else(String::new, |fault| fault.message.clone());
        read_mismatch(&Source::new(path.value.as_str(), text)).map_err(faults)
    });
    found
        .map_err(|reason| {
            let fault = Diagnostic::error(fault::FILE, format!("cannot use `{}`", path.value), path.span, reason);
            reader.report(fault.hint("give the path of a mismatch, relative to the folder of the scenario"));
        })
        .ok()
}

/// Reads the properties of single whiskers.
fn single_whiskers(reader: &mut Reader<'_>, entry: &Entry, mismatch: &mut Mismatch) {
    let Node::Mapping(entries) = &entry.value.value else {
        reader.wrong_type(&entry.value, "a mapping", "write each whisker under its name, such as `r0: {length: 1 mm}`");
        return;
    };
    for Entry { key, value } in entries {
        let Some(mut fields) = Fields::of(reader, value, "the mismatch of a whisker", key.span) else { continue };
        let mut ranges = Ranges::default();
        read_keys(reader, &mut fields, "", |difference| difference.scope == Scope::Whisker, &mut ranges);
        fields.finish(reader);
        mismatch.whiskers.insert(key.value.clone(), ranges);
    }
}

/// The mapping of the loss of readings, which has its kind too.
const LOST: &str = "sensor.lost.";

/// Reads the properties whose paths begin with `path`, and returns the kind of a loss of readings.
fn read_keys(
    reader: &mut Reader<'_>,
    fields: &mut Fields<'_>,
    path: &'static str,
    is_read: fn(&Difference) -> bool,
    ranges: &mut Ranges,
) -> Option<Loss> {
    let mut groups = Vec::new();
    let mut loss = None;
    for difference in Difference::all().filter(is_read) {
        let Some(name) = difference.path.strip_prefix(path) else { continue };
        let Some((group, _)) = name.split_once('.') else {
            let key = difference.key();
            if let Some(range) = fields.entry(name).and_then(|entry| range(reader, &entry.value, &key)) {
                ranges.set(difference.property, range);
            }
            continue;
        };
        if groups.contains(&group) {
            continue;
        }
        groups.push(group);
        let Some(entry) = fields.entry(group) else { continue };
        let path = difference.path.get(..=path.len() + group.len()).unwrap_or_default();
        let what = if path == LOST { "the loss of readings" } else { "this part of a mismatch" };
        let Some(mut inner) = Fields::of(reader, &entry.value, what, entry.key.span) else { continue };
        loss = loss.or(read_keys(reader, &mut inner, path, is_read, ranges));
        if path == LOST {
            loss = inner.entry("kind").and_then(|kind| {
                let index = reader.choice(&kind.value, "a lost reading", &Loss::ALL.map(Loss::name))?;
                Loss::ALL.get(index).copied()
            });
        }
        inner.finish(reader);
    }
    loss
}

/// Reads a value, or a list of the least and the greatest value.
fn range(reader: &mut Reader<'_>, node: &Placed<Node>, key: &Key) -> Option<Range> {
    let Node::List(items) = &node.value else { return reader.number(node, key).map(|number| number.value.into()) };
    let [least, greatest] = items.as_slice() else {
        let message = format!("expected 2 numbers, found {}", items.len());
        let fault =
            Diagnostic::error(fault::TYPE, message, reader.extent(node), "must be a least and a greatest value");
        reader.report(
            fault.hint(format!("write one value, such as `{}: {}`, or the ends of a range", key.name, key.example)),
        );
        return None;
    };
    let (least, greatest) = (reader.number(least, key), reader.number(greatest, key));
    let range = Range { least: least?.value, greatest: greatest?.value };
    if range.least > range.greatest {
        let message = format!("the range of `{}` is empty", key.name);
        let fault = Diagnostic::error(fault::RANGE, message, reader.extent(node), "the first value exceeds the second");
        reader.report(fault.hint("write the least value first"));
        return None;
    }
    Some(range)
}
