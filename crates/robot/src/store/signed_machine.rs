//! A machine and its signature, not yet verified.

use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use vibrissa_text::system::in_words;

use vibrissa_runtime::machine::ARTIFACT_LIMIT;

use super::file;
use super::frame::SIGNATURE_LIMIT;
use super::machine_hash::MachineHash;

/// Ending of the files that minisign writes. It follows the whole name of the signed file.
const ENDING: &str = ".minisig";

/// The bytes of an artifact and the text of its signature. Nothing is verified yet. [`Keys::verify`](super::Keys::verify)
/// does that.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SignedMachine {
    artifact: Vec<u8>,
    signature: String,
}

/// An error of reading a machine and its signature from files.
#[derive(Debug, thiserror::Error)]
pub enum SignedMachineError {
    /// The file of the machine cannot be read.
    #[error("cannot read {}: {words}; give the file that `vibrissa compile` has written", path.display(), words = in_words(cause))]
    Machine {
        /// The file.
        path: PathBuf,
        /// The cause.
        cause: io::Error,
    },
    /// There is no signature.
    #[error("{} is not signed: there is no {}; run `minisign -Sm {}`", path.display(), signature.display(), path.display())]
    Unsigned {
        /// The file of the machine.
        path: PathBuf,
        /// The file that should have the signature.
        signature: PathBuf,
    },
    /// The file of the signature cannot be read.
    #[error("cannot read the signature {}: {words}; sign the machine again with `minisign -Sm {}`", signature.display(), path.display(), words = in_words(cause))]
    Signature {
        /// The file of the machine.
        path: PathBuf,
        /// The file of the signature.
        signature: PathBuf,
        /// The cause.
        cause: io::Error,
    },
}

impl SignedMachine {
    /// Puts together the bytes of an artifact and its signature in the text format of minisign.
    #[must_use]
    pub fn new(artifact: Vec<u8>, signature: String) -> Self {
        Self { artifact, signature }
    }

    /// Reads the machine at `path`, and its signature from the file that `minisign -Sm` writes beside it.
    ///
    /// # Errors
    /// One of the files is missing, not regular or too large.
    pub fn from_file(path: &Path) -> Result<Self, SignedMachineError> {
        let mut signature = path.as_os_str().to_owned();
        signature.push(ENDING);
        Self::from_files(path, Path::new(&signature))
    }

    /// Reads the machine at `path`, and its signature from the file `signature`.
    ///
    /// # Errors
    /// One of the files is missing, not regular or too large.
    pub fn from_files(path: &Path, signature: &Path) -> Result<Self, SignedMachineError> {
        let artifact = file::read(path, ARTIFACT_LIMIT)
            .map_err(|cause| SignedMachineError::Machine { path: path.to_owned(), cause })?;
        let text = file::read(signature, SIGNATURE_LIMIT).and_then(|bytes| {
            String::from_utf8(bytes).map_err(|_| io::Error::new(ErrorKind::InvalidData, "it is not text"))
        });
        match text {
            Ok(text) => Ok(Self::new(artifact, text)),
            Err(cause) if cause.kind() == ErrorKind::NotFound => {
                Err(SignedMachineError::Unsigned { path: path.to_owned(), signature: signature.to_owned() })
            }
            Err(cause) => {
                Err(SignedMachineError::Signature { path: path.to_owned(), signature: signature.to_owned(), cause })
            }
        }
    }

    /// The bytes of the artifact.
    #[must_use]
    pub fn artifact(&self) -> &[u8] {
        &self.artifact
    }

    /// The text of the signature.
    #[must_use]
    pub fn signature(&self) -> &str {
        &self.signature
    }

    /// The trusted comment, not yet verified. `None` if the signature has none.
    pub(super) fn unverified_comment(&self) -> Option<&str> {
        self.signature.lines().find_map(|line| line.strip_prefix("trusted comment: "))
    }

    /// The hash of the artifact.
    #[must_use]
    pub fn hash(&self) -> MachineHash {
        MachineHash::of(&self.artifact)
    }
}
