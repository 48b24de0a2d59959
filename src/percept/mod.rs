//! From samples to what policies ask for: filtered deflections, places of tips, the contour behind a tip.

mod chain;
mod contour_spline;
mod low_pass;
mod perception;
mod tip_model;
mod whisker;

pub use chain::{Equilibrium, ShaftChain};
pub use contour_spline::ContourSpline;
pub use low_pass::{CutoffError, LowPass};
pub use perception::{BindError, Perception};
pub use tip_model::{TipModel, TipModelError};
