//! A text with a name, and places in it.

use serde::{Deserialize, Serialize};
use std::ops::Range;

/// A stretch of a [`Source`], in bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Span {
    /// The first byte.
    pub start: usize,
    /// The byte behind the last.
    pub end: usize,
}

impl Span {
    /// The span from `start` up to, not including, `end`.
    #[must_use]
    pub const fn new(start: usize, end: usize) -> Self {
        Self { start, end }
    }

    /// The smallest span that holds both.
    #[must_use]
    pub fn to(self, other: Self) -> Self {
        Self { start: self.start.min(other.start), end: self.end.max(other.end) }
    }
}

impl From<Range<usize>> for Span {
    fn from(range: Range<usize>) -> Self {
        Self::new(range.start, range.end)
    }
}

/// A place in a text as a person counts: from 1, columns in characters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Position {
    /// The line, from 1.
    pub line: usize,
    /// The column, from 1, in characters.
    pub column: usize,
}

/// A text with the name that messages show: a file's path, usually.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Source {
    /// The name.
    pub name: String,
    /// The text.
    pub text: String,
}

impl Source {
    /// A text under a name.
    #[must_use]
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self { name: name.into(), text: text.into() }
    }

    /// Line and column of a byte; of the end of the text, if the byte lies beyond it.
    #[must_use]
    pub fn line_column(&self, byte: usize) -> Position {
        let before = &self.text[..self.text.floor_char_boundary(byte)];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let line = 1 + before.bytes().filter(|&byte| byte == b'\n').count();
        Position { line, column: 1 + before[line_start..].chars().count() }
    }

    /// The text of a span; the part within the text, if it reaches beyond.
    #[must_use]
    pub fn slice(&self, span: Span) -> &str {
        &self.text[self.clamp(span)]
    }

    /// The span cut to the text and to whole characters.
    pub(super) fn clamp(&self, span: Span) -> Range<usize> {
        let start = self.text.floor_char_boundary(span.start);
        start..self.text.floor_char_boundary(span.end).max(start)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters_and_lines_count_from_one() {
        let source = Source::new("a", "one\n\u{fc}ber 5\n");
        assert_eq!(source.line_column(0), Position { line: 1, column: 1 });
        assert_eq!(source.line_column(10), Position { line: 2, column: 6 });
        assert_eq!(source.line_column(99), Position { line: 3, column: 1 });
    }

    #[test]
    fn a_span_beyond_the_text_or_inside_a_character_is_cut() {
        let source = Source::new("a", "\u{fc}b");
        assert_eq!(source.slice(Span::new(1, 99)), "\u{fc}b");
        assert_eq!(source.slice(Span::new(9, 4)), "");
    }
}
