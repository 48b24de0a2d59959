//! Policies, as texts or compiled.

use std::path::Path;

use sha2::{Digest, Sha256};
use vibrissa_runtime::machine::{ARTIFACT_LIMIT, Artifact, ParameterValue, Program, SetError};

use super::sought::Sought;
use super::text::{SIZE_LIMIT, name, reason, text};
use super::{LoadError, Loaded};
use crate::built_in::{DEFAULT_POLICY, NAMED_SCENARIOS, POLICIES, TextFile};
use vibrissa_language::chart::Chart;
use vibrissa_language::{Analysis, Compiled, Library, PolicyTest, gather_and_compile};
use vibrissa_text::diagnostic::{Diagnostic, Source};
use vibrissa_text::file::{Cache, CommandFiles, hex};
use vibrissa_world::scenario;
use vibrissa_world::scene::{PolicyReference, PolicySetting, Scene};

/// The content of a policy file.
pub enum PolicyFile {
    /// Its text.
    Text(Source),
    /// A compiled machine.
    Machine(Box<Artifact>),
}

/// Reads the text of a policy or a compiled machine. The path can also be the name of a built-in policy. A machine is recognised by its first bytes or by its name. The
/// hash is that of the file alone.
///
/// # Errors
/// [`LoadError`] if a file cannot be read or its text has errors.
pub fn policy_file(path: &Path, files: &mut CommandFiles) -> Result<Loaded<PolicyFile>, LoadError> {
    let bytes = Sought::Policy.bytes(path, ARTIFACT_LIMIT, files)?;
    let hash = Sha256::new().chain_update(&bytes);
    let value = if Artifact::is_in(&bytes) || path.extension().is_some_and(|ending| ending == "machine") {
        PolicyFile::Machine(Box::new(Artifact::from_bytes(&bytes).map_err(LoadError::artifact(path))?))
    } else {
        PolicyFile::Text(Source::new(name(path)?, text(&bytes).map_err(LoadError::read(path))?))
    };
    Ok(Loaded { value, hash })
}

/// The text of a policy with those of the files that it uses.
pub fn with_libraries(source: &Source, files: &mut CommandFiles) -> Source {
    vibrissa_language::gather(source, &mut |path| library(Path::new(path), files))
}

/// The text of a file that a policy uses.
fn library(path: &Path, files: &mut CommandFiles) -> Result<String, String> {
    files.read(path, SIZE_LIMIT).and_then(|bytes| text(&bytes)).map_err(|cause| reason(path, &cause))
}

/// The text of a file that a policy uses, for an editor, which writes no file.
///
/// # Errors
/// The reason for which the file cannot be read.
pub fn library_for_editor(path: &str) -> Result<String, String> {
    let path = Path::new(path);
    vibrissa_text::file::read(path, SIZE_LIMIT).and_then(|bytes| text(&bytes)).map_err(|cause| reason(path, &cause))
}

/// A policy that is ready to run.
pub struct Policy {
    /// The compiled machine.
    pub artifact: Artifact,
    /// The text. `None` for a compiled machine.
    pub text: Option<PolicyText>,
}

/// The text of a policy that compiled.
pub struct PolicyText {
    /// The text with those of all files that it uses.
    pub source: Source,
    /// Warnings about probable mistakes.
    pub warnings: Vec<Diagnostic>,
    /// The tests in it. Only [`tested_policy`] has those of a built-in policy.
    pub tests: Vec<PolicyTest>,
    /// True if the text is a test file. Then the program is that of the tested machine.
    pub(crate) is_test_file: bool,
}

/// Reads the text of a policy and compiles it, or reads a compiled machine.
///
/// # Errors
/// [`LoadError`] if a file cannot be read or its text has errors.
pub fn policy(path: &Path, files: &mut CommandFiles) -> Result<Loaded<Policy>, LoadError> {
    let file = policy_file(path, files)?;
    if let PolicyFile::Text(source) = &file.value
        && let Some(policy) = kept_built_in(source)
    {
        return Ok(policy);
    }
    let policy = of_file(file, files)?;
    match &policy.value.text {
        Some(text) if text.is_test_file => Err(LoadError::TestFile { path: path.to_owned() }),
        _ => Ok(policy),
    }
}

/// Reads a policy, or the machine of a test file with the tests of that file.
///
/// # Errors
/// [`LoadError`] if a file cannot be read or its text has errors.
pub fn tested_policy(path: &Path, files: &mut CommandFiles) -> Result<Loaded<Policy>, LoadError> {
    of_file(policy_file(path, files)?, files)
}

