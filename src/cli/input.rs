//! Reading scenarios and policies.

use std::fs::File;
use std::io::{Error, ErrorKind, Read};
use std::path::Path;

use sha2::{Digest, Sha256};

use crate::diagnostic::Source;
use crate::policy::chart::Chart;
use crate::policy::{self, Compiled, compile_with_warnings};
use crate::scene::Scene;

use super::exit::Failure;

/// The most bytes that are read of a file: as many as the largest scenario may have. Policies are smaller still.
const SIZE_LIMIT: u64 = 1 << 20;

/// Something read from a file, with a hash of the file's text.
pub(super) struct Loaded<T> {
    pub(super) value: T,
    pub(super) hash: Sha256,
}

pub(super) fn read(path: &Path) -> Result<Source, Failure> {
    let text = File::open(path).and_then(read_text).map_err(Failure::read(path))?;
    Ok(Source::new(path.display().to_string(), text))
}

/// Reads no more than tells that a file is too large: a device never ends.
fn read_text(from: impl Read) -> Result<String, Error> {
    let mut bytes = Vec::new();
    let count = from.take(SIZE_LIMIT + 1).read_to_end(&mut bytes)?;
    let unusable = |cause| Error::new(ErrorKind::InvalidData, cause);
    if count as u64 > SIZE_LIMIT {
        return Err(unusable(
            "it is larger than 1 MiB; a scenario or policy is a page of text: is this the right file?",
        ));
    }
    String::from_utf8(bytes).map_err(|_| unusable("it is not UTF-8 text; save it as UTF-8, or is it the wrong file?"))
}

/// Reads standard input.
pub(super) fn read_standard() -> Result<Source, Failure> {
    let name = "standard input";
    let text = read_text(std::io::stdin().lock()).map_err(Failure::read(Path::new(name)))?;
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

pub(super) fn chart(path: &Path) -> Result<Chart, Failure> {
    let source = read(path)?;
    policy::chart(&source).map_err(|faults| Failure::Faults { source_text: Box::new(source), faults })
}

/// The first sixteen hexadecimal digits of a hash: enough to tell files apart.
pub(super) fn short(hash: &[u8]) -> String {
    hash.iter().take(8).fold(String::new(), |digits, byte| digits + &format!("{byte:02x}"))
}
