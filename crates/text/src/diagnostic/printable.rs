//! Text that is safe to print to a terminal.

use std::borrow::Cow;

/// The text, with every character that a terminal would interpret replaced by its code: `\u{1b}`.
///
/// These are control characters other than line ends and tabs, characters that change the text direction, and line
/// separators. File names and quoted texts may come from other people. They could otherwise recolour, hide or reorder
/// the output of a terminal.
#[must_use]
pub fn printable(text: &str) -> Cow<'_, str> {
    replaced(text, |letter| letter.escape_unicode().to_string())
}

/// Same as [`printable`], for JSON. It uses JSON's own escapes, so a reader of the JSON gets the original text.
#[must_use]
pub fn printable_json(json: &str) -> Cow<'_, str> {
    // All of these are below 2^16.
    replaced(json, |letter| format!("\\u{:04x}", u32::from(letter)))
}

/// Same as [`printable`], without a change of byte positions. Each replaced character becomes one with as many bytes.
#[cfg(feature = "terminal")]
pub(super) fn same_length(text: &str) -> Cow<'_, str> {
    replaced(text, |letter| {
        let stand_in = match letter.len_utf8() {
            1 => '?',
            2 => '\u{bf}',
            _ => '\u{fffd}',
        };
        stand_in.to_string()
    })
}

fn replaced(text: &str, stand_in: impl Fn(char) -> String) -> Cow<'_, str> {
    if !text.contains(is_interpreted) {
        return Cow::Borrowed(text);
    }
    let mut made = String::with_capacity(text.len());
    let mut letters = text.chars().peekable();
    while let Some(letter) = letters.next() {
        // A line may end with two letters.
        if is_interpreted(letter) && !(letter == '\r' && letters.peek() == Some(&'\n')) {
            made += &stand_in(letter);
        } else {
            made.push(letter);
        }
    }
    Cow::Owned(made)
}

/// True if a terminal interprets a character instead of showing it.
fn is_interpreted(letter: char) -> bool {
    let is_direction =
        matches!(letter, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let parts_lines = matches!(letter, '\u{2028}' | '\u{2029}');
    is_direction || parts_lines || (letter.is_control() && !['\n', '\t'].contains(&letter))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_colour_is_shown_as_its_code() {
        assert_eq!(printable("a\u{1b}[31m.fsm"), "a\\u{1b}[31m.fsm");
    }

    /// Texts in which many characters are control characters.
    fn texts() -> impl Strategy<Value = String> {
        let letter = prop_oneof![
            any::<char>(),
            (0..0xa0_u32).prop_map(|code| char::from_u32(code).unwrap_or('a')),
            (0x2000..0x2070_u32).prop_map(|code| char::from_u32(code).unwrap_or('a')),
        ];
        prop::collection::vec(letter, 0..30).prop_map(String::from_iter)
    }

    proptest! {
        #[test]
        fn nothing_that_a_terminal_obeys_is_left_and_all_else_stays(text in texts()) {
            for made in [printable(&text), printable_json(&text), same_length(&text)] {
                prop_assert!(!made.replace("\r\n", "\n").contains(is_interpreted));
            }
            prop_assert_eq!(same_length(&text).len(), text.len());
            let plain: String = text.chars().filter(|&letter| !is_interpreted(letter)).collect();
            prop_assert_eq!(printable(&plain), plain.as_str());
        }

        #[test]
        fn json_is_read_as_what_it_was(text in texts()) {
            let json = serde_json::to_string(&text)?;
            prop_assert_eq!(serde_json::from_str::<String>(&printable_json(&json))?, text);
        }
    }

    #[test]
    fn escapes_of_terminals_and_changes_of_direction_are_obeyed_and_letters_are_not() {
        for letter in "\u{1b}\u{7}\u{7f}\u{9b}\r\u{202a}\u{202e}\u{2066}\u{2069}".chars() {
            assert!(is_interpreted(letter), "{letter:?}");
        }
        assert_eq!(printable("\u{fc}ber\t5 \u{b5}m \u{2026}\n"), "\u{fc}ber\t5 \u{b5}m \u{2026}\n");
    }
}
