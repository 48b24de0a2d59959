//! What the comments beside something say of it.

use crate::diagnostic::Span;

/// What the comment lines directly above `place` say, or else the comment behind its first line. Empty if there is none.
pub(super) fn description(text: &str, place: Span) -> String {
    let line_start = text[..place.start].rfind('\n').map_or(0, |newline| newline + 1);
    let mut above: Vec<&str> = Vec::new();
    if text[line_start..place.start].trim().is_empty() {
        let lines = text[..line_start].lines().rev().map(str::trim);
        above.extend(lines.map_while(|line| line.strip_prefix('#')));
        above.reverse();
    }
    if above.is_empty() {
        let rest = &text[place.start..];
        let line = &rest[..rest.find('\n').unwrap_or(rest.len())];
        above.extend(comment(line));
    }
    let lines: Vec<&str> = above.into_iter().map(|line| line.strip_prefix(' ').unwrap_or(line).trim_end()).collect();
    lines.join("\n").trim().to_owned()
}

/// The comment at the end of a line, without its `#`. There is none within a text.
fn comment(line: &str) -> Option<&str> {
    let mut in_text = false;
    let start = line.char_indices().find(|&(_, letter)| {
        in_text ^= letter == '"';
        letter == '#' && !in_text
    });
    start.map(|(at, _)| &line[at + 1..])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str, name: &str) -> String {
        let start = text.find(name).unwrap_or(0);
        description(text, Span::new(start, start + name.len()))
    }

    #[test]
    fn the_lines_above_describe_and_else_the_comment_behind() {
        let text = "# of the file\n\n# one\n#   two\nparam a = 1\nparam b = 2  # behind \"it\nparam c = 3\n";
        assert_eq!(of(text, "param a"), "one\n  two");
        assert_eq!(of(text, "param b"), "behind \"it");
        assert_eq!(of(text, "param c"), "");
        assert_eq!(of("machine m  # x\nlet a = 1", "let a"), "");
        assert_eq!(of("when true -> Failure(\"#1\")  # why", "when"), "why");
    }
}
