//! The physics settings of a simulation.

use super::{Integrator, ShaftModel, Solver};

/// The physics settings of a simulation.
#[derive(Debug, Clone, PartialEq)]
pub struct Physics {
    /// The model of the whiskers' shafts.
    pub shafts: ShaftModel,
    /// Length of a simulation step (s). A sample period contains a whole number of steps.
    pub step: f64,
    /// The integrator.
    pub integrator: Integrator,
    /// The solver for contact forces.
    pub solver: Solver,
    /// Longest step (s) while all whiskers are calm. One such step replaces several regular ones. There are none with
    /// friction.
    pub calm_step: f64,
    /// True if a whisker at rest and out of reach of all solids is treated as a rigid part of the platform.
    pub rigid_in_air: bool,
    /// Time constant of the contact constraint (s).
    pub contact_time: f64,
    /// Impedance of the contact constraint: at the surface, at full depth, and the full depth (m).
    pub contact_impedance: [f64; 3],
    /// Coefficient of sliding friction between whisker and object, 0 without friction.
    pub friction: f64,
    /// Height (m) of all objects, half of it above and half below the plane of the bases. It matters only for whiskers
    /// that [bend out of the plane](ShaftModel::SpatialChain).
    pub object_height: f64,
    /// Permitted penetration depth (m). A deeper contact ends the run, because its simulation cannot be trusted.
    pub penetration_limit: f64,
}

/// The longest steps (s) that suffice with friction, and from [`STRONG_FRICTION`] on, where a tip vibrates at the longer one. A tip
/// then slides steadily, and one that snaps off after sticking penetrates less than the limit.
const FRICTION_STEP: f64 = 1.0 / 1800.0;
const STRONG_FRICTION_STEP: f64 = 1.0 / 3600.0;
const STRONG_FRICTION: f64 = 0.2;
/// Contact time constant (s) with friction.
const FRICTION_CONTACT_TIME: f64 = 1.25e-3;
/// Largest short penetration depth of a tip (m). A tip that stuck snaps off faster than a sliding one.
const FRICTION_PENETRATION_LIMIT: f64 = 3e-3;

impl Physics {
    /// Sets the coefficient of friction. With friction, steps and contacts become as short as they must be for it. A
    /// sample period at `sample_rate` (Hz) contains a whole number of steps.
    pub fn set_friction(&mut self, friction: f64, sample_rate: f64) {
        self.friction = friction;
        if friction > 0.0 {
            let period = sample_rate.recip();
            let longest = if friction < STRONG_FRICTION { FRICTION_STEP } else { STRONG_FRICTION_STEP };
            let steps = (period / self.step.min(longest) - 1e-9).ceil();
            self.step = period / steps;
            self.contact_time = self.contact_time.min(FRICTION_CONTACT_TIME);
            self.penetration_limit = self.penetration_limit.max(FRICTION_PENETRATION_LIMIT);
        }
    }

    /// Shortens the step so that a sample period at `sample_rate` (Hz) contains a whole number of steps.
    pub fn fit_step(&mut self, sample_rate: f64) {
        let period = sample_rate.recip();
        let steps = period / self.step;
        if (steps - steps.round()).abs() > 1e-9 * steps {
            self.step = period / steps.ceil();
        }
    }

    /// Half of the step and of the contact time (s), as advice after a whisker penetrated too deeply. `None` if the step already
    /// suffices for a tip that snaps off: then a shorter one changes little.
    #[must_use]
    pub fn shorter_times(&self) -> Option<[f64; 2]> {
        // A step of a scenario is a rounded fraction of the sample period.
        (self.step > 1.002 * FRICTION_STEP).then_some([0.5 * self.step, 0.5 * self.contact_time])
    }

    /// True if whiskers at rest in the air are rigid. Gravity bends a spatial chain, so it is never rigid.
    #[must_use]
    pub fn has_rigid_whiskers(&self) -> bool {
        self.rigid_in_air && self.shafts != ShaftModel::SpatialChain
    }

    /// The number of steps that a calm step replaces, out of `steps_per_sample`. It is the largest divisor for which
    /// the calm step is not too long. It is 1 with friction, which is stable only in short steps.
    #[must_use]
    pub fn steps_in_calm(&self, steps_per_sample: usize) -> usize {
        // The tolerance for a calm step equals that for a rounded step.
        let fits = |&steps: &usize| {
            steps_per_sample.is_multiple_of(steps) && steps as f64 * self.step < 1.002 * self.calm_step
        };
        if self.friction > 0.0 { 1 } else { (1..=steps_per_sample).rev().find(fits).unwrap_or(1) }
    }
}

impl Default for Physics {
    fn default() -> Self {
        Self {
            shafts: ShaftModel::default(),
            step: 1.0 / 300.0,
            integrator: Integrator::default(),
            solver: Solver::default(),
            calm_step: 1.0 / 300.0,
            rigid_in_air: true,
            contact_time: 1.0 / 300.0,
            contact_impedance: [0.95, 0.99, 1e-4],
            friction: 0.0,
            object_height: 80e-3,
            penetration_limit: 1e-3,
        }
    }
}
