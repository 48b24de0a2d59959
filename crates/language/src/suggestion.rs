//! Suggestions for misspelled names.

use vibrissa_runtime::units::suggest;
use vibrissa_text::diagnostic::Diagnostic;

/// The maximum length of names with suggestions (bytes). The time of a comparison is quadratic in the length.
const NAME_LIMIT: usize = 64;

/// Adds a suggestion to a diagnostic: the name of `known` that is nearest to `name`. Among equally near names, the
/// first in alphabetical order.
pub(super) fn did_you_mean<'a>(
    diagnostic: Diagnostic,
    name: &str,
    known: impl IntoIterator<Item = &'a str>,
) -> Diagnostic {
    if name.len() > NAME_LIMIT {
        return diagnostic;
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
