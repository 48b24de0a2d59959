//! Texts from bytes.

use super::{Position, Source};

/// The error for bytes that are not UTF-8.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("it is not UTF-8 text: the byte 0x{byte:02X} in line {}, column {} is invalid", position.line, position.column)]
pub struct NotUtf8 {
    /// Position of the first invalid byte.
    pub position: Position,
    /// That byte.
    pub byte: u8,
}

impl NotUtf8 {
    /// Advice for the user.
    pub const ADVICE: &str = "save it as UTF-8, or check that it is the right file";
}

/// Decodes bytes as UTF-8.
///
/// # Errors
/// [`NotUtf8`] with the position of the first invalid byte.
pub fn utf8(bytes: &[u8]) -> Result<&str, NotUtf8> {
    std::str::from_utf8(bytes).map_err(|fault| {
        let good = fault.valid_up_to();
        let before = String::from_utf8_lossy(bytes.get(..good).unwrap_or_default());
        let position = Source::new("", before).line_column(good);
        NotUtf8 { position, byte: bytes.get(good).copied().unwrap_or_default() }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_place_of_a_byte_that_is_at_fault_is_told_in_lines_and_letters() {
        let fault = utf8(b"one\n\xc3\xbcber \xb5m\n").map_err(|fault| (fault.position, fault.byte));
        assert_eq!(fault, Err((Position { line: 2, column: 6 }, 0xb5)));
        // A truncated character.
        let fault = utf8(b"\xc3").map_err(|fault| (fault.position, fault.byte));
        assert_eq!(fault, Err((Position { line: 1, column: 1 }, 0xc3)));
        assert_eq!(utf8("\u{fc}".as_bytes()), Ok("\u{fc}"));
    }
}
