//! Measurement of all axes.

use std::path::Path;

use vibrissa_text::file::TemporaryFolder;
use vibrissa_world::scene::WorldKind;

use super::axis::{Axis, CORES, RESULT_LINES};
use super::case::{self, Case, processor};
use super::error::ScaleError;
use super::exponent::exponent;
use super::job::job;
use super::result_lines::{line, sweep, sweep_text};
use super::row::{Scale, ScaleRow, SizeTime};
use super::sweep_cost::{RUNS, SweepCost, UnitCosts};
use crate::score::Statistics;
use crate::trial::processors;

/// Measures the cost of every size of the axes, and that of a large sweep. `program` is this program, of which a job of a
/// sweep is a process. Every round has every size once, so that disturbances of the machine affect all of them. `progress`
/// receives what has been measured, as often as [`steps`] says.
///
/// # Errors
/// [`ScaleError`] if a run cannot begin, a temporary file cannot be used, or a job fails.
pub fn measure(
    axes: &[Axis],
    program: &Path,
    repeats: usize,
    mut progress: impl FnMut(&str),
) -> Result<Scale, ScaleError> {
    let folder = TemporaryFolder::new().map_err(ScaleError::file(std::env::temp_dir()))?;
    let mut cases = Vec::new();
    for axis in axes {
        for &size in &axis.sizes {
            cases.push(Measured::of(axis.title(), axis.case(size, folder.path())?));
        }
    }
    let mut sweeps = Vec::new();
    for world in simulators() {
        let round = case::round(world)?;
        let trial = round.trial()?;
        let result = trial.document(&trial.run()?);
        let sweep = sweep(&sweep_text("scale.yaml", "thesis.fsm", RUNS))?;
        // The last run has the longest key.
        let last =
            sweep.run(RUNS as u64 - 1).ok_or_else(|| ScaleError::Text("the sweep has too few runs".to_owned()))?;
        sweeps.push((world, line(&last, &result)?.len() + 1));
        let title = format!("sweep, {world}");
        cases.push(Measured::of(
            title.clone(),
            processor(move || {
                let trial = round.trial()?;
                serde_json::to_string(&trial.document(&trial.run()?))
                    .map(drop)
                    .map_err(|cause| ScaleError::Text(cause.to_string()))
            }),
        ));
        cases.push(Measured::of(title, job(folder.path(), program, world)?));
    }
    for _ in 0..repeats {
        for case in &mut cases {
            case.times.push((case.work)()?);
            progress(&case.title);
        }
    }
    let mut medians = cases.into_iter().map(Measured::median);
    let rows: Vec<ScaleRow> = axes.iter().map(|axis| row(axis, &mut medians)).collect();
    let mut costs = Vec::with_capacity(sweeps.len());
    for (world, line) in sweeps {
        let [run, job] = [medians.next(), medians.next()].map(Option::unwrap_or_default);
        let costs_of_one = UnitCosts { run, line, job, merge: merge(&rows)?, speedup: speedup(&rows)? };
        costs.push(SweepCost::new(world.to_string(), &costs_of_one));
    }
    Ok(Scale { repeats, processors: processors().get(), axes: rows, sweeps: costs })
}

/// The number of steps of [`measure`].
#[must_use]
pub fn steps(axes: &[Axis], repeats: usize) -> usize {
    // A run and a job of a sweep in each simulator.
    repeats * (axes.iter().map(|axis| axis.sizes.len()).sum::<usize>() + 2 * simulators().count())
}

fn simulators() -> impl Iterator<Item = WorldKind> {
    WorldKind::ALL.into_iter().filter(|kind| *kind != WorldKind::Mujoco || cfg!(feature = "sim"))
}

/// A case with its times (s).
struct Measured {
    title: String,
    work: Case,
    times: Vec<f64>,
}

impl Measured {
    fn of(title: String, work: Case) -> Self {
        Self { title, work, times: Vec::new() }
    }

    fn median(self) -> f64 {
        Statistics::of(self.times).map_or(f64::NAN, |times| times.percentile(50.0))
    }
}

/// The row of an axis, with the next of the times (s).
fn row(axis: &Axis, times: &mut impl Iterator<Item = f64>) -> ScaleRow {
    let times: Vec<_> = axis.sizes.iter().zip(times).map(|(&size, time_s)| SizeTime { size, time_s }).collect();
    ScaleRow {
        axis: axis.name.to_owned(),
        simulator: axis.simulator.map(|simulator| simulator.to_string()),
        unit: axis.unit.to_owned(),
        work: axis.work.clone(),
        exponent: exponent(&times),
        times,
    }
}

/// The first and the last time on the axis with this name.
fn ends(rows: &[ScaleRow], name: &str) -> Result<[SizeTime; 2], ScaleError> {
    let row = rows.iter().find(|row| row.axis == name);
    let ends = row.and_then(|row| Some([*row.times.first()?, *row.times.last()?]));
    ends.ok_or_else(|| ScaleError::Text(format!("there is no axis of {name}")))
}

/// Ratio of the time of runs on one processor to that on all.
fn speedup(rows: &[ScaleRow]) -> Result<f64, ScaleError> {
    ends(rows, CORES).map(|[one, all]| one.time_s / all.time_s)
}

/// Processor time of the merge of one line (s).
fn merge(rows: &[ScaleRow]) -> Result<f64, ScaleError> {
    ends(rows, RESULT_LINES).map(|[_, most]| most.time_s / most.size as f64)
}
