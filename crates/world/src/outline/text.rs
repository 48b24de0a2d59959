//! Lines of a text.

/// The lines of a text with their numbers, counted from 1, without a byte order mark. A line ends with LF, CR LF, or, if the text has
/// no LF, with CR.
pub(super) fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let end = if text.contains('\n') { '\n' } else { '\r' };
    (1..).zip(text.split_terminator(end).map(|line| line.trim_end_matches('\r')))
}

/// A part of a text for a message: without control characters, and of a readable length.
pub(super) fn shown(text: &str) -> String {
    text.chars().filter(|letter| !letter.is_control()).take(40).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_ends_as_any_system_ends_it() {
        let expected = vec![(1, "a"), (2, ""), (3, "b c")];
        for text in ["a\n\nb c", "a\n\nb c\n", "\u{feff}a\r\n\r\nb c\r\n", "a\r\rb c\r", "a\r\n\r\r\nb c"] {
            assert_eq!(lines(text).collect::<Vec<_>>(), expected, "{text:?}");
        }
        assert_eq!(lines("").count(), 0);
    }
}
