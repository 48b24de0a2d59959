//! Errors of the operating system in messages.

use std::io;

/// An error of the operating system in words, without its number, which tells a reader nothing. What follows the number is a place that
/// only the program knows, such as a temporary file.
#[must_use]
pub fn in_words(error: &io::Error) -> String {
    let text = error.to_string();
    match text.find(" (os error ") {
        Some(end) => text.get(..end).unwrap_or_default().to_owned(),
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
        let nested = io::Error::other("Permission denied (os error 13) at path \"/x/.tmp\"");
        assert_eq!(in_words(&nested), "Permission denied");
        assert_eq!(in_words(&io::Error::other("it is larger (much)")), "it is larger (much)");
    }
}