fn of_file(Loaded { value, hash }: Loaded<PolicyFile>, files: &mut CommandFiles) -> Result<Loaded<Policy>, LoadError> {
    match value {
        PolicyFile::Machine(artifact) => Ok(Loaded { value: Policy { artifact: *artifact, text: None }, hash }),
        PolicyFile::Text(source) => policy_in(&source, files),
    }
}

/// The folder of machines in the cache of the user.
const MACHINES: &str = "machines";

/// The built-in policy with this text, through the cache of the user. `None` for another text, or without a cache.
fn kept_built_in(source: &Source) -> Option<Loaded<Policy>> {
    let is_built_in = POLICIES.iter().any(|file| file.text == source.text);
    if is_built_in { built_in_from(&Cache::of_user(MACHINES)?, source) } else { None }
}

/// A built-in policy with its machine from a cache, which has it afterwards. `None` for a text with errors.
fn built_in_from(cache: &Cache, source: &Source) -> Option<Loaded<Policy>> {
    let whole = vibrissa_language::gather_modules(source);
    let hash = Sha256::new().chain_update(&whole.text);
    let text_sha256: [u8; 32] = hash.clone().finalize().into();
    // A machine of another compiler is another file.
    let name = source.name.rsplit(['/', '\\']).next().unwrap_or_default();
    let key = Sha256::new().chain_update(env!("VIBRISSA_SOURCES")).chain_update(text_sha256).chain_update(name);
    let key = hex(&key.finalize());
    let kept = cache.read(&key).and_then(|bytes| Artifact::from_bytes(&bytes).ok());
    if let Some(artifact) = kept.filter(|artifact| artifact.origin.text_sha256 == text_sha256) {
        let text = PolicyText { source: whole, warnings: Vec::new(), tests: Vec::new(), is_test_file: false };
        return Some(Loaded { value: Policy { artifact, text: Some(text) }, hash });
    }
    let policy = compiled(source, &mut |_| Err("it is not built into the program".to_owned())).ok()?;
    if let Ok(bytes) = policy.value.artifact.to_bytes() {
        cache.write(&key, &bytes);
    }
    Some(policy)
}

/// The policy for the scene that was read from `source`: the requested one, else the one that the scene names, with its
/// parameters, else the built-in one.
///
/// # Errors
/// [`LoadError`] if a file cannot be read or its text has errors.
pub fn policy_for(
    asked: Option<&Path>,
    scene: &Scene,
    source: &Source,
    files: &mut CommandFiles,
) -> Result<Loaded<Policy>, LoadError> {
    match (asked, &scene.policy) {
        (Some(path), _) => policy(path, files),
        (None, Some(_)) if TextFile::named(NAMED_SCENARIOS, Path::new(&source.name)).is_some() => {
            built_in_policy(named_by_built_in(scene))
        }
        (None, Some(PolicyReference { file, settings })) => {
            let path = Sought::Policy.beside(Path::new(&source.name), &file.path);
            let named = policy(&path, files).map_err(LoadError::named_in(source, file))?;
            settings.iter().try_fold(named, |policy, PolicySetting { name, value, span }| {
                let unfit = |cause: SetError| LoadError::at(source, scenario::unfit(*span, &cause.to_string()));
                set(policy, &[(name.clone(), value.clone())]).map_err(unfit)
            })
        }
        (None, None) => built_in_policy(&DEFAULT_POLICY),
    }
}

/// The built-in policy with the name that a built-in scenario gives, or else the default one.
#[must_use]
pub fn named_by_built_in(scene: &Scene) -> &'static TextFile {
    let named = scene.policy.as_ref().and_then(|policy| TextFile::named(POLICIES, Path::new(&policy.file.name)));
    named.unwrap_or(&DEFAULT_POLICY)
}

/// Reads a policy without its warnings, which take most of the time of a compilation.
///
/// # Errors
/// [`LoadError`] if a file cannot be read or its text has errors.
pub fn program(path: &Path, files: &mut CommandFiles) -> Result<Loaded<Program>, LoadError> {
    let Loaded { value, hash } = policy_file(path, files)?;
    let source = match value {
        PolicyFile::Machine(artifact) => return Ok(Loaded { value: artifact.program, hash }),
        PolicyFile::Text(source) => with_libraries(&source, files),
    };
    let hash = Sha256::new().chain_update(&source.text);
    match vibrissa_language::compile(&source) {
        Ok(value) => Ok(Loaded { value, hash }),
        Err(faults) => Err(LoadError::Faults { source_text: Box::new(source), faults }),
    }
}

/// A built-in policy. It uses only the standard library.
///
/// # Errors
/// [`LoadError`] if a file cannot be read or its text has errors.
pub fn built_in_policy(file: &TextFile) -> Result<Loaded<Policy>, LoadError> {
    let source = Source::new(file.path, file.text);
    let compiled = || compiled(&source, &mut |_| Err("it is not built into the program".to_owned()));
    kept_built_in(&source).map_or_else(compiled, Ok)
}

