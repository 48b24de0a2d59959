//! Results of a sweep that is as large as needed, and their merge.

use std::collections::BTreeMap;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use vibrissa_text::diagnostic::Source;
use vibrissa_text::file::{CommandFiles, append};

use super::case::RunCase;
use super::error::{FOLDER, ScaleError};
use crate::results::{Document, Provenance, RunResult};
use crate::sweep::{Header, Shard, Sweep, SweepLine, SweepRun, SweepSummary, merge};

/// A file of results.
pub(super) struct ResultLines {
    results: PathBuf,
    merged: PathBuf,
}

/// The text of a sweep with this number of trials of `scenario` under `policy`.
pub(super) fn sweep_text(scenario: &str, policy: &str, trials: usize) -> String {
    format!("name: scale\npolicies: [{policy}]\nscenes: [{{scenario: {scenario}, trials: {trials}}}]\n")
}

/// The sweep of a text.
pub(super) fn sweep(text: &str) -> Result<Sweep, ScaleError> {
    Sweep::from_yaml(&Source::new("sweep.yaml", text)).map_err(|faults| ScaleError::Text(format!("{faults:?}")))
}

/// The line of a run of a sweep with this result.
pub(super) fn line(run: &SweepRun<'_>, result: &RunResult) -> Result<String, ScaleError> {
    let line = SweepLine::ran(run, String::new(), result.clone());
    serde_json::to_string(&line.versioned(None)).map_err(|cause| ScaleError::Text(cause.to_string()))
}

impl ResultLines {
    /// Writes the lines of a number of runs into a file in `folder`, all with the result of one run.
    ///
    /// # Errors
    /// [`ScaleError`] if the run cannot begin or the file cannot be written.
    pub(super) fn write(folder: &Path, count: usize, case: &RunCase) -> Result<Self, ScaleError> {
        let trial = case.trial()?;
        let result = trial.document(&trial.run()?);
        let text = sweep_text("scale.yaml", "thesis.fsm", count);
        let sweep = sweep(&text)?;
        let header = Header { sweep: sweep.name.clone(), shard: Shard::WHOLE, text, inputs: BTreeMap::new() };
        let results = folder.join(format!("results-{count}.jsonl"));
        let merged = folder.join(format!("merged-{count}.jsonl"));
        let fault = |cause: io::Error| ScaleError::file(&results)(cause);
        let mut file = BufWriter::new(append(&results).map_err(fault)?);
        let provenance = Provenance::default();
        serde_json::to_writer(&mut file, &header.versioned(Some(&provenance))).map_err(|cause| fault(cause.into()))?;
        writeln!(file).map_err(fault)?;
        for run in sweep.runs() {
            writeln!(file, "{}", line(&run, &result)?).map_err(fault)?;
        }
        file.flush().map_err(fault)?;
        Ok(Self { results, merged })
    }

    /// Reads, checks, counts and writes them as `vibrissa study merge` does.
    ///
    /// # Errors
    /// [`ScaleError`] if a file cannot be read or written.
    pub(super) fn merge(&self) -> Result<(), ScaleError> {
        let mut files = CommandFiles::new();
        let merged = merge(std::slice::from_ref(&self.results), &mut files)?;
        let merged = merged.filter(|merged| merged.missing().next().is_none());
        let merged = merged.ok_or_else(|| ScaleError::Text("results are missing".to_owned()))?;
        let out = files.output(FOLDER, &self.merged)?;
        out.write_with(|out| merged.write(&Provenance::default(), out))?;
        drop(SweepSummary::new(&merged.sweep, &merged.figures, 0));
        Ok(())
    }
}
