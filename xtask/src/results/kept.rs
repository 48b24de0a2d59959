//! Outputs of commands that are kept, so that an interruption loses at most one command.

use std::fs;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use super::ResultsError;
use super::program;
use super::stamp::{Stamp, hash, hexadecimal};
use crate::cargo::target_directory;
use crate::json::Json;

/// The outputs of the commands of one program.
pub(super) struct Kept<'a> {
    root: &'a Path,
    program: PathBuf,
    /// The hash of the program.
    of: String,
    folder: PathBuf,
}

impl<'a> Kept<'a> {
    pub(super) fn of(root: &'a Path, program: PathBuf) -> Result<Self, ResultsError> {
        let folder = target_directory(root).join("results");
        let bytes = fs::read(&program).map_err(|source| ResultsError::Program { path: program.clone(), source })?;
        let of = hexadecimal(&Sha256::digest(bytes));
        fs::create_dir_all(&folder).map_err(|source| ResultsError::Write { path: folder.clone(), source })?;
        Ok(Self { root, program, of, folder })
    }

    /// The output of a command. If it may be `reused`, that of an earlier call with the same program and the same inputs.
    pub(super) fn output(&self, command: &str, reused: bool) -> Result<Json, ResultsError> {
        let folder = self.folder_of(command)?;
        let path = folder.with_extension("json");
        if reused && let Some(output) = fs::read_to_string(&path).ok().and_then(|text| Json::read(&text)) {
            eprintln!("      vibrissa {command}\n      kept from an earlier call in {}", path.display());
            return Ok(output);
        }
        let text = program::printed(self.root, Some(&self.program), command, Some(&folder))?;
        let output = program::json(command, &text)?;
        // Renamed when it is complete, so that an interruption leaves no part of an output.
        let part = path.with_extension("part");
        let written = fs::write(&part, text).and_then(|()| fs::rename(&part, &path));
        written.map_err(|source| ResultsError::Write { path, source })?;
        Ok(output)
    }

    /// The folder into which a command writes. It is another one for another program or input. So a sweep continues only its own runs.
    pub(super) fn folder_of(&self, command: &str) -> Result<PathBuf, ResultsError> {
        let stamp = Stamp::of_commands(self.root, &[command], &[])?;
        Ok(self.folder.join(hash(&(self.of.clone() + &stamp.text()))))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use std::os::unix::fs::PermissionsExt;

    use super::*;

    /// A program that counts its calls. It prints the number of the call.
    fn counter(folder: &Path, comment: &str) -> PathBuf {
        let (path, calls) = (folder.join("program"), folder.join("calls"));
        let calls = calls.display();
        fs::write(&path, format!("#!/bin/sh\n# {comment}\necho x >> '{calls}'\necho [$(wc -l < '{calls}')]\n"))
            .unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
        path
    }

    #[test]
    fn a_command_runs_once_for_each_program_and_again_if_an_output_was_cut_short() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
        let folder = std::env::temp_dir().join(format!("vibrissa-kept-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let kept = |comment| {
            let mut kept = Kept::of(root, counter(&folder, comment)).unwrap();
            kept.folder = folder.clone();
            kept
        };
        let call = |kept: &Kept, reused| match kept.output("calibrate --json", reused).unwrap().items() {
            #[expect(clippy::cast_possible_truncation, reason = "a count")]
            [Json::Number(call)] => *call as i32,
            other => panic!("{other:?}"),
        };
        let first = kept("first");
        assert_eq!([call(&first, true), call(&first, true)], [1, 1]);
        assert_eq!([call(&first, false), call(&first, true)], [2, 2], "a named page is made anew");
        let path = first.folder_of("calibrate --json").unwrap().with_extension("json");
        fs::write(&path, "[").unwrap();
        assert_eq!(call(&first, true), 3);
        assert_eq!(call(&kept("second"), true), 4, "another program");
        fs::remove_dir_all(&folder).unwrap();
    }
}
