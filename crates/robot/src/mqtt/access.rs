//! What a connection needs of files: the password, and the certificates of authorities.

use std::fs::File;
use std::io::{self, Read};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use vibrissa_text::system::in_words;

use crate::config::MqttConfig;

/// Largest size of such a file in bytes.
const LIMIT: usize = 1 << 20;
/// Permission of everybody to read a file.
const OTHERS_READ: u32 = 0o004;

/// What a connection needs.
#[derive(Clone, Default)]
pub struct Access {
    /// Name and password of the user.
    pub(super) user: Option<(String, Vec<u8>)>,
    pub(super) authorities: Option<Authorities>,
}

/// The authorities that may sign the broker's certificate.
#[derive(Clone)]
pub(super) enum Authorities {
    /// Those of the system.
    System,
    /// These certificates (PEM).
    Certificates(Vec<u8>),
}

/// A file that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum AccessError {
    /// A file cannot be read.
    #[error("cannot read {}, the `{key}` of `mqtt`: {words}", path.display(), words = in_words(source))]
    Read {
        /// The key of the configuration.
        key: &'static str,
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// The file is too large.
    #[error("{} is larger than {LIMIT} bytes; the `{key}` of `mqtt` is probably another file", path.display())]
    TooLarge {
        /// The key of the configuration.
        key: &'static str,
        /// The file.
        path: PathBuf,
    },
    /// Everybody can read the password.
    #[error("every user of this computer can read the password in {0}; run `chmod o= {0}`", path.display())]
    OpenPassword {
        /// The file.
        path: PathBuf,
    },
    /// There is no password.
    #[error("the first line of {} is empty; write the password into it", path.display())]
    NoPassword {
        /// The file.
        path: PathBuf,
    },
    /// There is no certificate.
    #[error("{} has no certificate; write that of the authority in the format PEM, which begins with `-----BEGIN CERTIFICATE-----`", path.display())]
    NoCertificate {
        /// The file.
        path: PathBuf,
    },
}

impl Access {
    /// Reads the files of a broker.
    ///
    /// # Errors
    /// [`AccessError`] with the first file that cannot be used.
    pub fn read(config: &MqttConfig) -> Result<Self, AccessError> {
        let password = config.password_file.as_deref().map_or(Ok(Vec::new()), password)?;
        let user = config.user.clone().map(|user| (user, password));
        let authorities = match &config.tls {
            None => None,
            Some(tls) => Some(tls.ca.as_deref().map_or(Ok(Authorities::System), certificates)?),
        };
        Ok(Self { user, authorities })
    }
}

/// The first line of a file that not everybody can read.
fn password(path: &Path) -> Result<Vec<u8>, AccessError> {
    let (bytes, mode) = read("password_file", path)?;
    if mode & OTHERS_READ != 0 {
        return Err(AccessError::OpenPassword { path: path.to_owned() });
    }
    let line = bytes.split(|&byte| byte == b'\n').next().unwrap_or_default();
    let line = line.strip_suffix(b"\r").unwrap_or(line);
    if line.is_empty() {
        return Err(AccessError::NoPassword { path: path.to_owned() });
    }
    Ok(line.to_owned())
}

fn certificates(path: &Path) -> Result<Authorities, AccessError> {
    let (bytes, _) = read("ca", path)?;
    let begin = b"-----BEGIN CERTIFICATE-----";
    if !bytes.windows(begin.len()).any(|window| window == begin) {
        return Err(AccessError::NoCertificate { path: path.to_owned() });
    }
    Ok(Authorities::Certificates(bytes))
}

/// The content and the permissions of a file.
#[expect(clippy::disallowed_methods, reason = "the size is bounded below")]
fn read(key: &'static str, path: &Path) -> Result<(Vec<u8>, u32), AccessError> {
    let cannot = |source| AccessError::Read { key, path: path.to_owned(), source };
    let file = File::open(path).map_err(cannot)?;
    let mode = file.metadata().map_err(cannot)?.permissions().mode();
    let mut bytes = Vec::new();
    file.take(LIMIT as u64 + 1).read_to_end(&mut bytes).map_err(cannot)?;
    if bytes.len() > LIMIT {
        return Err(AccessError::TooLarge { key, path: path.to_owned() });
    }
    Ok((bytes, mode))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "a test may panic and write files")]

    use super::*;
    use crate::config::TlsConfig;

    fn config(password_file: Option<PathBuf>, tls: Option<TlsConfig>) -> MqttConfig {
        MqttConfig {
            user: Some("robot".to_owned()),
            password_file,
            tls,
            ..MqttConfig::open("broker".to_owned(), 8883, 1)
        }
    }

    #[test]
    fn a_password_is_the_first_line_of_a_file_that_not_everybody_can_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("password");
        let read = |text: &str, mode| {
            std::fs::write(&path, text).unwrap();
            std::fs::set_permissions(&path, PermissionsExt::from_mode(mode)).unwrap();
            Access::read(&config(Some(path.clone()), None))
                .map(|access| access.user.unwrap().1)
                .map_err(|error| error.to_string())
        };
        for (text, mode) in [("secret\n", 0o600), ("secret", 0o640), ("secret\r\nmore\n", 0o400)] {
            assert_eq!(read(text, mode).unwrap(), b"secret");
        }
        assert!(read("secret\n", 0o644).unwrap_err().contains("chmod o="));
        assert!(read("\nsecret", 0o600).unwrap_err().contains("is empty"));
        assert!(read(&"x".repeat(LIMIT + 1), 0o600).unwrap_err().contains("larger"));
        let missing = Access::read(&config(Some(folder.path().join("none")), None)).err().unwrap().to_string();
        assert!(missing.contains("password_file") && missing.contains("none"), "{missing}");
    }

    #[test]
    fn certificates_are_in_the_format_pem() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("ca");
        let read = || Access::read(&config(None, Some(TlsConfig { ca: Some(path.clone()) })));
        assert!(read().err().unwrap().to_string().contains("the `ca` of `mqtt`"));
        std::fs::write(&path, [0x30, 0x82, 3]).unwrap();
        assert!(read().err().unwrap().to_string().contains("PEM"));
        std::fs::write(&path, "-----BEGIN CERTIFICATE-----\n").unwrap();
        assert!(matches!(read().unwrap().authorities, Some(Authorities::Certificates(_))));
        let system = Access::read(&config(None, Some(TlsConfig::default()))).unwrap();
        assert!(matches!(system.authorities, Some(Authorities::System)));
    }
}
