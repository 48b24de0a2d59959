//! Calibration of a whisker: files of contact sets, contact sets from a simulation, and fits.

mod contact_sets;
mod fit;
mod hinge_fit;
#[cfg(feature = "sim")]
mod stage;

pub use contact_sets::{SetsError, read_sets, write_sets};
pub(crate) use fit::FEWEST_PLACES;
pub use fit::{Fitted, HeldOut, fit};
#[cfg(feature = "sim")]
pub use stage::{StageError, simulated_sets};
