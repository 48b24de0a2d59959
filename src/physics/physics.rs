//! How the simulator steps and resolves contact.

use super::{Integrator, ShaftModel, Solver};

/// How the simulator steps and resolves contact.
#[derive(Debug, Clone, PartialEq)]
pub struct Physics {
    /// What a whisker's shaft is made of.
    pub shafts: ShaftModel,
    /// Length of one simulation step (s); a whole number of them makes up a sample.
    pub step: f64,
    /// How it goes from step to step.
    pub integrator: Integrator,
    /// How it finds the forces of contacts.
    pub solver: Solver,
    /// Longest step (s) while all whiskers are calm: several steps are then taken in one, if there is no friction.
    pub calm_step: f64,
    /// Whether a whisker that hangs at rest, out of reach of everything, is a rigid part of the platform until it comes nearer.
    pub rigid_in_air: bool,
    /// Time constant of the contact constraint (s).
    pub contact_time: f64,
    /// Impedance of the contact constraint: at the surface, at full depth, and the depth at which it is full (m).
    pub contact_impedance: [f64; 3],
    /// Coefficient of sliding friction between whisker and object; 0 is frictionless.
    pub friction: f64,
    /// A contact deeper than this (m) ends the run: the physics can no longer be trusted.
    pub penetration_limit: f64,
}

impl Physics {
    /// How many of so many steps a sample are taken in one while all whiskers are calm: the most that make up the sample and no longer
    /// step than may be; one where there is friction, which is steady only in short steps.
    #[must_use]
    pub fn steps_in_calm(&self, steps_per_sample: usize) -> usize {
        // A calm step may be as much longer as a rounded step may.
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
