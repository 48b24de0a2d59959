//! Reading scenarios and policies.

use std::io::{Error, ErrorKind, Read};
use std::path::Path;

use sha2::{Digest, Sha256};

use crate::diagnostic::Source;
use crate::machine::{ARTIFACT_LIMIT, Artifact};
use crate::policy::compile_to_artifact;
use crate::scene::Scene;

use super::exit::Failure;

/// Something read from a file, with a hash of the file's text.
pub(super) struct Loaded<T> {
    pub(super) value: T,
    pub(super) hash: Sha256,
}

pub(super) fn read(path: &Path) -> Result<Source, Failure> {
    let text = std::fs::read_to_string(path).map_err(Failure::read(path))?;
    Ok(Source::new(path.display().to_string(), text))
}

pub(super) fn scenario(path: &Path) -> Result<Loaded<Scene>, Failure> {
    let source = read(path)?;
    let hash = Sha256::new().chain_update(&source.text);
    match Scene::from_yaml(&source) {
        Ok(value) => Ok(Loaded { value, hash }),
        Err(faults) => Err(Failure::Faults { source_text: Box::new(source), faults }),
    }
}

/// What a file that is given for a policy holds.
pub(super) enum PolicyFile {
    Text(Source),
    Machine(Box<Artifact>),
}

/// Reads a policy's text or a compiled machine.
pub(super) fn policy_file(path: &Path) -> Result<Loaded<PolicyFile>, Failure> {
    // A byte more than a machine may have, and far more than a text may, tells that it is too large.
    let mut bytes = Vec::new();
    let file = std::fs::File::open(path).map_err(Failure::read(path))?;
    file.take(ARTIFACT_LIMIT as u64 + 1).read_to_end(&mut bytes).map_err(Failure::read(path))?;
    let hash = Sha256::new().chain_update(&bytes);
    let value = if Artifact::is_in(&bytes) {
        PolicyFile::Machine(Box::new(Artifact::from_bytes(&bytes).map_err(Failure::artifact(path))?))
    } else {
        let text = String::from_utf8(bytes).map_err(|error| Error::new(ErrorKind::InvalidData, error));
        PolicyFile::Text(Source::new(path.display().to_string(), text.map_err(Failure::read(path))?))
    };
    Ok(Loaded { value, hash })
}

/// Reads a policy's text and compiles it, or a compiled machine.
pub(super) fn policy(path: &Path) -> Result<Loaded<Artifact>, Failure> {
    let Loaded { value, hash } = policy_file(path)?;
    let value = match value {
        PolicyFile::Machine(artifact) => *artifact,
        PolicyFile::Text(source) => match compile_to_artifact(&source) {
            Ok(artifact) => artifact,
            Err(faults) => return Err(Failure::Faults { source_text: Box::new(source), faults }),
        },
    };
    Ok(Loaded { value, hash })
}

/// The first sixteen hexadecimal digits of a hash: enough to tell files apart.
pub(super) fn short(hash: &[u8]) -> String {
    hex(&hash[..hash.len().min(8)])
}

/// Bytes in hexadecimal digits.
pub(super) fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |digits, byte| digits + &format!("{byte:02x}"))
}
