//! The program that the figures come from.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::inputs::{BENCH, LIBRARY, PLAUSIBLE, POLICIES};
use super::{ResultsError, StampError};
use crate::cargo::{NotStarted, cargo, target_directory};
use crate::json::Json;
use crate::setup::{self, Options};
use crate::sign_of_life::SignOfLife;

/// The given program, or one that is built. It must contain the policies and scenarios of the checkout.
pub(super) fn of_checkout(root: &Path, program: Option<&Path>) -> Result<PathBuf, ResultsError> {
    let path = if let Some(program) = program {
        program.to_owned()
    } else {
        build(root)?;
        target_directory(root).join("release/vibrissa")
    };
    let bytes = fs::read(&path).map_err(|source| ResultsError::Program { path: path.clone(), source })?;
    match first_other(root, &String::from_utf8_lossy(&bytes))? {
        Some(file) => Err(ResultsError::OtherProgram { path, file }),
        None => Ok(path),
    }
}

/// The first of the files that a program contains whose text is not in it.
fn first_other(root: &Path, program: &str) -> Result<Option<String>, StampError> {
    let unreadable = |path: PathBuf| move |source| StampError::Read { path, source };
    let library = root.join(LIBRARY);
    let entries = fs::read_dir(&library).and_then(Iterator::collect::<Result<Vec<_>, _>>);
    let entries = entries.map_err(unreadable(library))?;
    let modules = entries.iter().map(|entry| format!("{LIBRARY}/{}", entry.file_name().to_string_lossy()));
    // Beside the texts is the list that includes them.
    let modules = modules.filter(|file| Path::new(file).extension().is_some_and(|ending| ending == "fsm"));
    let scenes = BENCH.iter().map(|scene| format!("scenarios/{scene}.yaml"));
    let others = POLICIES.into_iter().chain([PLAUSIBLE]).map(str::to_owned);
    for file in modules.chain(scenes).chain(others) {
        let path = root.join(&file);
        if !program.contains(&fs::read_to_string(&path).map_err(unreadable(path))?) {
            return Ok(Some(file));
        }
    }
    Ok(None)
}

/// Builds the program in release.
pub(crate) fn build(root: &Path) -> Result<(), ResultsError> {
    setup::setup(root, &Options::default())?;
    let _sign = SignOfLife::of("building; the last crate, vibrissa itself, takes longest");
    let mut build = cargo(root, &["build", "--release", "--package", "vibrissa"]);
    let status = build.status().map_err(|source| NotStarted { program: "cargo", source })?;
    if status.success() { Ok(()) } else { Err(ResultsError::Build(status)) }
}

/// The output of a command of the program.
pub(crate) fn output(root: &Path, program: Option<&Path>, command: &str) -> Result<Json, ResultsError> {
    json(command, &printed(root, program, command, None)?)
}

pub(super) fn json(command: &str, printed: &str) -> Result<Json, ResultsError> {
    Json::read(printed).ok_or_else(|| ResultsError::NoJson(command.to_owned()))
}

/// What a command of the program prints. With `out`, it writes its files there, and not into the folder that the command names.
pub(super) fn printed(
    root: &Path,
    program: Option<&Path>,
    command: &str,
    out: Option<&Path>,
) -> Result<String, ResultsError> {
    let mut run = if let Some(path) = program {
        Command::new(path)
    } else {
        cargo(root, &["run", "--quiet", "--release", "--package", "vibrissa", "--"])
    };
    let path = program.unwrap_or(Path::new("cargo"));
    let mut words: Vec<&OsStr> = command.split_whitespace().map(OsStr::new).collect();
    if let (Some(folder), Some(at)) = (out, words.iter().position(|word| *word == "--out"))
        && let Some(word) = words.get_mut(at + 1)
    {
        *word = folder.as_os_str();
    }
    eprintln!("      vibrissa {command}");
    let output = {
        let _sign = SignOfLife::of("running");
        run.args(words).current_dir(root).stdin(Stdio::null()).output()
    };
    let output = output.map_err(|source| ResultsError::Program { path: path.to_owned(), source })?;
    // 1 says only that a run did not meet what was expected of it.
    if !matches!(output.status.code(), Some(0 | 1)) {
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        return Err(ResultsError::Failed { command: command.to_owned(), status: output.status, said });
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_with_another_text_of_a_policy_is_found() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new("."));
        let read = |path: &Path| fs::read_to_string(path).unwrap_or_default();
        let in_folder = |folder: &str| fs::read_dir(root.join(folder)).into_iter().flatten().flatten();
        let files = [LIBRARY, "policies", "scenarios", "scenarios/mismatch"].into_iter().flat_map(in_folder);
        let program: String = files.map(|file| read(&file.path())).collect();
        assert_eq!(first_other(root, &program).ok(), Some(None));
        let following = read(&root.join(LIBRARY).join("following.fsm"));
        let old = program.replace(&following, &following.replace("->", " ->"));
        assert_eq!(first_other(root, &old).ok(), Some(Some(format!("{LIBRARY}/following.fsm"))));
    }
}
