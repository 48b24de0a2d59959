//! Positions of the protocol. Lines and columns count from 0, and columns count units of an encoding.

use std::ops::Range;

use gen_lsp_types::{self as lsp, PositionEncodingKind};

use vibrissa_text::diagnostic::Span;

/// The unit of columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Encoding {
    /// Bytes.
    Utf8,
    /// Units of UTF-16, which every client supports.
    #[default]
    Utf16,
    /// Characters.
    Utf32,
}

impl Encoding {
    /// The encoding for a client that supports `offered`. Bytes are preferred, because the compiler uses them.
    pub(super) fn choose(offered: &[PositionEncodingKind]) -> Self {
        if offered.contains(&PositionEncodingKind::UTF8) {
            Self::Utf8
        } else if offered.contains(&PositionEncodingKind::UTF32) && !offered.contains(&PositionEncodingKind::UTF16) {
            Self::Utf32
        } else {
            Self::Utf16
        }
    }

    pub(super) fn kind(self) -> PositionEncodingKind {
        match self {
            Self::Utf8 => PositionEncodingKind::UTF8,
            Self::Utf16 => PositionEncodingKind::UTF16,
            Self::Utf32 => PositionEncodingKind::UTF32,
        }
    }

    fn width(self, letter: char) -> usize {
        match self {
            Self::Utf8 => letter.len_utf8(),
            Self::Utf16 => letter.len_utf16(),
            Self::Utf32 => 1,
        }
    }
}

/// The lines of a text, which end with `\n`, `\r\n` or `\r`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Lines(Vec<Range<usize>>);

impl Lines {
    pub(super) fn new(text: &str) -> Self {
        let mut lines = Vec::new();
        let mut start = 0;
        let bytes = text.as_bytes();
        for (at, &byte) in bytes.iter().enumerate() {
            let is_end = byte == b'\n' || (byte == b'\r' && bytes.get(at + 1) != Some(&b'\n'));
            if is_end {
                let is_double = byte == b'\n' && at > start && bytes[at - 1] == b'\r';
                lines.push(start..at - usize::from(is_double));
                start = at + 1;
            }
        }
        lines.push(start..text.len());
        Self(lines)
    }

    /// The byte at a position. Beyond the end of its line, the end of the line. Beyond the last line, the end of the
    /// text. Within a character, the start of that character.
    pub(super) fn byte(&self, text: &str, position: lsp::Position, encoding: Encoding) -> usize {
        let line = usize::try_from(position.line).ok().and_then(|line| self.0.get(line));
        let Some(line) = line else { return text.len() };
        let mut left = usize::try_from(position.character).unwrap_or(usize::MAX);
        for (at, letter) in text[line.clone()].char_indices() {
            let width = encoding.width(letter);
            if left < width {
                return line.start + at;
            }
            left -= width;
        }
        line.end
    }

    /// The position of a byte. Within a line end, the position of the line end.
    pub(super) fn position(&self, text: &str, byte: usize, encoding: Encoding) -> lsp::Position {
        let byte = text.floor_char_boundary(byte);
        let line = self.0.partition_point(|line| line.start <= byte).saturating_sub(1);
        let Range { start, end } = self.0.get(line).cloned().unwrap_or_default();
        let column: usize = text[start..byte.min(end)].chars().map(|letter| encoding.width(letter)).sum();
        lsp::Position { line: count(line), character: count(column) }
    }

    pub(super) fn range(&self, text: &str, span: Span, encoding: Encoding) -> lsp::Range {
        let position = |byte| self.position(text, byte, encoding);
        lsp::Range { start: position(span.start), end: position(span.end.max(span.start)) }
    }

    /// The span of a range. Its ends may be in any order.
    pub(super) fn span(&self, text: &str, range: lsp::Range, encoding: Encoding) -> Span {
        let [a, b] = [range.start, range.end].map(|position| self.byte(text, position, encoding));
        Span::new(a.min(b), a.max(b))
    }
}

fn count(number: usize) -> u32 {
    u32::try_from(number).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const ENCODINGS: [Encoding; 3] = [Encoding::Utf8, Encoding::Utf16, Encoding::Utf32];
    const TEXT: &str = "(\\PC|\n|\r\n|\r|\u{1f980}|\u{e4}|a){0,40}";

    proptest! {
        #[test]
        fn a_byte_and_its_position_are_one_place(text in TEXT, byte in 0_usize..120) {
            let byte = text.floor_char_boundary(byte);
            let within_an_end = text[..byte].ends_with('\r') && text[byte..].starts_with('\n');
            prop_assume!(!within_an_end);
            let lines = Lines::new(&text);
            for encoding in ENCODINGS {
                let position = lines.position(&text, byte, encoding);
                prop_assert_eq!(lines.byte(&text, position, encoding), byte);
            }
        }

        #[test]
        fn a_position_is_found_by_counting(text in TEXT, byte in 0_usize..120) {
            let byte = text.floor_char_boundary(byte);
            let plain = text[..byte].replace("\r\n", "\n").replace('\r', "\n");
            let within_an_end = text[..byte].ends_with('\r') && text[byte..].starts_with('\n');
            prop_assume!(!within_an_end);
            let last = plain.split('\n').next_back().unwrap_or_default();
            let position = Lines::new(&text).position(&text, byte, Encoding::Utf16);
            prop_assert_eq!(position.line as usize, plain.matches('\n').count());
            prop_assert_eq!(position.character as usize, last.encode_utf16().count());
            prop_assert_eq!(Lines::new(&text).position(&text, byte, Encoding::Utf8).character as usize, last.len());
        }

        #[test]
        fn any_position_is_a_place_in_the_text(text in TEXT, line in any::<u32>(), near in 0_u32..9, character in any::<u32>()) {
            let lines = Lines::new(&text);
            for (line, character) in [(line, character), (near, character), (near, near), (u32::MAX, u32::MAX)] {
                for encoding in ENCODINGS {
                    let byte = lines.byte(&text, lsp::Position { line, character }, encoding);
                    prop_assert!(text.is_char_boundary(byte));
                }
            }
        }
    }

    #[test]
    fn a_client_that_counts_bytes_is_answered_in_bytes_and_any_other_in_utf_16() {
        use PositionEncodingKind as Kind;
        assert_eq!(Encoding::choose(&[]), Encoding::Utf16);
        assert_eq!(Encoding::choose(&[Kind::UTF16, Kind::UTF8]), Encoding::Utf8);
        assert_eq!(Encoding::choose(&[Kind::UTF32, Kind::UTF16]), Encoding::Utf16);
        assert_eq!(Encoding::choose(&[Kind::UTF32]), Encoding::Utf32);
    }
}
