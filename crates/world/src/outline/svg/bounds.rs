//! Limits that are checked before parsing, because parsing could take too long or too much memory.
//!
//! The parser compares each attribute of an element with all others. It copies the namespaces of an element into its
//! children, and expands every reference to an entity.

use super::super::{OutlineError, OutlineFault, SIZE_LIMIT};

/// The largest number of attributes of an element. Drawings have a few dozen.
const MAX_ATTRIBUTES: usize = 256;

/// The largest number of namespace declarations of a document. Drawings have a dozen, mostly in their first element.
const MAX_NAMESPACES: usize = 1000;

/// Checks that a document can be parsed with time and memory proportional to its text.
///
/// Attribute values and names contain no `<`. Therefore each part between two of these has at most one tag.
pub(super) fn check(text: &str) -> Result<(), OutlineError> {
    if text.matches("xmlns").count() > MAX_NAMESPACES {
        return Err(OutlineFault::TooLarge { what: "declarations of namespaces", limit: MAX_NAMESPACES }.into());
    }
    let (mut line, mut declared) = (1, 0_usize);
    for part in text.split('<') {
        if part.starts_with("!ENTITY") {
            declared += part.len();
            if Tag::of(part).is_open || part.contains('&') {
                let what = "an entity that holds elements or other entities".to_owned();
                let advice = "write its text where it is referred to, and take it out";
                return Err(OutlineFault::Unsupported { what, advice }.at(Some(line)));
            }
        } else if !part.starts_with(['!', '?']) && Tag::of(part).attributes > MAX_ATTRIBUTES {
            return Err(
                OutlineFault::TooLarge { what: "attributes of an element", limit: MAX_ATTRIBUTES }.at(Some(line))
            );
        }
        line += part.matches('\n').count();
    }
    if declared.saturating_mul(text.matches('&').count()) > SIZE_LIMIT {
        return Err(OutlineFault::TooLarge { what: "bytes that entities stand for", limit: SIZE_LIMIT }.into());
    }
    Ok(())
}

/// A tag, without its `<`.
struct Tag {
    /// The number of its quoted values.
    attributes: usize,
    /// True if the tag has no end.
    is_open: bool,
}

impl Tag {
    fn of(part: &str) -> Self {
        let (mut attributes, mut quote) = (0, None);
        for byte in part.bytes() {
            match (quote, byte) {
                (Some(open), byte) if byte == open => quote = None,
                (None, b'"' | b'\'') => {
                    attributes += 1;
                    quote = Some(byte);
                }
                (None, b'>') => return Self { attributes, is_open: false },
                _ => {}
            }
        }
        Self { attributes, is_open: true }
    }
}
