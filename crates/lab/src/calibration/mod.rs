//! Calibration of a whisker: files of contact sets, contact sets from a simulation, and fits.

mod array_calibration;
mod array_calibrations;
mod array_pilot;
mod columns;
mod contact_sets;
mod count_set;
mod creep;
mod fit;
mod hinge_fit;
mod next_touch;
mod pluck;
#[cfg(feature = "sim")]
mod simulated_rig;
mod sway;
mod timed_readings;
mod touch_file;
mod touch_procedure;
mod undetermined;
mod whisker_touches;

pub use array_calibration::{ArrayCalibration, ArrayCalibrationError};
pub use array_calibrations::ArrayCalibrations;
pub use contact_sets::{SetsError, read_count_sets, read_sets, write_sets};
pub use count_set::CountSet;
#[cfg(feature = "robot")]
pub use count_set::fit_field;
pub use creep::{Pressed, damping};
pub use fit::{Fitted, HeldOut, MIN_POSITIONS, fit};
pub use next_touch::{MissedTouch, NextTouch};
pub use pluck::{Pluck, PluckError};
#[cfg(feature = "sim")]
pub use simulated_rig::{CalibrationRigError, simulated_sets};
pub use timed_readings::read_timed_readings;
pub use touch_file::{TouchFile, read_touch_file, read_touches, write_touch_file, write_touches};
pub use touch_procedure::{Pin, TouchLimits, start_beside_pin, touch_pin};
pub use undetermined::undetermined;
pub use whisker_touches::{RefusedWhisker, WhiskerTouches};
