//! A job of a sweep that runs as an array: a process with one shard.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use vibrissa_text::file::{TemporaryFolder, replace};
use vibrissa_world::scene::WorldKind;

use super::case::{Case, wall};
use super::error::ScaleError;
use super::result_lines::{sweep, sweep_text};
use super::sweep_cost::RUNS;
use super::{policy, scene};
use crate::sweep::Shard;

/// Measures the wall time of a job with one short run, or very few, in a sweep with [`RUNS`] runs. It has the start of the
/// processes, the policy with its analysis, and the keys of all runs, of which the job has to find its own.
///
/// # Errors
/// [`ScaleError`] if the files of the sweep cannot be written.
pub(super) fn job(folder: &Path, program: &Path, world: WorldKind) -> Result<Case, ScaleError> {
    let text = sweep_text(&format!("{world}.yaml"), "thesis.fsm", RUNS);
    let scenario = format!("{}world: {world}\n", scene::lasting(1));
    let path = folder.join(format!("{world}-sweep.yaml"));
    for (path, text) in [
        (path.clone(), text.as_str()),
        (folder.join(format!("{world}.yaml")), scenario.as_str()),
        (folder.join("thesis.fsm"), policy::tracing().text.as_str()),
    ] {
        replace(&path, text.as_bytes()).map_err(ScaleError::file(path))?;
    }
    // The part that has the first run. Most parts of so many have one run, and some have none.
    let parts: Shard = format!("1/{RUNS}").parse().map_err(ScaleError::Text)?;
    let sweep = sweep(&text)?;
    let shard = sweep.run(0).map_or(parts, |run| parts.of_run(&run.key()));
    let program = program.to_owned();
    Ok(wall(move || run(&program, &path, shard)))
}

/// Runs a shard of the sweep at `path` into a folder of its own.
fn run(program: &PathBuf, path: &Path, shard: Shard) -> Result<(), ScaleError> {
    let out = TemporaryFolder::new().map_err(ScaleError::file(std::env::temp_dir()))?;
    let mut command = Command::new(program);
    command.arg("sweep").arg(path).args(["--shard", &shard.to_string(), "--jobs", "1", "--pictures", "none", "--out"]);
    let output = command.arg(out.path()).stdin(Stdio::null()).stdout(Stdio::null()).output();
    let output = output.map_err(|cause| ScaleError::Job(format!("{}: {cause}", program.display())))?;
    if output.status.success() {
        return Ok(());
    }
    Err(ScaleError::Job(String::from_utf8_lossy(&output.stderr).trim().to_owned()))
}
