//! Evaluation of contact estimators on the samples of one run.

use std::sync::Arc;

use crate::score::{ErrorFigures, Tip};
use crate::trial::{ExecuteError, Recording, Trial, processor_time};
use vibrissa_runtime::control::BindError;
use vibrissa_runtime::machine::{ContactEstimatorKind, Program, Senses};
use vibrissa_runtime::percept::Perception;
use vibrissa_runtime::rig::{Rig, Sensing};
use vibrissa_runtime::signal::Sample;
use vibrissa_world::scene::{Scene, WorldKind};
use vibrissa_world::world::Sensors;

use super::row::EstimatorRow;

/// Factors of the estimated noise of the real sensor.
const NOISES: [f64; 3] = [0.0, 1.0, 10.0];

/// Runs a policy once in a scene without noise. Then evaluates every contact estimator on the samples of the run, at
/// several levels of noise. The points that the run recorded are evaluated.
///
/// # Errors
/// [`ExecuteError`] if the run cannot begin, or if the rig does not have what an estimator needs.
pub fn evaluate_all(scene: &Scene, program: Arc<Program>, world: WorldKind) -> Result<Vec<EstimatorRow>, ExecuteError> {
    let mut scene = scene.clone();
    scene.rig.sensing.forces = true;
    make_noisy(&mut scene.rig.sensing, 0.0);
    let whiskers = scene.rig.fitted(&program.whiskers, &program.optional).map_err(BindError::from)?;
    let mut trial = Trial::new(scene.clone(), program);
    trial.world = world.into();
    // The ideal sensor shows the error that no estimator can avoid.
    trial.true_tips = true;
    let mut recording = trial.record()?;
    let mut rows = Vec::with_capacity(NOISES.len() * ContactEstimatorKind::ALL.len());
    for factor in NOISES {
        let mut rig = scene.rig.clone();
        make_noisy(&mut rig.sensing, factor);
        let clean = std::mem::take(&mut recording.ticks);
        recording.ticks = noisy(&clean, &rig, scene.seed);
        for kind in ContactEstimatorKind::ALL {
            let kinds = vec![kind; whiskers.len()];
            rows.push(evaluate(&scene, &rig, (&whiskers, &kinds), &recording, factor)?);
        }
        recording.ticks = clean;
    }
    Ok(rows)
}

/// Multiplies the noise and the resolution of the real sensor by a factor.
fn make_noisy(sensing: &mut Sensing, factor: f64) {
    sensing.make_real();
    sensing.angle_noise *= factor;
    sensing.angle_resolution *= factor;
    sensing.force_noise *= factor;
}

/// The samples with the noise of a rig's sensors.
fn noisy(ticks: &[Vec<Sample>], rig: &Rig, seed: u64) -> Vec<Vec<Sample>> {
    let mut sensors = Sensors::new(&rig.sensing, seed);
    let mut ticks = ticks.to_vec();
    for sample in ticks.iter_mut().flatten() {
        for reading in sample.whiskers.iter_mut().take(rig.whiskers.len()) {
            reading.base_angle = sensors.read(reading.base_angle);
            for force in [&mut reading.shear, &mut reading.axial].into_iter().flatten() {
                *force = sensors.read_force(*force);
            }
        }
    }
    ticks
}

/// The figures of contact estimators on a recording. There is one estimator for each of the policy's `whiskers`, given
/// as indices in the rig. Perception assumes `rig`. The row has the name of the first estimator.
pub(in crate::study) fn evaluate(
    scene: &Scene,
    rig: &Rig,
    (whiskers, kinds): (&[Option<usize>], &[ContactEstimatorKind]),
    recording: &Recording,
    noise: f64,
) -> Result<EstimatorRow, ExecuteError> {
    let mut perception = Perception::new(rig, whiskers, kinds).map_err(BindError::from)?;
    let trace = &recording.result.run.trace;
    let (mut tips, mut asked, mut on_shaft, mut seconds) = (Vec::new(), 0_usize, 0_usize, 0.0);
    for (index, (samples, tick)) in recording.ticks.iter().zip(&trace.ticks).enumerate() {
        let start = processor_time();
        perception.update(samples);
        seconds += processor_time() - start;
        // A trace has only the whiskers that the rig has.
        let fitted = whiskers.iter().enumerate().filter_map(|(bound, index)| index.map(|index| (bound, index)));
        for (whisker, (bound, in_rig)) in fitted.enumerate() {
            if tick.whiskers[whisker].tip.is_none() {
                continue;
            }
            asked += 1;
            perception.record(bound);
            let Some(tip_world) = perception.recorded_tip(bound) else { continue };
            let length = rig.whiskers[in_rig].shaft.length;
            on_shaft += usize::from(perception.contact(bound).is_some_and(|touch| touch.contact_length < length));
            let error = scene.truth.surfaces.nearest(tip_world).distance;
            let standard_deviation = perception.recorded_deviation(bound);
            tips.push(Tip { tick: index, whisker, tip_world, error, standard_deviation, offset: None });
        }
    }
    let figures = ErrorFigures::of(&tips);
    let share = |count: usize, of: usize| if of > 0 { count as f64 / of as f64 } else { 0.0 };
    Ok(EstimatorRow {
        scenario: scene.name.clone(),
        calibration: None,
        noise,
        model: kinds.first().map_or("none", |kind| kind.name()),
        reported: share(tips.len(), asked),
        mean_mm: figures.map(|figures| 1e3 * figures.mean),
        p95_mm: figures.map(|figures| 1e3 * figures.p95),
        within_band: figures.map(|figures| figures.interval_coverage),
        outliers: figures.map(|figures| figures.outliers),
        tips: tips.len(),
        on_shaft: share(on_shaft, tips.len()),
        tick_us: 1e6 * seconds / trace.ticks.len().max(1) as f64,
    })
}
