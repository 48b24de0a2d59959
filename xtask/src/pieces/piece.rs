//! The parts of a policy that can be removed.

use std::ops::Range;

/// The words that begin a part that a policy may lack. Commands are no such parts: without them a state does nothing.
const WORDS: [&str; 8] = ["when", "after", "on", "always", "set", "tell", "if", "do"];

/// A transition, rule or statement of a policy.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Piece {
    /// Its lines, from 0.
    pub(super) lines: Range<usize>,
    /// Its text on one line.
    pub(super) text: String,
}

impl Piece {
    /// The parts of a text in the formatter's layout: a part begins a line, and its further lines are indented or close its
    /// braces.
    pub(super) fn all(text: &str) -> Vec<Self> {
        let lines: Vec<&str> = text.lines().collect();
        let begin = |line: &str| WORDS.contains(&line.split_whitespace().next().unwrap_or_default());
        let starts = (0..lines.len()).filter(|&start| begin(lines[start]));
        let piece = |start: usize| {
            let further = lines[start + 1..].iter().take_while(|line| belongs(line, indentation(lines[start])));
            let end = start + 1 + further.count();
            let words: Vec<&str> = lines[start..end].iter().flat_map(|line| code(line).split_whitespace()).collect();
            Self { lines: start..end, text: words.join(" ") }
        };
        starts.map(piece).collect()
    }

    /// The text without the part. The numbers of lines stay.
    pub(super) fn removed_from(&self, text: &str) -> String {
        let kept = |(index, line)| if self.lines.contains(&index) { "" } else { line };
        text.lines().enumerate().map(kept).flat_map(|line| [line, "\n"]).collect()
    }
}

/// True if a line belongs to the part with this indentation that begins above it.
fn belongs(line: &str, indentation_above: usize) -> bool {
    let own = indentation(line);
    !line.trim().is_empty()
        && (own > indentation_above || own == indentation_above && line.trim_start().starts_with('}'))
}

fn indentation(line: &str) -> usize {
    line.len() - line.trim_start().len()
}

/// A line without its comment. No text of a policy that is measured contains the mark of a comment.
fn code(line: &str) -> &str {
    line.split('#').next().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "\
state A {
  var n = 0
  if a {  # why
    set n = 1
  } else {
    set n = 2
  }
  steer body along b at
      c
  when a or b
      for 1 s -> B

  after 2 s -> B
}
";

    #[test]
    fn a_part_has_its_further_lines_and_braces() {
        let found: Vec<(Range<usize>, String)> =
            Piece::all(TEXT).into_iter().map(|piece| (piece.lines, piece.text)).collect();
        let expected = [
            (2..7, "if a { set n = 1 } else { set n = 2 }"),
            (3..4, "set n = 1"),
            (5..6, "set n = 2"),
            (9..11, "when a or b for 1 s -> B"),
            (12..13, "after 2 s -> B"),
        ];
        assert_eq!(found, expected.map(|(lines, text)| (lines, text.to_owned())));
    }

    #[test]
    fn the_other_lines_stay_where_they_are() {
        for piece in Piece::all(TEXT) {
            let without = piece.removed_from(TEXT);
            assert_eq!(without.lines().count(), TEXT.lines().count());
            for (index, (line, before)) in without.lines().zip(TEXT.lines()).enumerate() {
                assert_eq!(line, if piece.lines.contains(&index) { "" } else { before });
            }
        }
    }
}
