//! What has been measured of a whisker: touches in known places, what is fitted to them, and the file that holds it.

mod angle_surface;
mod contact_curve;
mod contact_set;
mod file;
mod least_squares;

pub use angle_surface::AngleSurface;
pub use contact_curve::ContactCurve;
pub use contact_set::{ContactSet, SetsError};
pub use file::{Calibration, CalibrationError};
