//! Errors of the live page.

use std::net::SocketAddr;
use vibrissa_text::system::in_words;

use thiserror::Error;
use vibrissa_runtime::control::BindError;

/// A live page that cannot be served.
#[derive(Debug, Error)]
pub enum LiveError {
    /// The address cannot be used.
    #[error("cannot listen on {address}: {words}; give another address, such as --live 127.0.0.1:8080", words = in_words(cause))]
    Listen {
        /// The address.
        address: SocketAddr,
        /// The cause.
        cause: std::io::Error,
    },
    /// The text is no address.
    #[error("`{0}` is no address; write an IP address and a port, such as 127.0.0.1:8080 or 0.0.0.0:8080")]
    Address(String),
    /// The token cannot stand in a URL.
    #[error(
        "a token of the live page has at least 16 letters, digits, `-` and `_`, and nothing else; without one, the program makes a random one"
    )]
    Token,
    /// The system has no random numbers.
    #[error("the system gives no random numbers for a token ({0}); give one with --live-token-file")]
    Random(String),
    /// The system starts no thread.
    #[error("the system starts no thread for the live page ({words}); end other programs, or run without --live", words = in_words(.0))]
    Thread(std::io::Error),
    /// The rig does not have what the policy needs.
    #[error(transparent)]
    Bind(#[from] BindError),
    /// The guards of the policy cannot be explained.
    #[error("the guards of the policy cannot be explained; this is a fault of the program, please report it")]
    Explain,
}
