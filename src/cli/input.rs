//! Reading scenarios and policies.

use std::path::Path;

use sha2::{Digest, Sha256};

use crate::diagnostic::Source;
use crate::policy::{Compiled, compile_with_warnings};
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

/// A policy and its text.
pub(super) struct Policy {
    pub(super) source: Source,
    pub(super) compiled: Compiled,
}

pub(super) fn policy(path: &Path) -> Result<Loaded<Policy>, Failure> {
    let source = read(path)?;
    let hash = Sha256::new().chain_update(&source.text);
    match compile_with_warnings(&source) {
        Ok(compiled) => Ok(Loaded { value: Policy { source, compiled }, hash }),
        Err(faults) => Err(Failure::Faults { source_text: Box::new(source), faults }),
    }
}

/// The first sixteen hexadecimal digits of a hash: enough to tell files apart.
pub(super) fn short(hash: &[u8]) -> String {
    hash.iter().take(8).fold(String::new(), |digits, byte| digits + &format!("{byte:02x}"))
}
