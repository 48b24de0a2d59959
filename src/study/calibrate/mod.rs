//! Calibration of a whisker: sets from a simulated stage, fits, and how well they hold.

mod fit;
mod hinge_fit;
#[cfg(feature = "sim")]
mod stage;

pub use fit::{FEWEST_PLACES, Fitted, HeldOut, fit, held_out_table};
#[cfg(feature = "sim")]
pub use stage::{StageError, simulated_sets};
