//! `vibrissa study estimators`

use std::num::NonZeroUsize;
use std::sync::Arc;

use clap::Args;

use super::exit::Exit;
use super::failure::Failure;
use super::options::{ArrayOptions, Format, Jobs, WorldOption};
use super::output;
use super::progress::Progress;
use super::provenance::of_trials;
use super::trials::calibrated;
use vibrissa_lab::built_in::{DEFAULT_POLICY, SCENARIOS, TextFile};
use vibrissa_lab::load::{self, LoadError, Loaded};
use vibrissa_lab::report::estimators_tables;
use vibrissa_lab::study::estimators::{EstimatorRow, evaluate_all};
use vibrissa_lab::trial::{Trial, in_parallel};
use vibrissa_text::file::CommandFiles;

const EXAMPLE: &str = "Example:\n  vibrissa study estimators --simulator quasistatic\n\nExit status: 0 done, whichever estimator is better; 2 unusable input; 3 internal error; 130 interrupted.";

/// The arguments of `vibrissa study estimators`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct EstimatorsArguments {
    #[command(flatten)]
    world: WorldOption,
    #[command(flatten)]
    array: ArrayOptions,
    #[command(flatten)]
    format: Format,
    #[command(flatten)]
    jobs: Jobs,
}

pub(super) fn estimators(arguments: &EstimatorsArguments) -> Result<Exit, Failure> {
    let program = Arc::new(load::built_in_policy(&DEFAULT_POLICY)?.value.artifact.program);
    let mismatch = arguments.array.load(&mut CommandFiles::new())?;
    mismatch.check_effect(std::iter::empty()).map_err(LoadError::from)?;
    let work = |file: &TextFile| {
        let Loaded { value: mut scene, mut hash } = load::built_in_scenario(file)?;
        mismatch.apply(&mut scene, &mut hash, 0).map_err(Failure::mismatch(file.path.as_ref()))?;
        let world = arguments.world.of(&scene);
        let trial = Trial { world: world.into(), ..Trial::new(scene, Arc::clone(&program)) };
        let trial = calibrated(&trial, &mismatch)?;
        let failed = |cause| Failure::Execute { scenario: file.path.into(), cause };
        let rows = evaluate_all(&trial.scene, Arc::clone(&program), world).map_err(failed)?.into_iter();
        let rows = rows.map(|row| EstimatorRow { calibration: trial.calibration(), ..row }).collect::<Vec<_>>();
        Ok::<_, Failure>((rows, trial))
    };
    // One run at a time by default, because the run times are compared too.
    let threads = arguments.jobs.threads_or(NonZeroUsize::MIN);
    let mut progress = Progress::new(SCENARIOS.len());
    let rows = in_parallel(SCENARIOS, threads, work, |rows| {
        if let Some(row) = rows.as_ref().ok().and_then(|(rows, _)| rows.first()) {
            progress.done(&row.scenario);
        }
    });
    progress.finish();
    let (rows, trials): (Vec<_>, Vec<Trial>) =
        rows.into_iter().collect::<Result<Vec<_>, Failure>>()?.into_iter().unzip();
    let rows = rows.concat();
    output::calibrations(rows.iter().filter_map(|row| row.calibration.as_ref()));
    output::documents(arguments.format, &of_trials(&trials), &rows, || estimators_tables(&rows))?;
    Ok(Exit::Done)
}
