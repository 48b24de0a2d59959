//! Runs under all settings, with their run times.

use std::sync::Arc;

use vibrissa_runtime::control::BindError;
use vibrissa_runtime::machine::{ContactEstimatorKind, Program};
use vibrissa_runtime::percept::Perception;

use super::row::{Front, ParetoRow};
use super::setting::{FINE_LINKS, Setting, set_links};
use super::{Pareto, front};
use crate::results::{Ending, MismatchIdentity, policy_label};
use crate::score::{Estimate, Statistics};
use crate::study::estimators::evaluate;
use crate::trial::{ExecuteError, Trial, TrialResult, processor_time};
use vibrissa_world::geometry::unit;
use vibrissa_world::scene::{Scene, WorldKind};

/// Distance behind the scene's start at which the second fine run begins (m).
const START_OFFSET: f64 = 1e-3;

/// Runs a policy in a scene `repeats` times under each of `settings`, one run at a time. The first setting is the
/// default. Each round has every setting once, so that disturbances of the machine affect all of them. These runs have no
/// mismatch and no calibration. At the end, every setting runs once more in the scene `wrong`, for its error with a wrong model of the
/// array. That scene has a mismatch, and possibly the calibration of its array.
/// `progress` receives the setting of every run that is done.
///
/// In all settings perception assumes as many links as in the fine run. Otherwise an estimator that assumes a coarse
/// chain would compensate for its error. Another contact estimator receives the samples of a run under the policy's
/// own. Therefore its error does not affect the path of the run.
///
/// # Errors
/// [`ExecuteError`] if the first setting cannot run. Any other setting that cannot run counts as refused.
pub fn measure(
    scene: &Scene,
    wrong: &Scene,
    program: &Arc<Program>,
    world: WorldKind,
    settings: &[Setting],
    repeats: usize,
    mut progress: impl FnMut(&Setting),
) -> Result<Pareto, ExecuteError> {
    let scene = Scene { mismatch: None, ..scene.clone() };
    let mut firsts: Vec<Measured> = Vec::with_capacity(settings.len());
    let mut rounds: Vec<Vec<f64>> = Vec::with_capacity(repeats);
    for round in 0..repeats {
        let mut seconds = Vec::with_capacity(settings.len());
        for setting in settings {
            let measured = match timed(&scene, program, world, setting) {
                Err(cause) if seconds.is_empty() => return Err(cause),
                measured => measured.unwrap_or_else(|cause| Measured::refused(&cause)),
            };
            seconds.push(measured.seconds);
            if round == 0 {
                firsts.push(measured);
            }
            progress(setting);
        }
        rounds.push(seconds);
    }
    let fine = settings.iter().position(|setting| *setting == Setting::fine());
    let fine = fine.and_then(|index| firsts[index].estimate.clone());
    let mut displaced = scene.clone();
    displaced.start.position -= START_OFFSET * unit(scene.start.heading);
    let floor_mm =
        fine.as_ref().and_then(|fine| timed(&displaced, program, world, &Setting::fine()).ok()?.mean_distance(fine));
    let mut rows = Vec::with_capacity(settings.len());
    for (index, (setting, first)) in settings.iter().zip(&firsts).enumerate() {
        let seconds = |round: &Vec<f64>| round[index];
        let ratios = Statistics::of(rounds.iter().map(|round| seconds(round) / round[0]).collect());
        let seconds = Statistics::of(rounds.iter().map(seconds).collect());
        let figures = ratios.zip(seconds).filter(|_| first.ending != Ending::Refused);
        let mismatched = timed(wrong, program, world, setting).unwrap_or_else(|cause| Measured::refused(&cause));
        progress(setting);
        let (scene, world) = setting.apply(&scene, world);
        let fine_mm = fine.as_ref().and_then(|fine| first.mean_distance(fine));
        rows.push(ParetoRow::new(setting, (&scene, world), (first, &mismatched), figures, fine_mm));
    }
    mark(&mut rows);
    Ok(Pareto {
        scenario: scene.name.clone(),
        policy: policy_label(program),
        repeats,
        mismatch: wrong.mismatch.as_ref().map(MismatchIdentity::from).unwrap_or_default(),
        calibration: Trial::new(wrong.clone(), Arc::clone(program)).calibration(),
        contact_estimators: program.contact_estimators.iter().map(|kind| kind.name()).collect(),
        floor_mm,
        settings: rows,
    })
}

