//! Implements an own contact estimator, and evaluates it beside a built-in one on the samples of one run.
//!
//!     cargo run --no-default-features --example contact_estimator
//!
//! The run uses the built-in policy. Both estimators receive the same samples, and are compared at those ticks in which
//! the policy recorded a tip. The errors are distances from the exact contour.
#![allow(clippy::print_stdout, reason = "an example prints")]

use std::error::Error;
use std::sync::Arc;

use vibrissa::built_in::{DEFAULT_POLICY, SCENARIOS, TextFile};
use vibrissa::diagnostic::{Colour, Diagnostic, Source, terminal};
use vibrissa::scene::{Scene, WorldKind};
use vibrissa::score::{ErrorFigures, Tip};
use vibrissa::trial::{Recording, Trial};
use vibrissa::{policy, scenario};
use vibrissa_runtime::geometry::{Matrix2, Pose, Vector2};
use vibrissa_runtime::machine::{ContactEstimatorKind, Senses};
use vibrissa_runtime::math;
use vibrissa_runtime::percept::{Contact, ContactEstimator, Perception};
use vibrissa_runtime::rig::Whisker;

/// Estimates the tip of a cantilever from its base angle. The bending moment falls linearly from the base to the tip.
#[derive(Debug, Clone)]
struct Cantilever {
    /// Length of the shaft (m).
    length: f64,
    /// Tip deflection per base angle (m/rad).
    compliance: f64,
}

impl Cantilever {
    /// A base moment `M` deflects the tip of a cantilever by `M L² / (3 E I)`.
    fn new(whisker: &Whisker) -> Self {
        let length = whisker.shaft.length;
        let compliance = whisker.hinge.stiffness * math::square(length) / (3.0 * whisker.shaft.tip_stiffness());
        Self { length, compliance }
    }
}

impl ContactEstimator for Cantilever {
    fn contact(&mut self, base_angle: f64, base: Pose) -> Option<Contact> {
        let deflection = self.compliance * base_angle;
        // The linear theory holds for small deflections. An estimator gives no contact outside of its range.
        if deflection.abs() > 0.5 * self.length {
            return None;
        }
        // The bent shaft is shorter along its undeflected direction, by 3 d² / (5 L).
        let along = self.length - 0.6 * math::square(deflection) / self.length;
        // The standard deviation includes the errors of the model: here a tenth of the deflection.
        let deviation = 0.1 * deflection;
        let covariance = Matrix2::new(0.0, 0.0, 0.0, math::square(deviation));
        Some(Contact::by_tip(Vector2::new(along, deflection), &covariance, self.length, base))
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let scene = scenario::read(&source(SCENARIOS[0])).map_err(|errors| shown(SCENARIOS[0], &errors))?;
    let program = policy::compile(&source(DEFAULT_POLICY)).map_err(|errors| shown(DEFAULT_POLICY, &errors))?;
    // The index of each of the policy's whiskers in the rig.
    let whiskers = scene.rig.fitted(&program.whiskers, &program.optional)?;

    let mut trial = Trial::new(scene, Arc::new(program));
    trial.world = WorldKind::QuasiStatic.into();
    let recording = trial.record()?;

    let kinds = vec![ContactEstimatorKind::OneChannel; whiskers.len()];
    let built_in = Perception::new(&trial.scene.rig, &whiskers, &kinds)?;
    let mut own = built_in.clone();
    for (bound, in_rig) in built_in.fitted() {
        own.set_contact_estimator(bound, Box::new(Cantilever::new(&trial.scene.rig.whiskers[in_rig])));
    }
    for (name, perception) in [("one_channel", built_in), ("cantilever", own)] {
        let figures = evaluate(perception, &recording, &trial.scene).ok_or("the policy recorded no tip")?;
        println!(
            "{name:12} mean error {:.2} mm, 95th percentile {:.2} mm, {:.0} % within the 95 % interval, {} tips",
            1e3 * figures.mean,
            1e3 * figures.p95,
            100.0 * figures.interval_coverage,
            figures.count,
        );
    }
    Ok(())
}

/// The errors of a perception on the samples of a recording.
fn evaluate(mut perception: Perception, recording: &Recording, scene: &Scene) -> Option<ErrorFigures> {
    let mut tips = Vec::new();
    for (tick, (samples, record)) in recording.ticks.iter().zip(&recording.result.run.trace.ticks).enumerate() {
        perception.update(samples);
        // The trace has those whiskers that the rig has, in the order of the policy.
        let fitted: Vec<_> = perception.fitted().collect();
        for (whisker, (bound, _)) in fitted.into_iter().enumerate() {
            if record.whiskers[whisker].tip.is_none() {
                continue;
            }
            perception.record(bound);
            let Some(tip_world) = perception.recorded_tip(bound) else { continue };
            tips.push(Tip {
                tick,
                whisker,
                tip_world,
                error: scene.truth.surfaces.distance(tip_world),
                standard_deviation: perception.recorded_deviation(bound),
                offset: None,
            });
        }
    }
    ErrorFigures::of(&tips)
}

fn source(file: TextFile) -> Source {
    Source::new(file.path, file.text)
}

/// The errors of a text, as the commands print them.
fn shown(file: TextFile, errors: &[Diagnostic]) -> String {
    terminal(&source(file), errors, Colour::Plain)
}
