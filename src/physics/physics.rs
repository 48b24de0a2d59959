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
    /// Longest step (s) while all whiskers are calm. Without friction, one such step replaces several regular ones.
    pub calm_step: f64,
    /// True if a whisker at rest and out of reach of all solids is treated as a rigid part of the platform.
    pub rigid_in_air: bool,
    /// Time constant of the contact constraint (s).
    pub contact_time: f64,
    /// Impedance of the contact constraint: at the surface, at full depth, and the full depth (m).
    pub contact_impedance: [f64; 3],
    /// Coefficient of sliding friction between whisker and object, 0 without friction.
    pub friction: f64,
    /// Permitted penetration depth (m). A deeper contact ends the run, because its simulation cannot be trusted.
    pub penetration_limit: f64,
}

impl Physics {
    /// Shortens the step so that a sample period at `sample_rate` (Hz) contains a whole number of steps.
    pub(crate) fn fit_step(&mut self, sample_rate: f64) {
        let period = sample_rate.recip();
        let steps = period / self.step;
        if (steps - steps.round()).abs() > 1e-9 * steps {
            self.step = period / steps.ceil();
        }
    }

    /// The number of steps that a calm step replaces, out of `steps_per_sample`. It is the largest divisor for which
    /// the calm step is not too long. It is 1 with friction, which is stable only in short steps.
    #[must_use]
    pub(crate) fn steps_in_calm(&self, steps_per_sample: usize) -> usize {
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
            penetration_limit: 1e-3,
        }
    }
}
