//! From samples to what policies ask for: filtered deflections, places of tips, the contour behind a tip.

mod deflection;
mod local_contour;
mod low_pass;
mod perception;
mod tip_model;
mod whisker;

pub use local_contour::LocalContour;
pub use low_pass::{CutoffError, LowPass};
pub use perception::{Perception, PerceptionError};
pub use tip_model::{TipModel, TipModelError};
