//! Suggestions for misspelled names.

use vibrissa_runtime::units::suggest;
use vibrissa_text::diagnostic::Diagnostic;

/// The maximum length of names with suggestions (bytes). The time of a comparison is quadratic in the length.
const NAME_LIMIT: usize = 64;

/// The former names of the language with the present ones.
const RENAMED: [(&str, &str); 4] = [
    ("deflection", "base_angle"),
    ("deflection_spread", "base_angle_deviation"),
    ("tip_spread", "tip_deviation"),
    ("truth", "bool"),
];

/// Adds a suggestion to a diagnostic: the name of `known` that is nearest to `name`. Among equally near names, the
/// first in alphabetical order. A former name of the language leads to the present one.
pub(super) fn did_you_mean<'a>(
    diagnostic: Diagnostic,
    name: &str,
    known: impl IntoIterator<Item = &'a str>,
) -> Diagnostic {
    if name.len() > NAME_LIMIT {
        return diagnostic;
    }
    let known: Vec<&str> = known.into_iter().collect();
    let renamed = RENAMED.iter().find(|(former, present)| *former == name && known.contains(present));
    if let Some((former, present)) = renamed {
        return diagnostic.hint(format!("`{former}` is now `{present}`"));
    }
    // The edit distance of two names is at least the difference of their lengths. To compare these takes less time.
    let allowed = (name.chars().count() / 3).max(1);
    let is_alike = |known: &str| !(name.is_ascii() && known.is_ascii()) || known.len().abs_diff(name.len()) <= allowed;
    let known = known.into_iter().filter(|known| known.len() <= NAME_LIMIT && is_alike(known));
    let mut known: Vec<&str> = known.collect();
    known.sort_unstable();
    match suggest(name, known) {
        Some(meant) => diagnostic.hint(format!("did you mean `{meant}`?")),
        None => diagnostic,
    }
}
