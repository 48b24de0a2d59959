//! The public keys that a robot or a developer trusts.

use std::io;
use std::path::{Path, PathBuf};
use vibrissa_text::system::in_words;

use minisign_verify::PublicKey;

use super::file;
use super::signed_machine::SignedMachine;
use super::verified_machine::{Refusal, VerifiedMachine};

/// The usual directory of the public keys that a robot trusts.
pub const DEFAULT_KEYS: &str = "/etc/vibrissa/keys";
/// Ending of the files of public keys.
const ENDING: &str = "pub";
/// Maximum size of the file of a public key in bytes.
const KEY_LIMIT: usize = 4 << 10;

/// Public keys of minisign, at least one.
#[derive(Debug, Clone)]
pub struct Keys(Vec<(String, PublicKey)>);

/// An error of reading public keys.
#[derive(Debug, thiserror::Error)]
pub enum KeysError {
    /// A folder has no key.
    #[error("there is no public key in {}; copy the file minisign.pub of the developer into it", path.display())]
    None {
        /// The folder.
        path: PathBuf,
    },
    /// The folder cannot be read.
    #[error("cannot read the folder of public keys {}: {words}; create it, or name another", path.display(), words = in_words(cause))]
    Folder {
        /// The folder.
        path: PathBuf,
        /// The cause.
        cause: io::Error,
    },
    /// A file cannot be read.
    #[error("cannot read the public key {}: {words}; copy it again, or name another", path.display(), words = in_words(cause))]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The cause.
        cause: io::Error,
    },
    /// A file has no public key of minisign.
    #[error("{} is not a public key of minisign; copy the file minisign.pub again, or name another", path.display())]
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
        let content = file::read(path, KEY_LIMIT);
        let content = content.map_err(|cause| KeysError::Unreadable { path: path.to_owned(), cause })?;
        let key = std::str::from_utf8(&content).ok().and_then(|text| PublicKey::decode(text).ok());
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
        Ok(Self(vec![(name, key.ok_or_else(|| KeysError::NotAKey { path: path.to_owned() })?)]))
    }

    /// Reads all files `*.pub` of a folder, except hidden ones.
    ///
    /// # Errors
    /// The folder cannot be read or has no such file, or one of them is not a public key.
    pub fn from_folder(path: &Path) -> Result<Self, KeysError> {
        let unreadable = |cause| KeysError::Folder { path: path.to_owned(), cause };
        let entries = std::fs::read_dir(path).map_err(unreadable)?;
        let files: io::Result<Vec<PathBuf>> = entries.map(|entry| Ok(entry?.path())).collect();
        let mut files = files.map_err(unreadable)?;
        // The extension of a hidden file such as `.pub` is none, but `._developer.pub` has one.
        let is_hidden = |file: &Path| file.file_name().is_some_and(|name| name.as_encoded_bytes().starts_with(b"."));
        files.retain(|file| file.extension().is_some_and(|ending| ending == ENDING) && !is_hidden(file));
        files.sort_unstable();
        let mut keys = Vec::new();
        for file in files {
            keys.append(&mut Self::from_file(&file)?.0);
        }
        if keys.is_empty() { Err(KeysError::None { path: path.to_owned() }) } else { Ok(Self(keys)) }
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

    /// The keys with the names of their files.
    pub(super) fn iter(&self) -> impl Iterator<Item = (&str, &PublicKey)> {
        self.0.iter().map(|(name, key)| (&name[..], key))
    }
}
