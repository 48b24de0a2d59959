//! The public keys that a robot or a developer trusts.

use std::io;
use std::path::{Path, PathBuf};

use minisign_verify::PublicKey;

use super::file;
use super::signed_machine::SignedMachine;
use super::verified_machine::{Refusal, VerifiedMachine};

/// Maximum size of the file of a public key in bytes.
pub(super) const KEY_LIMIT: usize = 4 << 10;

/// Public keys of minisign, at least one.
#[derive(Debug, Clone)]
pub struct Keys(Vec<(String, PublicKey)>);

/// An error of reading public keys.
#[derive(Debug, thiserror::Error)]
pub enum KeysError {
    /// The store has no key.
    #[error("there is no public key in {}; copy the file minisign.pub of the developer into it", path.display())]
    None {
        /// The folder.
        path: PathBuf,
    },
    /// A file cannot be read.
    #[error("cannot read the public key {}: {cause}; copy it again, or remove it", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The cause.
        cause: io::Error,
    },
    /// A file has no public key of minisign.
    #[error("{} is not a public key of minisign; copy the file minisign.pub again, or remove it", path.display())]
    NotAKey {
        /// The file.
        path: PathBuf,
    },
}

impl Keys {
    /// Reads one public key from a file. `minisign -G` writes it.
    ///
    /// # Errors
    /// The file cannot be read or is not a public key.
    pub fn from_file(path: &Path) -> Result<Self, KeysError> {
        let text = file::read(path, KEY_LIMIT);
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
        Self::decode([(name, path.to_owned(), text)], path)
    }

    /// Decodes files with their names, paths and contents, all from one folder.
    pub(super) fn decode(
        files: impl IntoIterator<Item = (String, PathBuf, io::Result<Vec<u8>>)>,
        folder: &Path,
    ) -> Result<Self, KeysError> {
        let mut keys = Vec::new();
        for (name, path, content) in files {
            let content = content.map_err(|cause| KeysError::Unreadable { path: path.clone(), cause })?;
            let key = std::str::from_utf8(&content).ok().and_then(|text| PublicKey::decode(text).ok());
            keys.push((name, key.ok_or(KeysError::NotAKey { path })?));
        }
        if keys.is_empty() { Err(KeysError::None { path: folder.to_owned() }) } else { Ok(Self(keys)) }
    }

    /// Verifies the signature of a machine with its trusted comment, and then the machine itself.
    ///
    /// # Errors
    /// [`Refusal`] with the first problem found.
    pub fn verify(&self, machine: SignedMachine) -> Result<VerifiedMachine, Refusal> {
        VerifiedMachine::new(machine, self)
    }

    /// Names of the files.
    pub(super) fn names(&self) -> Vec<String> {
        self.0.iter().map(|(name, _)| name.clone()).collect()
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &PublicKey> {
        self.0.iter().map(|(_, key)| key)
    }
}
