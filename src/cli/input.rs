//! Reading scenarios and policies.

use std::io::{Error, ErrorKind};
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use crate::calibration::read_sets;
use crate::diagnostic::{Diagnostic, NotUtf8, Source, utf8};
use crate::file::CommandFiles;
use crate::outline;
use crate::policy::chart::Chart;
use crate::policy::{self, Compiled, Library, PolicyTest, gather_and_compile};
use crate::scenario::{self, unreadable};
use crate::scene::{FileReference, Scene};
use crate::study::bench::{DEFAULT_POLICY, TextFile};
use vibrissa_runtime::calibration::ContactSet;
use vibrissa_runtime::machine::{ARTIFACT_LIMIT, Artifact, Program};
use vibrissa_runtime::units::suggest;

use super::exit::Failure;
use super::output;

/// The most bytes that a text may have: as many as the largest scenario may have. Policies are smaller still.
const SIZE_LIMIT: usize = 1 << 20;

/// Something read from a file, with a hash of the file's text.
pub(super) struct Loaded<T> {
    pub(super) value: T,
    pub(super) hash: Sha256,
}

/// The name of a file as messages tell it. Paths within a text start from it, so that it must be the path, letter by letter.
fn name(path: &Path) -> Result<String, Failure> {
    path.to_str().map(str::to_owned).ok_or_else(|| Failure::Name { path: path.to_owned() })
}

/// Reads a text.
pub(super) fn read(path: &Path, files: &mut CommandFiles) -> Result<Source, Failure> {
    let name = name(path)?;
    let text = files.read(path, SIZE_LIMIT).and_then(|bytes| text(&bytes)).map_err(Failure::read(path))?;
    Ok(Source::new(name, text))
}

fn text(bytes: &[u8]) -> Result<String, Error> {
    let unusable = |cause: &str| Error::new(ErrorKind::InvalidData, cause);
    if bytes.len() > SIZE_LIMIT {
        return Err(unusable(
            "it is larger than 1 MiB; a scenario or policy is a page of text: is this the right file?",
        ));
    }
    let text = utf8(bytes).map_err(|fault| unusable(&format!("{fault}; {}", NotUtf8::ADVICE)))?;
    Ok(text.to_owned())
}

/// Reads standard input.
pub(super) fn read_standard(files: &mut CommandFiles) -> Result<Source, Failure> {
    let name = "standard input";
    let text =
        files.read_standard(SIZE_LIMIT).and_then(|bytes| text(&bytes)).map_err(Failure::read(Path::new(name)))?;
    Ok(Source::new(name, text))
}

/// Reads a scenario with the files that it refers to; the hash is that of all of them.
pub(super) fn scenario(path: &Path, files: &mut CommandFiles) -> Result<Loaded<Scene>, Failure> {
    scenario_in(&read(path, files)?, files)
}

/// The same of a text that has been read.
pub(super) fn scenario_in(source: &Source, files: &mut CommandFiles) -> Result<Loaded<Scene>, Failure> {
    read_scenario(source, |name| outline_file(&beside(Path::new(&source.name), name), files))
}

/// The bytes of a file that a scenario names.
pub(super) fn outline_file(path: &Path, files: &mut CommandFiles) -> Result<Vec<u8>, String> {
    files.read(path, outline::SIZE_LIMIT).map_err(|cause| reason(path, &cause))
}

/// The path of a file that the file at `path` names relative to itself.
pub(super) fn beside(path: &Path, name: impl AsRef<Path>) -> PathBuf {
    path.parent().unwrap_or(Path::new("")).join(name)
}

/// A scenario that is part of the program.
pub(super) fn built_in_scenario(file: &TextFile) -> Result<Loaded<Scene>, Failure> {
    read_scenario(&Source::new(file.path, file.text), |_| Err("it is no part of the program".to_owned()))
}

