//! The reports of `vibrissa run`.

use std::path::Path;

use super::failure::Failure;
use super::options::Format;
use super::output;
use super::report_folder::{say, written};
use super::trials::{ReportFiles, make_directory, report_events, report_violations};
use vibrissa_lab::report::{RunFigures, results_table, runs_page};
use vibrissa_lab::results::{Provenance, RunResult};
use vibrissa_lab::run::Run;
use vibrissa_lab::trial::{Trial, TrialResult};
use vibrissa_text::file::{CommandFiles, Output};

/// Number of messages of a run that are printed.
const MESSAGES_PRINTED: usize = 40;

/// The results of the runs of a command. With a directory, also the files of each run and a page that shows all of them.
pub(super) struct Reports {
    /// The files of each run, until they are written.
    files: Vec<Option<ReportFiles>>,
    page: Option<Output>,
    results: Vec<RunResult>,
    /// The figures of each result that has files, and whether its expectations hold.
    figures: Vec<(RunFigures, bool)>,
}

impl Reports {
    /// Makes the directory for the reports of these trials.
    pub(super) fn new<'t>(
        trials: impl Iterator<Item = &'t Trial>,
        directory: Option<&Path>,
        files: &mut CommandFiles,
    ) -> Result<Self, Failure> {
        make_directory(directory)?;
        let report = |trial: &Trial| {
            let report = directory.map(|directory| ReportFiles::new(&directory.join(&trial.scene.name), files));
            Ok(report.transpose()?)
        };
        let reports = trials.map(report).collect::<Result<_, Failure>>()?;
        let page = directory.map(|directory| files.output("--out", &directory.join("index.html"))).transpose()?;
        Ok(Self { files: reports, page, results: Vec::new(), figures: Vec::new() })
    }

    /// Prints the expectations of the trial with this index that do not hold, and writes its files.
    pub(super) fn add(
        &mut self,
        provenance: &Provenance,
        index: usize,
        trial: &Trial,
        finished: &TrialResult,
    ) -> Result<(), Failure> {
        let result = trial.document(finished);
        report_events(&result);
        show_messages(trial, &finished.run);
        for contract in finished.run.contracts.iter().filter(|contract| contract.violations > 0) {
            output::message(format_args!("{}: {contract}", trial.scene.name));
        }
        report_violations(&trial.scene.name, finished);
        if let Some(files) = self.files.get_mut(index).and_then(Option::take) {
            let figures = files.write(provenance, trial, finished, &result)?;
            self.figures.push((figures, finished.violations.is_empty()));
        }
        self.results.push(result);
        Ok(())
    }

    /// True without a result.
    pub(super) fn is_empty(&self) -> bool {
        self.results.is_empty()
    }

    /// Prints the results, and writes the page.
    pub(super) fn show(self, provenance: &Provenance, format: Format) -> Result<(), Failure> {
        let Self { page, results, figures, .. } = self;
        output::documents(format, provenance, &results, || [results_table(&results)])?;
        let Some(page) = page else { return Ok(()) };
        let runs: Vec<_> =
            results.iter().zip(&figures).map(|(result, (figures, passed))| (result, figures, *passed)).collect();
        say(Some(written(page, runs_page(provenance, &runs))?), format)
    }
}

/// Prints the first messages that the policy has logged.
fn show_messages(trial: &Trial, run: &Run) {
    let (name, trace) = (&trial.scene.name, &run.trace);
    for message in trace.messages.iter().take(MESSAGES_PRINTED) {
        let time = trace.ticks.get(message.tick).map_or(0.0, |tick| tick.time);
        let state = message.state.and_then(|state| trace.states.get(state));
        let state = state.map_or_else(String::new, |state| format!("{state}: "));
        output::message(format_args!("{name}: {time:.2} s, {state}{}", message.message));
    }
    let further = trace.messages.len().saturating_sub(MESSAGES_PRINTED) + trace.further_messages;
    if further > 0 {
        output::message(format_args!("{name}: {further} further messages, which `--ticks FILE` writes"));
    }
}
