//! A named text, and positions in it.

use std::ops::Range;

use super::Position;

/// A range of bytes in a [`Source`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Span {
    /// The first byte.
    pub start: usize,
    /// The byte after the last.
    pub end: usize,
}

impl Span {
    /// The span from `start` to `end`, without `end`.
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

/// A text with the name that messages show, usually the path of a file.
///
/// The files that it uses may be its further parts. Their texts follow the first one, each after a line end. Positions
/// in them are shown with their own names and lines.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Source {
    /// The name of the first part.
    pub name: String,
    /// The text of all parts. It must not change, because the lines are counted when the source is created.
    pub text: String,
    /// The first byte of each line.
    line_starts: Vec<usize>,
    /// The parts after the first.
    parts: Vec<Part>,
}

/// A text that belongs to a [`Source`] as a file of its own.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Part {
    name: String,
    start: usize,
    /// The reason for which there is no text, if there is none.
    absence: Option<String>,
}

impl Source {
    /// A text with a name.
    #[must_use]
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        let text = text.into();
        let line_starts = std::iter::once(0).chain(ends(&text)).collect();
        Self { name: name.into(), text, line_starts, parts: Vec::new() }
    }

    /// Adds a part: its text, or the reason for which there is none.
    pub fn add(&mut self, name: impl Into<String>, text: Result<&str, String>) {
        self.text.push('\n');
        let start = self.text.len();
        let (text, absence) = text.map_or_else(|reason| ("", Some(reason)), |text| (text, None));
        self.text.push_str(text);
        self.line_starts.push(start);
        self.line_starts.extend(ends(text).map(|end| start + end));
        self.parts.push(Part { name: name.into(), start, absence });
    }

    /// Number of parts, including the first.
    #[must_use]
    pub fn count(&self) -> usize {
        1 + self.parts.len()
    }

    /// The name of a part; empty if there is none with this index.
    #[must_use]
    pub fn part_name(&self, part: usize) -> &str {
        match part.checked_sub(1) {
            None => &self.name,
            Some(index) => self.parts.get(index).map_or("", |part| &part.name),
        }
    }

    /// The reason for which a part has no text, if it has none.
    #[must_use]
    pub fn absence(&self, part: usize) -> Option<&str> {
        self.parts.get(part.checked_sub(1)?)?.absence.as_deref()
    }

    /// Span of the text of a part. If there is no such part, the span is empty and at the end of all texts.
    #[must_use]
    pub fn part_span(&self, part: usize) -> Span {
        let start = |part: usize| part.checked_sub(1).map_or(Some(0), |index| Some(self.parts.get(index)?.start));
        Span::new(start(part).unwrap_or(self.text.len()), start(part + 1).map_or(self.text.len(), |next| next - 1))
    }

    /// The index of the part that a byte lies in.
    #[must_use]
    pub fn part_at(&self, byte: usize) -> usize {
        self.parts.partition_point(|part| part.start <= byte)
    }

    /// Line and column of a byte in its part. Beyond the end of the text, those of the end.
    #[must_use]
    pub fn line_column(&self, byte: usize) -> Position {
        let byte = self.text.floor_char_boundary(byte);
        let line_of = |byte| self.line_starts.partition_point(|&start| start <= byte);
        let line = line_of(byte);
        let line_start = self.line_starts.get(line.saturating_sub(1)).copied().unwrap_or_default();
        let before = line_of(self.part_span(self.part_at(byte)).start);
        Position {
            line: 1 + line - before,
            column: 1 + self.text.get(line_start..byte).unwrap_or_default().chars().count(),
        }
    }

    /// The text of a span. If the span exceeds the text, only the part within the text.
    #[must_use]
    pub fn slice(&self, span: Span) -> &str {
        &self.text[self.clamp(span)]
    }

    /// The text of an expression or a type, without comments, on one line with single blanks.
    #[must_use]
    pub fn on_one_line(&self, span: Span) -> String {
        // Expressions contain no strings, so every `#` begins a comment.
        let lines = self.slice(span).lines().map(|line| line.split('#').next().unwrap_or_default());
        lines.flat_map(str::split_whitespace).collect::<Vec<_>>().join(" ")
    }

    /// The span, limited to the text, to the part in which it begins, and to whole characters.
    pub(super) fn clamp(&self, span: Span) -> Range<usize> {
        let start = self.text.floor_char_boundary(span.start);
        let end = span.end.min(self.part_span(self.part_at(start)).end);
        start..self.text.floor_char_boundary(end).max(start)
    }
}

/// The bytes after the line ends of a text.
fn ends(text: &str) -> impl Iterator<Item = usize> {
    text.match_indices('\n').map(|(newline, _)| newline + 1)
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

    proptest! {
        #[test]
        fn a_place_in_a_part_is_that_in_a_text_of_its_own(texts in prop::collection::vec("(\\PC|\n){0,20}", 1..5), byte in 0_usize..25) {
            let mut source = Source::new("0", texts[0].as_str());
            for (index, text) in texts.iter().enumerate().skip(1) {
                source.add(index.to_string(), Ok(text));
            }
            for (index, text) in texts.iter().enumerate() {
                let (span, alone) = (source.part_span(index), Source::new("", text.as_str()));
                prop_assert_eq!(source.slice(span), text.as_str());
                prop_assert_eq!(source.part_name(index), index.to_string());
                let byte = byte.min(text.len());
                prop_assert_eq!(source.part_at(span.start + byte), index);
                prop_assert_eq!(source.line_column(span.start + byte), alone.line_column(byte));
                let reaching = Span::new(span.start + byte, source.text.len());
                prop_assert_eq!(source.slice(reaching), alone.slice(Span::new(byte, text.len())));
            }
        }
    }
}
