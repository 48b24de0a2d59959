//! `vibrissa run --break` and `--transitions`

use std::path::PathBuf;
use std::sync::Arc;

use clap::Args;

use super::exit::Exit;
use super::failure::Failure;
use super::output;
use super::provenance::of_trials;
use super::reports::Reports;
use super::run::{Prepared, RunArguments, TickFile, prepared_trials};
use vibrissa_lab::inspect::{Breakpoints, Inspector};
use vibrissa_lab::load::LoadError;
use vibrissa_lab::report::stop_tables;
use vibrissa_lab::trial::{ExecuteError, Trial};
use vibrissa_text::diagnostic::Source;
use vibrissa_text::file::CommandFiles;

/// The options of a run that looks into its policy.
#[derive(Debug, Args)]
pub(super) struct InspectionOptions {
    /// Stop when a state is entered or a condition holds, and print what each guard is missing: --break Retrieval,
    /// --break `r0.base_angle > 300 urad`. Repeatable. With --live, the run only pauses there
    #[arg(long = "break", value_name = "STATE|CONDITION")]
    pub(super) breakpoints: Vec<String>,
    /// Write every transition that is taken into this file, with the parts of all guards, as one line of JSON each. The
    /// violations of contracts follow
    #[cfg_attr(feature = "live", arg(long, value_name = "FILE", conflicts_with_all = ["watch", "live"]))]
    #[cfg_attr(not(feature = "live"), arg(long, value_name = "FILE", conflicts_with = "watch"))]
    transitions: Option<PathBuf>,
}

impl InspectionOptions {
    /// True if an option is given.
    pub(super) fn is_given(&self) -> bool {
        !self.breakpoints.is_empty() || self.transitions.is_some()
    }
}

/// Runs each trial with an inspector.
pub(super) fn inspect(arguments: &RunArguments, files: &mut CommandFiles) -> Result<Exit, Failure> {
    let options = &arguments.inspection;
    let trials = prepared_trials(arguments, files)?;
    let transition_file = options.transitions.as_ref().map(|path| files.output("--transitions", path)).transpose()?;
    let mut reports = Reports::new(trials.iter().map(|prepared| &prepared.trial), arguments.out.as_deref(), files)?;
    let provenance = of_trials(trials.iter().map(|prepared| &prepared.trial));
    let mut ticks = TickFile::new(arguments, files)?;
    let (mut stops, mut lines, mut exit) = (Vec::new(), String::new(), Exit::Done);
    for (index, Prepared { trial, text, .. }) in trials.iter().enumerate() {
        let source = text.as_ref().ok_or_else(|| Failure::NoTextToInspect { name: trial.program.name.clone() })?;
        let policy = breakpoints(source, &options.breakpoints)?;
        let trial = with_program(trial, &policy);
        let mut inspector = Inspector::new(&policy, &trial.scene.name);
        let finished = trial.run_watched(&mut inspector);
        for line in inspector.transitions() {
            lines += &output::json_line(lines.is_empty().then_some(&provenance), line)?;
        }
        for line in inspector.violations() {
            lines += &output::json_line(lines.is_empty().then_some(&provenance), line)?;
        }
        if let Some(origin) = inspector.origin_of_non_finite() {
            output::message(format_args!("{}: a number is not finite since `{origin}`", trial.scene.name));
        }
        match (finished, inspector.stop()) {
            (Err(ExecuteError::Interrupted), Some(stop)) => stops.push(stop.clone()),
            (finished, _) => {
                let finished = finished.map_err(Failure::execute(&trial))?;
                if !finished.violations.is_empty() {
                    exit = Exit::Unexpected;
                }
                ticks.add(&provenance, &trial, &finished.run)?;
                reports.add(&provenance, index, &trial, &finished)?;
            }
        }
    }
    if let Some(file) = transition_file {
        file.write(lines)?;
    }
    ticks.write()?;
    if !stops.is_empty() {
        output::documents(arguments.format, &provenance, &stops, || {
            stops.iter().flat_map(stop_tables).collect::<Vec<_>>()
        })?;
    }
    if stops.is_empty() || !reports.is_empty() {
        reports.show(&provenance, arguments.format)?;
    }
    Ok(exit)
}

/// The policy with the requested breakpoints.
pub(super) fn breakpoints(source: &Source, texts: &[String]) -> Result<Breakpoints, Failure> {
    Breakpoints::new(source, texts)
        .map_err(|(source, faults)| Failure::Load(LoadError::Faults { source_text: Box::new(source), faults }))
}

/// The trial with the program that can be explained. Its parameters have the same values.
pub(super) fn with_program(trial: &Trial, policy: &Breakpoints) -> Trial {
    let program = policy.explained.with_parameters_of(&trial.program);
    Trial { program: Arc::new(program), ..trial.clone() }
}
