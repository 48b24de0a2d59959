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
    /// The text. Another text is another source: its lines are counted when it is made.
    pub text: String,
    /// The first byte of each line.
    line_starts: Vec<usize>,
}

impl Source {
    /// A text under a name.
    #[must_use]
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        let text = text.into();
        let line_starts = std::iter::once(0).chain(text.match_indices('\n').map(|(newline, _)| newline + 1)).collect();
        Self { name: name.into(), text, line_starts }
    }

    /// Line and column of a byte; of the end of the text, if the byte lies beyond it.
    #[must_use]
    pub fn line_column(&self, byte: usize) -> Position {
        let byte = self.text.floor_char_boundary(byte);
        let line = self.line_starts.partition_point(|&start| start <= byte);
        let line_start = self.line_starts.get(line.saturating_sub(1)).copied().unwrap_or_default();
        Position { line, column: 1 + self.text.get(line_start..byte).unwrap_or_default().chars().count() }
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
    use proptest::prelude::*;

    #[test]
    fn columns_count_characters_and_lines_count_from_one() {
        let source = Source::new("a", "one\n\u{fc}ber 5\n");
        assert_eq!(source.line_column(0), Position { line: 1, column: 1 });
        assert_eq!(source.line_column(10), Position { line: 2, column: 6 });
        assert_eq!(source.line_column(99), Position { line: 3, column: 1 });
    }

    proptest! {
        #[test]
        fn the_place_of_a_byte_is_that_of_counting_up_to_it(text in "(\\PC|\n|\r\n){0,40}", byte in 0_usize..99) {
            let before = &text[..text.floor_char_boundary(byte)];
            let line = before.split('\n').count();
            let column = 1 + before.split('\n').next_back().map_or(0, |last| last.chars().count());
            prop_assert_eq!(Source::new("a", text.as_str()).line_column(byte), Position { line, column });
        }
    }

    #[test]
    fn a_span_beyond_the_text_or_inside_a_character_is_cut() {
        let source = Source::new("a", "\u{fc}b");
        assert_eq!(source.slice(Span::new(1, 99)), "\u{fc}b");
        assert_eq!(source.slice(Span::new(9, 4)), "");
    }
}
