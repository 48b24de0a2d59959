//! From a text to its tree, and diagnostics for errors of the YAML parser.

use crate::fault::{DOCUMENTS, DUPLICATE_KEY, EMPTY, SYNTAX, TOO_LARGE};
use crate::node::{Node, Placed, span_of};
use crate::reader::Reader;
use serde_yaml::options::{DuplicateKeyPolicy, NonFiniteFloatPolicy};
use serde_yaml::{Error, Location, MessageFormatter, UserMessageFormatter};
use vibrissa_text::diagnostic::{Diagnostic, Source, Span};

/// The largest number of nodes. A scenario has a few dozen nodes, and one with traced shapes has some thousands.
const MAX_NODES: usize = 50_000;
const MAX_BYTES: usize = 1 << 20;

/// Parses a text into its tree. `what` describes the text in messages. If a key occurs twice, the tree contains its
/// first value, and the result includes the diagnostic.
///
/// # Errors
/// A diagnostic if the text is no YAML document, or if it is too large.
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

/// The span that represents a text with the root `tree`. An empty text is reported with an example, and gives `None`.
pub fn root_place(reader: &mut Reader<'_>, tree: &Placed<Node>, what: &str, hint: &'static str) -> Option<Span> {
    match &tree.value {
        Node::Mapping(entries) => Some(entries.first().map_or(tree.span, |first| first.key.span)),
        Node::Null => {
            let fault = Diagnostic::error(EMPTY, format!("the {what} is empty"), tree.span, "nothing here");
            reader.report(fault.hint(hint));
            None
        }
        _ => Some(tree.span),
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
