//! How the simulator steps and resolves contact.

use super::{Integrator, Solver};

/// How the simulator steps and resolves contact.
#[derive(Debug, Clone, PartialEq)]
pub struct Physics {
    /// Length of one simulation step (s); a whole number of them makes up a sample.
    pub step: f64,
    /// How it goes from step to step.
    pub integrator: Integrator,
    /// How it finds the forces of contacts.
    pub solver: Solver,
    /// Time constant of the contact constraint (s).
    pub contact_time: f64,
    /// Impedance of the contact constraint: at the surface, at full depth, and the depth at which it is full (m).
    pub contact_impedance: [f64; 3],
    /// Coefficient of sliding friction between whisker and object; 0 is frictionless.
    pub friction: f64,
    /// A contact deeper than this (m) ends the run: the physics can no longer be trusted.
    pub penetration_limit: f64,
}

impl Default for Physics {
    fn default() -> Self {
        Self {
            step: 1.0 / 300.0,
            integrator: Integrator::default(),
            solver: Solver::default(),
            contact_time: 0.005,
            contact_impedance: [0.98, 0.99, 1e-4],
            friction: 0.0,
            penetration_limit: 1e-3,
        }
    }
}
