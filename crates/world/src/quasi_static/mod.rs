//! The quasi-static simulator: whiskers in static equilibrium at every sample, with exact outlines.

mod active_set;
mod base_path;
mod bordered_tridiagonal;
mod broad_phase;
mod contact;
mod decisions;
mod equilibrium;
mod first_order_lag;
mod footprint;
mod friction;
mod platform_dynamics;
mod rod;
mod surface;
mod whisker;
mod world;

pub use decisions::decisions;
pub use world::{QuasiStaticError, QuasiStaticWorld};
