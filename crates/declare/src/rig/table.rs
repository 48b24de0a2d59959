//! The tables of keys in the documentation.

use vibrissa_runtime::rig::Whisker;
use vibrissa_runtime::units::{Key, format_si};

use super::{Access, KEYS, Part, Place, RigKey};
use crate::mismatch::{Difference, Scope};
use crate::physics::Preset;

/// The keys whose paths begin with `prefix`, with the values of the reference rig, as a table in Markdown.
#[must_use]
pub fn keys_table(prefix: &str) -> String {
    let row = |key: &RigKey| {
        let name = key.path.strip_prefix(prefix).unwrap_or(key.path);
        let range = if key.range.0 < key.range.1 { range(&key.key()) } else { String::new() };
        let simulated = if key.is_on_robot || prefix == "physics." { "" } else { ". For simulations only" };
        format!("| `{name}` | {} | {range} | {}{simulated} |\n", default(key), key.about)
    };
    let rows: String = KEYS.iter().filter(|key| key.path.starts_with(prefix)).map(row).collect();
    format!("| key | default | range | meaning |\n|---|---|---|---|\n{rows}")
}

/// The keys of a mismatch, as a table in Markdown.
#[must_use]
pub fn differences_table() -> String {
    let row = |difference: Difference| {
        let each = if difference.scope == Scope::Whisker { "yes" } else { "no" };
        format!("| `{}` | {each} | {} | {} |\n", difference.path, range(&difference.key()), difference.about)
    };
    let rows: String = Difference::all().map(row).collect();
    format!("| key | for each whisker | range | meaning |\n|---|---|---|---|\n{rows}")
}

fn range(key: &Key) -> String {
    let text = key.range_text();
    text.strip_prefix("from ").unwrap_or(&text).to_owned()
}

/// The value in the reference rig, for its first whisker. It is empty if there is none.
fn default(key: &RigKey) -> String {
    let (mut rig, mut physics) = Preset::Reference.rig();
    let mut whisker = rig.whiskers.first().cloned().unwrap_or_else(Whisker::unfitted);
    match key.place {
        Place::Platform(access) => value(key, access, &mut rig.platform),
        Place::Whisker(access) => value(key, access, &mut whisker),
        Place::Sensing(access) => value(key, access, &mut rig.sensing),
        Place::Physics(access) => value(key, access, &mut physics),
    }
}

fn value<T: Part>(key: &RigKey, access: Access<T>, part: &mut T) -> String {
    let number = |value| format_si(value, key.dimension);
    match access {
        Access::Number(field) => number(*field(part)),
        Access::Optional(field) => field(part).map(number).unwrap_or_default(),
        Access::Point(field) => format!("[{}, {}]", number(field(part).x), number(field(part).y)),
        Access::Triple(field, third, _) => {
            let [first, second, last] = *field(part);
            format!("[{}, {}, {}]", number(first), number(second), format_si(last, third))
        }
        Access::Count(field) => field(part).to_string(),
        Access::Flag(field) => field(part).to_string(),
        Access::Choice(choice) => (choice.get)(part).to_owned(),
        Access::Calibration(_) => String::new(),
    }
}
