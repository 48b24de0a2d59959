//! Errors of the operating system in messages.

use std::io;

/// An error of the operating system in words, without its number, which tells a reader nothing.
#[must_use]
pub fn in_words(error: &io::Error) -> String {
    let text = error.to_string();
    match error.raw_os_error().and_then(|code| text.strip_suffix(&format!(" (os error {code})"))) {
        Some(words) => words.to_owned(),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_of_the_system_is_told_without_its_number() {
        for code in 1..=133 {
            let words = in_words(&io::Error::from_raw_os_error(code));
            assert!(!words.is_empty() && !words.contains("os error"), "{words}");
        }
        assert_eq!(in_words(&io::Error::from(io::ErrorKind::NotFound)), io::ErrorKind::NotFound.to_string());
        assert_eq!(in_words(&io::Error::other("it is larger (much)")), "it is larger (much)");
    }
}