/// The kept part of a run's result.
pub(super) struct Measured {
    pub(super) ending: Ending,
    pub(super) reason: Option<String>,
    pub(super) sim_s: f64,
    pub(super) error_mm: Option<f64>,
    pub(super) coverage: Option<f64>,
    /// The estimated contour. `None` if the estimator is not that of the run.
    estimate: Option<Estimate>,
    seconds: f64,
}

impl Measured {
    fn new(result: &TrialResult, seconds: f64) -> Self {
        let TrialResult { run, score, .. } = result;
        Self {
            ending: result.ending(),
            reason: run.reason.clone(),
            sim_s: run.trace.ticks.last().map_or(0.0, |tick| tick.time),
            error_mm: score.error.map(|error| 1e3 * error.mean),
            coverage: Some(score.coverage),
            estimate: Some(Estimate::new(&run.trace)),
            seconds,
        }
    }

    fn refused(cause: &ExecuteError) -> Self {
        let (ending, reason) = (Ending::Refused, Some(cause.to_string()));
        Self { ending, reason, sim_s: 0.0, error_mm: None, coverage: None, estimate: None, seconds: f64::NAN }
    }

    /// The mean distance (mm) of its tips from the contour that another run estimated.
    fn mean_distance(&self, other: &Estimate) -> Option<f64> {
        Some(1e3 * self.estimate.as_ref()?.mean_distance(other)?)
    }
}

/// A run under a setting, with the processor time (s) of building the world and of the loop.
fn timed(scene: &Scene, program: &Arc<Program>, world: WorldKind, setting: &Setting) -> Result<Measured, ExecuteError> {
    let (scene, world) = setting.apply(scene, world);
    let mut trial = Trial::new(scene, Arc::clone(program));
    trial.world = world.into();
    set_links(&mut trial.assumed_rig, FINE_LINKS);
    if let Some(kind) = setting.contact_estimator() {
        return re_estimated(&trial, kind);
    }
    Perception::prepare(&trial.assumed_rig, &program.contact_estimators);
    let start = processor_time();
    let result = trial.run()?;
    let seconds = processor_time() - start;
    Ok(Measured::new(&result, seconds))
}

/// A run under the policy's own contact estimator, whose samples are given to an estimator of another `kind`. The time
/// is that of the run with the other perception.
fn re_estimated(trial: &Trial, kind: ContactEstimatorKind) -> Result<Measured, ExecuteError> {
    let Trial { scene, assumed_rig, program, .. } = trial;
    let whiskers = scene.rig.fitted(&program.whiskers, &program.optional).map_err(BindError::from)?;
    let start = processor_time();
    let recording = trial.record()?;
    let seconds = processor_time() - start;
    let kinds = vec![kind; whiskers.len()];
    let own = evaluate(scene, assumed_rig, (&whiskers, &program.contact_estimators), &recording, 0.0)?;
    let other = evaluate(scene, assumed_rig, (&whiskers, &kinds), &recording, 0.0)?;
    let more = 1e-6 * (other.tick_us - own.tick_us) * recording.result.run.trace.ticks.len() as f64;
    let run = Measured::new(&recording.result, seconds + more);
    Ok(Measured { error_mm: other.mean_mm, coverage: None, estimate: None, ..run })
}

/// Marks the Pareto-optimal rows, among all settings and among those of the same world.
fn mark(rows: &mut [ParetoRow]) {
    let fronts = |world: Option<&str>| {
        let counts = |row: &&ParetoRow| row.met_its_stop() && world.is_none_or(|world| row.world == world);
        let counted = || rows.iter().map(|row| Some(row).filter(counts));
        let of = |error: fn(&ParetoRow) -> Option<f64>| {
            let point = |row: Option<&ParetoRow>| Some([row?.relative_time?, error(row?)?]);
            front(&counted().map(point).collect::<Vec<_>>())
        };
        let [exact, fine, mismatched] =
            [of(|row| row.error_mm), of(|row| row.fine_mm), of(ParetoRow::usable_mismatched_mm)];
        let point = |row: Option<&ParetoRow>| Some([row?.relative_time?, row?.error_mm?, row?.usable_mismatched_mm()?]);
        let together = front(&counted().map(point).collect::<Vec<_>>());
        let front = |index| Front {
            exact: exact[index],
            fine: fine[index],
            mismatched: mismatched[index],
            together: together[index],
        };
        (0..rows.len()).map(front).collect::<Vec<_>>()
    };
    let of_all = fronts(None);
    let of_worlds = WorldKind::ALL.map(|world| fronts(Some(world.name())));
    for (index, row) in rows.iter_mut().enumerate() {
        row.on_front = of_all[index];
        row.on_front_of_world = of_worlds.iter().fold(Front::default(), |on, fronts| on.or(fronts[index]));
    }
}
