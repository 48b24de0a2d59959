//! From samples to what policies ask for: filtered deflections, places of tips, the contour behind a tip.

mod base_angle;
mod deflection;
mod disturbance;
mod local_contour;
mod low_pass;
mod moment_and_shear;
mod one_channel;
mod perception;
mod recent_line;
mod recursive;
mod shaft_rest;
mod sliding;
mod tip_curve;
mod tip_model;
mod tip_table;
mod whisker;

pub use local_contour::LocalContour;
pub use low_pass::{CutoffError, LowPass};
pub use perception::{Perception, PerceptionError};
pub use tip_curve::{TipCurve, TipModelError};
pub use tip_model::{TipModel, Touch};
pub use tip_table::{TipPlace, TipTable};
