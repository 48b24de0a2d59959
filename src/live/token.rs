//! The token that a page has to know if it is not served to this machine alone.

use data_encoding::HEXLOWER;

use super::error::LiveError;

/// Number of random bytes of a generated token.
const LENGTH: usize = 16;

/// The smallest number of characters of a token that a user gives.
const SHORTEST: usize = 16;

/// A token.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Token(String);

impl Token {
    /// A token that cannot be guessed.
    ///
    /// # Errors
    /// [`LiveError::Random`] if the system has no random numbers.
    pub(super) fn random() -> Result<Self, LiveError> {
        let mut bytes = [0; LENGTH];
        getrandom::fill(&mut bytes).map_err(|cause| LiveError::Random(cause.to_string()))?;
        Ok(Self(HEXLOWER.encode(&bytes)))
    }

    /// The token that a user gives. It stands in a URL.
    ///
    /// # Errors
    /// [`LiveError::Token`] if it is shorter than [`SHORTEST`] or has other characters than letters, digits, `-` and `_`.
    pub(super) fn given(text: &str) -> Result<Self, LiveError> {
        let is_plain = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'-' || byte == b'_';
        if text.len() < SHORTEST || !text.bytes().all(is_plain) {
            return Err(LiveError::Token);
        }
        Ok(Self(text.to_owned()))
    }

    /// The text in a URL.
    pub(super) fn text(&self) -> &str {
        &self.0
    }

    /// True for the same token. The time does not depend on the place of the first difference.
    pub(super) fn is(&self, given: &str) -> bool {
        let (own, given) = (self.0.as_bytes(), given.as_bytes());
        let difference = own.iter().zip(given).fold(0, |difference, (a, b)| difference | (a ^ b));
        own.len() == given.len() && std::hint::black_box(difference) == 0
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;

    #[test]
    fn a_token_is_equal_to_itself_alone() {
        let token = Token::given("abc-0123456789-1").unwrap();
        assert!(token.is("abc-0123456789-1"));
        let others = ["", "abc-", "abc-0123456789-12", "abc-0123456789-2", "xbc-0123456789-1"];
        assert!(others.iter().all(|other| !token.is(other)));
        let refused = ["", "a", "abc-0123456789-", "a b-0123456789-1", "a&b-0123456789-1", "äbc-0123456789-1"];
        assert!(refused.iter().all(|text| Token::given(text).is_err()));
        assert_ne!(Token::random().unwrap(), Token::random().unwrap());
    }
}
