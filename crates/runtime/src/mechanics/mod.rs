//! The statics of a whisker: its shaft as the exact elastica and as a chain of links, and the contact position from the
//! readings at its base.

mod chain;
mod continuation;
mod elastica;
mod extrapolation;
mod frictionless_contact;
mod locate;
mod newton;
mod obstacle;
mod pivot;
mod shaft_shape;
mod shot;
mod stability;
mod touch;

pub use chain::EquilibriumProblem;
pub use chain::{Equilibrium, ShaftChain};
pub use elastica::Elastica;
pub use locate::LocateError;
pub use obstacle::Obstacle;
pub use pivot::Pivot;
pub use shaft_shape::ShaftShape;
pub use stability::out_of_plane_margin;
pub use touch::{Touch, TouchMechanics};
