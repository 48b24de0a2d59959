//! "Did you mean …?"

use crate::diagnostic::Diagnostic;
use vibrissa_runtime::units::suggest;

/// Names longer than this (bytes) get no suggestion: comparing them takes time that grows with the square of their length.
const NAME_LIMIT: usize = 64;

/// Adds the one of `known` that `name` was probably meant to be to a diagnostic, if there is one. Of equally near ones it
/// is the first in the alphabet.
pub(super) fn did_you_mean<'a>(
    diagnostic: Diagnostic,
    name: &str,
    known: impl IntoIterator<Item = &'a str>,
) -> Diagnostic {
    if name.len() > NAME_LIMIT {
        return diagnostic;
    }
    let mut known: Vec<&str> = known.into_iter().filter(|known| known.len() <= NAME_LIMIT).collect();
    known.sort_unstable();
    match suggest(name, known) {
        Some(meant) => diagnostic.hint(format!("did you mean `{meant}`?")),
        None => diagnostic,
    }
}
