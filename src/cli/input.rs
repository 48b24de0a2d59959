//! Reading scenarios and policies.

use std::path::Path;

use sha2::{Digest, Sha256};

use crate::diagnostic::Source;
use crate::machine::Program;
use crate::policy::compile;
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

/// Reads standard input.
pub(super) fn read_standard() -> Result<Source, Failure> {
    let name = "standard input";
    let text = std::io::read_to_string(std::io::stdin()).map_err(Failure::read(Path::new(name)))?;
    Ok(Source::new(name, text))
}

pub(super) fn scenario(path: &Path) -> Result<Loaded<Scene>, Failure> {
    let source = read(path)?;
    let hash = Sha256::new().chain_update(&source.text);
    match Scene::from_yaml(&source) {
        Ok(value) => Ok(Loaded { value, hash }),
        Err(faults) => Err(Failure::Faults { source_text: Box::new(source), faults }),
    }
}

pub(super) fn policy(path: &Path) -> Result<Loaded<Program>, Failure> {
    let source = read(path)?;
    let hash = Sha256::new().chain_update(&source.text);
    match compile(&source) {
        Ok(value) => Ok(Loaded { value, hash }),
        Err(faults) => Err(Failure::Faults { source_text: Box::new(source), faults }),
    }
}

/// The first sixteen hexadecimal digits of a hash: enough to tell files apart.
pub(super) fn short(hash: &[u8]) -> String {
    hash.iter().take(8).fold(String::new(), |digits, byte| digits + &format!("{byte:02x}"))
}