fn read_scenario(
    source: &Source,
    mut file: impl FnMut(&str) -> Result<Vec<u8>, String>,
) -> Result<Loaded<Scene>, Failure> {
    let mut hash = Sha256::new().chain_update(&source.text);
    let scene = scenario::read_with(source, &mut |name| {
        let bytes = file(name)?;
        hash.update([0]);
        hash.update(&bytes);
        Ok(bytes)
    });
    match scene {
        Ok(value) => Ok(Loaded { value, hash }),
        Err(faults) => Err(Failure::Faults { source_text: Box::new(source.clone()), faults }),
    }
}

/// Reads touches that were measured.
pub(super) fn contact_sets(path: &Path, files: &mut CommandFiles) -> Result<Vec<ContactSet>, Failure> {
    let source = read(path, files)?;
    read_sets(source.text.as_bytes()).map_err(|cause| Failure::Sets { path: path.to_owned(), cause })
}

/// What a file that is given for a policy holds.
pub(super) enum PolicyFile {
    Text(Source),
    Machine(Box<Artifact>),
}

/// Reads a policy's text or a compiled machine, which is one by how it begins, or is meant to be by its name; the hash is that of the file
/// alone.
pub(super) fn policy_file(path: &Path, files: &mut CommandFiles) -> Result<Loaded<PolicyFile>, Failure> {
    let bytes = files.read(path, ARTIFACT_LIMIT).map_err(Failure::read(path))?;
    let hash = Sha256::new().chain_update(&bytes);
    let value = if Artifact::is_in(&bytes) || path.extension().is_some_and(|ending| ending == "machine") {
        PolicyFile::Machine(Box::new(Artifact::from_bytes(&bytes).map_err(Failure::artifact(path))?))
    } else {
        PolicyFile::Text(Source::new(name(path)?, text(&bytes).map_err(Failure::read(path))?))
    };
    Ok(Loaded { value, hash })
}

/// A policy's text with those of the files that it uses.
pub(super) fn with_libraries(source: &Source, files: &mut CommandFiles) -> Source {
    policy::gather(source, &mut |path| library(Path::new(path), files))
}

/// The text of a file that a policy uses.
fn library(path: &Path, files: &mut CommandFiles) -> Result<String, String> {
    files.read(path, SIZE_LIMIT).and_then(|bytes| text(&bytes)).map_err(|cause| reason(path, &cause))
}

/// The same for an editor, which writes to no file.
#[cfg(feature = "lsp")]
pub(super) fn library_for_editor(path: &str) -> Result<String, String> {
    let path = Path::new(path);
    crate::file::read(path, SIZE_LIMIT).and_then(|bytes| text(&bytes)).map_err(|cause| reason(path, &cause))
}

/// Why a file cannot be read; where there is none, with the name that was probably meant.
fn reason(path: &Path, cause: &Error) -> String {
    if cause.kind() != ErrorKind::NotFound {
        return cause.to_string();
    }
    let siblings = path.parent().map(|folder| if folder == Path::new("") { Path::new(".") } else { folder });
    let siblings = siblings.and_then(|folder| folder.read_dir().ok()).into_iter().flatten().flatten();
    let mut siblings: Vec<String> = siblings.filter_map(|sibling| sibling.file_name().into_string().ok()).collect();
    // Of names that are equally near the first is suggested, and a folder has no order of its own.
    siblings.sort_unstable();
    let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    match suggest(name, siblings.iter().map(String::as_str).filter(|sibling| *sibling != name)) {
        Some(meant) => format!("{cause}; did you mean `{meant}`?"),
        None => cause.to_string(),
    }
}

/// That a file cannot be read, at the place in `source` that names it; other failures as they are.
pub(super) fn named_in(source: &Source, file: &FileReference) -> impl FnOnce(Failure) -> Failure {
    |failure| match failure {
        Failure::Read { path, cause } => at(source, unreadable(file, &reason(&path, &cause))),
        other => other,
    }
}

/// The failure that a fault of a text is.
pub(super) fn at(source: &Source, fault: Diagnostic) -> Failure {
    Failure::Faults { source_text: Box::new(source.clone()), faults: vec![fault] }
}

/// A policy that is ready to run.
pub(super) struct Policy {
    pub(super) artifact: Artifact,
    /// `None` if it was compiled before.
    pub(super) text: Option<PolicyText>,
}

