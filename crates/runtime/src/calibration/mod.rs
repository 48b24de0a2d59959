//! The calibration of a whisker: contacts at known positions, and functions fitted to them.

mod angle_surface;
mod calibration;
mod contact_curve;
mod contact_set;
mod least_squares;

pub use angle_surface::AngleSurface;
pub use calibration::{Calibration, UnsoundCalibration};
pub use contact_curve::ContactCurve;
pub use contact_set::ContactSet;