/// The policy of a text that has been read, with the files that it uses.
///
/// # Errors
/// [`LoadError`] if a file cannot be read or its text has errors.
pub fn policy_in(source: &Source, files: &mut CommandFiles) -> Result<Loaded<Policy>, LoadError> {
    compiled(source, &mut |path| library(Path::new(path), files))
}

fn compiled(source: &Source, library: &mut Library<'_>) -> Result<Loaded<Policy>, LoadError> {
    // A built-in policy has no warnings, which a test checks, and it uses the standard library alone.
    let is_built_in = POLICIES.iter().any(|file| file.text == source.text);
    let analysis = if is_built_in { Analysis::Omitted } else { Analysis::Whole };
    let (source, compiled) = gather_and_compile(source, library, analysis);
    let hash = Sha256::new().chain_update(&source.text);
    match compiled {
        Ok(Compiled { artifact, tests, is_test_file, warnings, proved: _ }) => {
            let value = Policy { artifact, text: Some(PolicyText { source, warnings, tests, is_test_file }) };
            Ok(Loaded { value, hash })
        }
        Err(faults) => Err(LoadError::Faults { source_text: Box::new(source), faults }),
    }
}

/// Reads the text of a policy. A compiled machine is an error.
///
/// # Errors
/// [`LoadError`] if a file cannot be read or its text has errors.
pub fn policy_text(path: &Path, files: &mut CommandFiles) -> Result<Source, LoadError> {
    match policy_file(path, files)?.value {
        PolicyFile::Text(source) => Ok(source),
        PolicyFile::Machine(artifact) => {
            Err(LoadError::Compiled { path: path.to_owned(), origin: artifact.origin.file.clone() })
        }
    }
}

/// Reads a policy as a statechart.
///
/// # Errors
/// [`LoadError`] if a file cannot be read or its text has errors.
pub fn chart(path: &Path, files: &mut CommandFiles) -> Result<Chart, LoadError> {
    let source = with_libraries(&policy_text(path, files)?, files);
    vibrissa_language::chart(&source).map_err(|faults| LoadError::Faults { source_text: Box::new(source), faults })
}

/// A policy with these parameters set. Its hash depends on them.
///
/// # Errors
/// [`SetError`] if the policy does not have such a parameter, or if the value is out of its range.
pub fn set(mut policy: Loaded<Policy>, settings: &[(String, ParameterValue)]) -> Result<Loaded<Policy>, SetError> {
    let program = &mut policy.value.artifact.program;
    let mut values = Vec::with_capacity(settings.len());
    for (name, value) in settings {
        values.push((name.as_str(), program.set_value(name, value)?));
    }
    Ok(Loaded { hash: with_settings(policy.hash, values.into_iter()), ..policy })
}

/// The hash of a policy with the names and values (SI) of the parameters that are set.
#[must_use]
pub fn with_settings<'s>(policy: Sha256, settings: impl Iterator<Item = (&'s str, f64)>) -> Sha256 {
    settings.fold(policy, |hash, (name, value)| hash.chain_update(format!("\0{name}={value}")))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;

    #[test]
    fn a_machine_from_the_cache_is_that_of_the_text() {
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache::at(folder.path().to_owned());
        for file in POLICIES {
            let source = Source::new(file.path, file.text);
            let expected = compiled(&source, &mut |_| Err("it is not built in".to_owned())).unwrap();
            // Compiled, from the cache, and compiled again because the file in the cache is that of another policy.
            for pass in 0..3 {
                let found = built_in_from(&cache, &source).unwrap();
                assert_eq!(found.value.artifact, expected.value.artifact, "{pass}");
                assert_eq!(found.value.text.unwrap().source, expected.value.text.as_ref().unwrap().source);
                assert_eq!(found.hash.finalize(), expected.hash.clone().finalize());
                if pass == 1 {
                    let files = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name());
                    let keys: Vec<_> = files.map(|name| name.into_string().unwrap()).collect();
                    assert!(!keys.is_empty());
                    let other = vibrissa_language::compile_with_warnings(&Source::new("still.fsm", STILL)).unwrap();
                    for key in keys {
                        cache.write(&key, &other.artifact.to_bytes().unwrap());
                    }
                }
            }
        }
    }

    const STILL: &str = "machine still  initial Still  state Still { stop }";

    /// No run analyses a built-in policy.
    #[test]
    fn a_built_in_policy_has_no_warnings() {
        for file in POLICIES {
            let source = with_libraries(&Source::new(file.path, file.text), &mut CommandFiles::new());
            assert_eq!(vibrissa_language::compile_with_warnings(&source).unwrap().warnings, [], "{}", file.path);
        }
    }
}
