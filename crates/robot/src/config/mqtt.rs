//! The section `mqtt`: the broker, and what a connection to it needs.

use std::path::PathBuf;

use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};

/// An MQTT broker.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "Section")]
pub struct MqttConfig {
    /// Name or address of the broker.
    pub host: String,
    /// Port of the broker.
    pub port: u16,
    /// Messages that wait while the broker is away, at least one. The oldest are dropped.
    pub buffer: usize,
    /// Name of the user, if the broker asks for one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub user: Option<String>,
    /// File with the password of the user. The password is not a part of the configuration, because recordings contain that.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub password_file: Option<PathBuf>,
    /// Encryption of the connection. Without it, everybody in the network can read and change what is sent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tls: Option<TlsConfig>,
}

/// The encryption of a connection, TLS 1.3.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TlsConfig {
    /// File with the certificates (PEM) of the authorities that may sign that of the broker. `None` for those of the system.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ca: Option<PathBuf>,
}

impl MqttConfig {
    /// Ports of a broker: without encryption, and with it.
    pub const PORTS: [u16; 2] = [1883, 8883];

    /// A broker that asks for no user, without encryption.
    #[must_use]
    pub fn open(host: String, port: u16, buffer: usize) -> Self {
        Self { host, port, buffer, user: None, password_file: None, tls: None }
    }
}

/// The section as it is written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Section {
    host: String,
    port: Option<u16>,
    #[serde(default = "buffer")]
    buffer: usize,
    user: Option<String>,
    password: Option<IgnoredAny>,
    password_file: Option<PathBuf>,
    tls: Option<TlsConfig>,
}

fn buffer() -> usize {
    20_000
}

/// A section that contradicts itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
enum SectionError {
    #[error(
        "recordings contain the configuration, so it has no password; write the password into a file that only the program can \
         read, and its path as `password_file`"
    )]
    Password,
    #[error("`mqtt` has a `password_file` and no `user`; add the name of the user")]
    NoUser,
    #[error("the `user` of `mqtt` is empty; write its name, or leave the key out")]
    EmptyUser,
}

impl TryFrom<Section> for MqttConfig {
    type Error = SectionError;

    fn try_from(section: Section) -> Result<Self, SectionError> {
        let Section { host, port, buffer, user, password, password_file, tls } = section;
        if password.is_some() {
            return Err(SectionError::Password);
        }
        match &user {
            None if password_file.is_some() => return Err(SectionError::NoUser),
            Some(user) if user.trim().is_empty() => return Err(SectionError::EmptyUser),
            _ => {}
        }
        let port = port.unwrap_or(Self::PORTS[usize::from(tls.is_some())]);
        Ok(Self { host, port, buffer, user, password_file, tls })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use super::*;

    fn read(text: &str) -> Result<MqttConfig, String> {
        serde_yaml::from_str(text).map_err(|error| error.to_string())
    }

    #[test]
    fn user_password_and_encryption_are_options_and_change_the_default_port() {
        assert_eq!(read("{host: a}").unwrap(), MqttConfig::open("a".to_owned(), 1883, 20_000));
        let secure = read("{host: a, user: robot, password_file: /etc/p, tls: {ca: /etc/ca.pem}}").unwrap();
        assert_eq!((secure.port, secure.user.as_deref()), (8883, Some("robot")));
        assert_eq!(secure.tls, Some(TlsConfig { ca: Some("/etc/ca.pem".into()) }));
        assert_eq!(read("{host: a, port: 1884, tls: {}}").unwrap().port, 1884);
        for (text, says) in [
            ("{host: a, user: robot, password: secret}", "write the password into a file"),
            ("{host: a, password_file: /etc/p}", "add the name of the user"),
            ("{host: a, user: ''}", "leave the key out"),
            ("{host: a, tls: {cert: b}}", "ca"),
        ] {
            let message = read(text).unwrap_err();
            assert!(message.contains(says) && !message.contains("secret"), "{text}: {message}");
        }
    }
}