impl Policy {
    /// Tells what the compiler warns of.
    pub(super) fn tell_warnings(&self) {
        if let Some(PolicyText { source, warnings, .. }) = &self.text {
            output::diagnostics(source, warnings);
        }
    }
}

/// The text of a policy that compiled.
pub(super) struct PolicyText {
    pub(super) source: Source,
    pub(super) warnings: Vec<Diagnostic>,
    pub(super) tests: Vec<PolicyTest>,
}

/// Reads a policy's text and compiles it, or a compiled machine.
pub(super) fn policy(path: &Path, files: &mut CommandFiles) -> Result<Loaded<Policy>, Failure> {
    let Loaded { value, hash } = policy_file(path, files)?;
    match value {
        PolicyFile::Machine(artifact) => Ok(Loaded { value: Policy { artifact: *artifact, text: None }, hash }),
        PolicyFile::Text(source) => compiled(&source, &mut |path| library(Path::new(path), files)),
    }
}

/// The policy for the scene that was read from `source`: the one that is asked for, or else the one that the scene names, or else the
/// one that is built in.
pub(super) fn policy_for(
    asked: Option<&Path>,
    scene: &Scene,
    source: &Source,
    files: &mut CommandFiles,
) -> Result<Loaded<Policy>, Failure> {
    match (asked, &scene.policy) {
        (Some(path), _) => policy(path, files),
        (None, Some(file)) => {
            let path = beside(Path::new(&source.name), &file.path);
            policy(&path, files).map_err(named_in(source, file))
        }
        (None, None) => built_in_policy(&DEFAULT_POLICY),
    }
}

/// Reads a policy's machine alone: what the compiler warns of takes most of its time.
pub(super) fn program(path: &Path, files: &mut CommandFiles) -> Result<Loaded<Program>, Failure> {
    let Loaded { value, hash } = policy_file(path, files)?;
    let source = match value {
        PolicyFile::Machine(artifact) => return Ok(Loaded { value: artifact.program, hash }),
        PolicyFile::Text(source) => with_libraries(&source, files),
    };
    let hash = Sha256::new().chain_update(&source.text);
    match policy::compile(&source) {
        Ok(value) => Ok(Loaded { value, hash }),
        Err(faults) => Err(Failure::Faults { source_text: Box::new(source), faults }),
    }
}

/// A policy that is part of the program. It uses the standard library alone.
pub(super) fn built_in_policy(file: &TextFile) -> Result<Loaded<Policy>, Failure> {
    let source = Source::new(file.path, file.text);
    compiled(&source, &mut |_| Err("it is no part of the program".to_owned()))
}

fn compiled(source: &Source, library: &mut Library<'_>) -> Result<Loaded<Policy>, Failure> {
    let (source, compiled) = gather_and_compile(source, library);
    let hash = Sha256::new().chain_update(&source.text);
    match compiled {
        Ok(Compiled { artifact, tests, warnings }) => {
            let value = Policy { artifact, text: Some(PolicyText { source, warnings, tests }) };
            Ok(Loaded { value, hash })
        }
        Err(faults) => Err(Failure::Faults { source_text: Box::new(source), faults }),
    }
}

/// Reads a policy's text where a compiled machine will not do.
pub(super) fn policy_text(path: &Path, files: &mut CommandFiles) -> Result<Source, Failure> {
    match policy_file(path, files)?.value {
        PolicyFile::Text(source) => Ok(source),
        PolicyFile::Machine(artifact) => {
            Err(Failure::Compiled { path: path.to_owned(), origin: artifact.origin.file.clone() })
        }
    }
}

pub(super) fn chart(path: &Path, files: &mut CommandFiles) -> Result<Chart, Failure> {
    let source = with_libraries(&policy_text(path, files)?, files);
    policy::chart(&source).map_err(|faults| Failure::Faults { source_text: Box::new(source), faults })
}

/// The first sixteen hexadecimal digits of a hash: enough to tell files apart.
pub(super) fn short(hash: &[u8]) -> String {
    hex(&hash[..hash.len().min(8)])
}

/// Bytes in hexadecimal digits.
pub(super) fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |digits, byte| digits + &format!("{byte:02x}"))
}
