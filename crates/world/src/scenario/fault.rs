//! Diagnostics for errors of the YAML parser, and the codes of all diagnostics of scenarios and sweeps.

use super::node::{Node, Placed, span_of};
use serde_yaml::options::{DuplicateKeyPolicy, NonFiniteFloatPolicy};
use serde_yaml::{Error, Location, MessageFormatter, UserMessageFormatter};
use vibrissa_text::diagnostic::{Diagnostic, Source, Span};

/// The text is not YAML.
pub(crate) const SYNTAX: &str = "S0001";
/// The text is empty.
pub(crate) const EMPTY: &str = "S0002";
/// A key occurs twice in a mapping.
pub(crate) const DUPLICATE_KEY: &str = "S0003";
/// The text contains several documents.
pub(crate) const DOCUMENTS: &str = "S0004";
/// The text is too large, or its aliases make it so.
pub(crate) const TOO_LARGE: &str = "S0005";
/// A key is unknown.
pub const UNKNOWN_KEY: &str = "S0101";
/// A key is missing.
pub const MISSING_KEY: &str = "S0102";
/// A value has the wrong type.
pub(crate) const TYPE: &str = "S0103";
/// A word is none of the possible ones.
pub(crate) const CHOICE: &str = "S0104";
/// A number has no unit.
pub(crate) const BARE_NUMBER: &str = "S0201";
/// A text is not a number with a unit.
pub(crate) const QUANTITY: &str = "S0202";
/// A unit does not exist.
pub(crate) const UNIT: &str = "S0203";
/// A unit has the wrong dimension.
pub const DIMENSION: &str = "S0204";
/// A number is out of range.
pub const RANGE: &str = "S0301";
/// A shape is impossible.
pub(crate) const SHAPE: &str = "S0302";
/// Rates and times are inconsistent.
pub(crate) const TIMING: &str = "S0303";
/// The rig overlaps an object at the start.
pub(crate) const OVERLAP: &str = "S0304";
/// A name is invalid.
pub(crate) const NAME: &str = "S0305";
/// The rig is inconsistent.
pub(crate) const RIG: &str = "S0306";
/// A file cannot be read.
pub(crate) const FILE: &str = "S0401";
/// A file contains no outline.
pub(crate) const OUTLINE: &str = "S0402";
/// This build has no reader for a file.
pub(crate) const NOT_BUILT: &str = "S0403";
/// A sweep would execute a run twice.
pub const REPEATED: &str = "S0501";
/// A policy does not accept a value of a sweep.
pub const UNFIT: &str = "S0502";
/// A sweep varies a key that another of its keys determines.
pub const ENTANGLED: &str = "S0503";

/// The largest number of nodes. A scenario has a few dozen nodes, and one with traced shapes has some thousands.
const MAX_NODES: usize = 50_000;
const MAX_BYTES: usize = 1 << 20;

/// Parses a text into its tree. `what` describes the text in messages. If a key occurs twice, the tree contains its
/// first value, and the result includes the diagnostic.
///
/// # Errors
/// All errors, in the order of the text.
pub fn parse(source: &Source, what: &str) -> Result<(Placed<Node>, Vec<Diagnostic>), Vec<Diagnostic>> {
    if source.text.len() > MAX_BYTES {
        let message = format!("the {what} is larger than 1 MiB");
        let fault = Diagnostic::error(TOO_LARGE, message, Span::default(), "of this file");
        return Err(vec![fault.hint(format!("a {what} is a short text; check that this is the right file"))]);
    }
    let parse = |duplicate_keys| {
        let options = serde_yaml::options! {
            budget: serde_yaml::budget! { max_nodes: MAX_NODES, max_depth: 32 },
            duplicate_keys: duplicate_keys,
            non_finite_float_policy: NonFiniteFloatPolicy::AsString,
            with_snippet: false,
        };
        serde_yaml::from_str_with_options(&source.text, options)
    };
    match parse(DuplicateKeyPolicy::Error) {
        Ok(tree) => Ok((tree, Vec::new())),
        Err(error) => {
            let faults = vec![diagnose(source, what, &error)];
            let is_duplicate = matches!(error, Error::DuplicateMappingKey { .. });
            let tree = if is_duplicate { parse(DuplicateKeyPolicy::FirstWins).ok() } else { None };
            tree.map_or(Err(faults.clone()), |tree| Ok((tree, faults)))
        }
    }
}

fn diagnose(source: &Source, what: &str, error: &Error) -> Diagnostic {
    let span = error.location().map_or(Span::default(), |location| place(source, location));
    let cause = if let Error::AliasError { error, .. } = error { error } else { error };
    match cause {
        Error::DuplicateMappingKey { key, .. } => {
            let key = key.as_deref().unwrap_or(source.slice(span));
            Diagnostic::error(DUPLICATE_KEY, format!("the key `{key}` occurs twice"), span, "the second one")
                .hint("remove one of them, or rename it")
        }
        Error::MultipleDocuments { .. } => {
            let message = format!("a file holds one {what}");
            Diagnostic::error(DOCUMENTS, message, span, "a second document begins here")
                .hint("move it to a file of its own, or remove the line `---`")
        }
        Error::Budget { .. }
        | Error::AliasReplayCounterOverflow { .. }
        | Error::AliasReplayLimitExceeded { .. }
        | Error::AliasExpansionLimitExceeded { .. }
        | Error::AliasReplayStackDepthExceeded { .. } => Diagnostic::error(
            TOO_LARGE,
            format!("the {what} is too large or too deeply nested"),
            span,
            "the limit is exceeded here",
        )
        .hint(format!("a {what} has at most {MAX_NODES} values, including those that aliases repeat")),
        Error::RecursiveReferencesRequireWeakTypes { .. } => {
            Diagnostic::error(SYNTAX, "an alias refers to a value that contains it", span, "this reference has no end")
                .hint("replace the alias by a value")
        }
        Error::UnknownAnchor { .. } => {
            Diagnostic::error(SYNTAX, "an alias has no anchor", span, "there is no such anchor above")
                .hint("mark the value with `&name`, or replace the alias by a value")
        }
        _ => Diagnostic::error(SYNTAX, "this is not valid YAML", span, UserMessageFormatter.format_message(cause))
            .hint("look at this line and the one above it: indentation, brackets, quotes, a `:` too many or too few"),
    }
}

/// The span of a parser's location, which may contain only line and column.
fn place(source: &Source, location: Location) -> Span {
    if location.span().byte_offset().is_some() {
        return span_of(location);
    }
    let index = |number: u64| usize::try_from(number).unwrap_or(usize::MAX).saturating_sub(1);
    let mut lines = source.text.split_inclusive('\n');
    let line_start: usize = lines.by_ref().take(index(location.line())).map(str::len).sum();
    let line = lines.next().unwrap_or_default();
    let (start, length) = line
        .char_indices()
        .nth(index(location.column()))
        .map_or((line.len(), 0), |(start, character)| (start, character.len_utf8()));
    Span::new(line_start + start, line_start + start + length)
}
