//! The sender of packets.

use std::fmt;
use std::net::{IpAddr, SocketAddr};
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// A sender of packets: a computer, or one of its ports.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Sender {
    address: IpAddr,
    /// `None` for every port.
    port: Option<u16>,
}

/// A text that names no sender.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is no sender; write its IP address such as 192.168.1.20, or with its port such as 192.168.1.20:9752")]
pub struct SenderError(String);

impl Sender {
    /// True if a packet from this address is of the sender.
    #[must_use]
    pub fn is(&self, address: SocketAddr) -> bool {
        // A socket for both versions of the protocol gives the addresses of the older one another form.
        self.address == address.ip().to_canonical() && self.port.is_none_or(|port| port == address.port())
    }
}

impl From<SocketAddr> for Sender {
    /// The sender that uses this port.
    fn from(socket: SocketAddr) -> Self {
        Self { address: socket.ip().to_canonical(), port: Some(socket.port()) }
    }
}

impl FromStr for Sender {
    type Err = SenderError;

    fn from_str(text: &str) -> Result<Self, SenderError> {
        let with_port = text.parse().map(|socket: SocketAddr| (socket.ip(), Some(socket.port())));
        let parsed = with_port.or_else(|_| text.parse().map(|address| (address, None)));
        let (address, port) = parsed.map_err(|_| SenderError(text.to_owned()))?;
        if address.is_unspecified() || port == Some(0) {
            return Err(SenderError(text.to_owned()));
        }
        Ok(Self { address: address.to_canonical(), port })
    }
}

impl fmt::Display for Sender {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.port {
            Some(port) => SocketAddr::new(self.address, port).fmt(formatter),
            None => self.address.fmt(formatter),
        }
    }
}

impl TryFrom<String> for Sender {
    type Error = SenderError;

    fn try_from(text: String) -> Result<Self, SenderError> {
        text.parse()
    }
}

impl From<Sender> for String {
    fn from(sender: Sender) -> Self {
        sender.to_string()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use super::*;

    #[test]
    fn a_sender_is_an_address_with_or_without_a_port() {
        let is = |sender: &str, address: &str| sender.parse::<Sender>().unwrap().is(address.parse().unwrap());
        assert!(is("192.168.1.20", "192.168.1.20:7") && is("192.168.1.20:7", "192.168.1.20:7"));
        assert!(!is("192.168.1.20", "192.168.1.21:7") && !is("192.168.1.20:7", "192.168.1.20:8"));
        assert!(is("192.168.1.20", "[::ffff:192.168.1.20]:7") && is("::ffff:192.168.1.20", "192.168.1.20:7"));
        assert!(is("fd00::1", "[fd00::1]:7") && is("[fd00::1]:7", "[fd00::1]:7") && !is("[fd00::1]:7", "[fd00::1]:8"));
        for text in ["192.168.1.20", "192.168.1.20:7", "fd00::1", "[fd00::1]:7"] {
            assert_eq!(String::from(text.parse::<Sender>().unwrap()), text);
        }
        for text in ["", "robot", "0.0.0.0", "::", "192.168.1.20:0", "192.168.1", "192.168.1.20:"] {
            assert!(text.parse::<Sender>().unwrap_err().to_string().contains("write its IP address"), "{text}");
        }
    }
}
