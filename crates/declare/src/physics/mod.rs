//! The settings of a simulation: integrator, contact solver, steps, and the model of the shafts.

mod inertia;
mod integrator;
#[expect(clippy::module_inception, reason = "one noun a file, and this one is the module's name")]
mod physics;
mod preset;
mod shaft_model;
mod solver;
mod weight;

pub use inertia::{MIN_INERTIA, light_shaft, link_inertia};
pub use integrator::Integrator;
pub use physics::Physics;
pub use preset::Preset;
pub use shaft_model::ShaftModel;
pub use solver::Solver;
pub use weight::{GRAVITY, sag, weight_moment};
