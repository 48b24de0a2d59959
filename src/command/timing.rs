//! `vibrissa study timing`

use clap::Args;

use super::bench::{BenchTrials, bench_trials};
use super::exit::Exit;
use super::failure::Failure;
use super::options::Format;
use super::output;
use super::progress::Progress;
use super::provenance::of_trials;
use super::trials::{calibrated, say_calibrations};
use super::values::parse_repeats;
use vibrissa_lab::report::timing_table;
use vibrissa_lab::study::timing::{Timing, TimingRow};
use vibrissa_text::file::CommandFiles;

const EXAMPLE: &str = "Example:\n  vibrissa study timing --repeats 5\n\nExit status: 0 all runs completed; 1 otherwise; 2 unusable input; 3 internal error; 130 interrupted.";

/// The arguments of `vibrissa study timing`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct TimingArguments {
    #[command(flatten)]
    trials: BenchTrials,
    /// Number of runs of every scene, from 1 to 1000. The figures are medians
    #[arg(long, value_name = "N", default_value = "5", allow_negative_numbers = true, value_parser = parse_repeats)]
    repeats: usize,
    #[command(flatten)]
    format: Format,
}

/// Runs every trial several times, one at a time. Each round has every trial once, so that disturbances of the machine affect all of them.
pub(super) fn timing(arguments: &TimingArguments) -> Result<Exit, Failure> {
    let (mut trials, array) = bench_trials(&arguments.trials, &mut CommandFiles::new())?;
    for (_, trial) in &mut trials {
        *trial = calibrated(trial, &array)?;
    }
    say_calibrations(trials.iter().map(|(_, trial)| trial));
    let mut progress = Progress::new(trials.len() * arguments.repeats);
    let mut times: Vec<Vec<Timing>> = vec![Vec::with_capacity(arguments.repeats); trials.len()];
    for _ in 0..arguments.repeats {
        for ((_, trial), times) in trials.iter().zip(&mut times) {
            progress.doing(&trial.scene.name);
            times.push(Timing::take(trial).map_err(Failure::execute(trial))?);
            progress.done(&trial.scene.name);
        }
    }
    progress.finish();
    let rows: Vec<TimingRow> = trials
        .iter()
        .zip(&times)
        .filter_map(|((conditions, trial), times)| {
            let (scene, policy) = (conditions.named(&trial.scene.name), trial.policy_label());
            TimingRow::new(scene, policy, trial.world.kind.to_string(), times)
        })
        .collect();
    output::documents(arguments.format, &of_trials(trials.iter().map(|(_, trial)| trial)), &rows, || {
        [timing_table(&rows)]
    })?;
    Ok(if rows.iter().all(|row| row.outcome.met_its_stop()) { Exit::Done } else { Exit::Unexpected })
}
