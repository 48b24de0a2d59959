//! One scene under one policy in several simulations.

use std::sync::Arc;

use super::row::{Differences, WorldsRow};
use super::simulation::Simulation;
use super::track::{Instant, Track};
use crate::results::policy_label;

use crate::score::Estimate;
use crate::trial::{ExecuteError, Trial, TrialResult};
use vibrissa_runtime::machine::Program;
use vibrissa_world::scene::Scene;

/// Runs a policy in a scene in a simulation, the `reference`, and compares other simulations with it.
///
/// Tips and moments: in every simulation, also in the reference, the whiskers are moved along the poses of the
/// reference's run. Thus all simulations have the same input, which two closed loops do not. A tick of a whisker counts
/// if the whisker touches in both simulations and vibrates in neither. It does not vibrate if all readings of the tick
/// exceed the contact threshold and differ by less than the threshold.
///
/// Contours: the policy runs in every simulation. The figure is the mean distance of its tips from the contour that the
/// reference's run estimated. Perception assumes the whiskers of the scene in all simulations.
///
/// # Errors
/// [`ExecuteError`] if a run cannot begin.
pub fn compare_worlds(
    scene: &Scene,
    program: &Arc<Program>,
    reference: &Simulation,
    others: &[Simulation],
) -> Result<Vec<WorldsRow>, ExecuteError> {
    let reference_run = run(scene, program, reference)?.run;
    let contour = Estimate::new(&reference_run.trace);
    let of_reference = Track::along(&reference_run.trace, scene, reference)?;
    let mut rows = Vec::with_capacity(others.len());
    for simulation in others {
        let result = run(scene, program, simulation)?;
        let own = &result.run;
        let track = Track::along(&reference_run.trace, scene, simulation)?;
        let (pairs, touching) = pairs(&of_reference, &track, scene.rig.sensing.contact_threshold);
        let of = |distance: fn(&(Instant, Instant)) -> f64| Differences::of(pairs.iter().map(distance).collect());
        let bending: f64 = pairs.iter().map(|(reference, _)| reference.moment.abs()).sum();
        let moment = of(|(reference, other)| 1e6 * (other.moment - reference.moment).abs());
        rows.push(WorldsRow {
            scenario: scene.name.clone(),
            policy: policy_label(program),
            simulation: simulation.name,
            reference: reference.name,
            outcome: result.ending(),
            reason: own.reason.clone(),
            along_s: reference_run.trace.period * track.ticks.len().min(of_reference.ticks.len()) as f64,
            stopped: track.fault.or_else(|| of_reference.fault.clone()),
            compared: pairs.len(),
            left_out: if touching > 0 { 1.0 - pairs.len() as f64 / touching as f64 } else { 0.0 },
            tip_mm: of(|(reference, other)| 1e3 * (other.tip - reference.tip).norm()),
            moment_share: moment.map(|moment| 1e-6 * moment.mean * pairs.len() as f64 / bending),
            moment_un_m: moment,
            contour_mm: Estimate::new(&own.trace).mean_distance(&contour).map(|distance| 1e3 * distance),
        });
    }
    Ok(rows)
}

/// The run of a policy in a simulation. Control assumes the rig of the scene.
fn run(scene: &Scene, program: &Arc<Program>, simulation: &Simulation) -> Result<TrialResult, ExecuteError> {
    let mut trial = Trial::new(simulation.scene(scene), Arc::clone(program));
    trial.assumed_rig = scene.rig.clone();
    trial.world = simulation.world.into();
    trial.run()
}

/// The pairs of instants of the same whisker in the same tick that are compared. Also the number of ticks in which the
/// whisker touches in either simulation.
fn pairs(reference: &Track, other: &Track, threshold: f64) -> (Vec<(Instant, Instant)>, usize) {
    let whiskers = reference.ticks.iter().zip(&other.ticks).flat_map(|(one, two)| one.iter().zip(two));
    let touching = whiskers.filter(|(one, two)| one.least.max(two.least) > threshold);
    let (mut pairs, mut count) = (Vec::new(), 0);
    for (&one, &two) in touching {
        count += 1;
        if one.least.min(two.least) > threshold && one.range.max(two.range) <= threshold {
            pairs.push((one, two));
        }
    }
    (pairs, count)
}
