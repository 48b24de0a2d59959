//! The file of a calibration.

use serde::Deserialize;
use vibrissa_runtime::calibration::{
    AngleSurface, Calibration, ContactCurve, DeflectionPolynomial, FreeMotion, MeasuredWhisker, UnsoundCalibration,
};

/// The supported format version.
pub const CALIBRATION_FORMAT: u32 = 2;

/// The keys of a file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    #[serde(rename = "vibrissa_calibration")]
    format: u32,
    about: String,
    hinge_stiffness: Option<f64>,
    measured: Option<MeasuredWhisker>,
    free_motion: Option<FreeMotion>,
    one_channel: Option<ContactCurve>,
    recursive: Option<AngleSurface>,
    polynomial: Option<DeflectionPolynomial>,
}

/// The key that all format versions have.
#[derive(Deserialize)]
struct Heading {
    #[serde(rename = "vibrissa_calibration")]
    format: u32,
}

/// The reason why a calibration cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum CalibrationError {
    /// The text is not a calibration.
    #[error("it is not a calibration: {0}")]
    Syntax(String),
    /// The format version is not supported.
    #[error("it is in format {found}, this program reads format {CALIBRATION_FORMAT}; calibrate with this program")]
    Format {
        /// The format version of the file.
        found: u32,
    },
    /// A value is invalid.
    #[error(transparent)]
    Value(#[from] UnsoundCalibration),
}

/// Reads a calibration from the text of its file.
///
/// # Errors
/// [`CalibrationError`] if the text cannot be read, or if a value is invalid.
pub fn read_calibration(text: &str) -> Result<Calibration, CalibrationError> {
    let read: Document = match serde_yaml::from_str(text) {
        Ok(read) => read,
        // Another format version may have unknown keys.
        Err(error) => match serde_yaml::from_str(text) {
            Ok(Heading { format: found }) if found != CALIBRATION_FORMAT => {
                return Err(CalibrationError::Format { found });
            }
            _ => return Err(CalibrationError::Syntax(error.to_string())),
        },
    };
    let Document { format, about, hinge_stiffness, measured, free_motion, one_channel, recursive, polynomial } = read;
    if format != CALIBRATION_FORMAT {
        return Err(CalibrationError::Format { found: format });
    }
    let calibration = Calibration { about, hinge_stiffness, measured, free_motion, one_channel, recursive, polynomial };
    calibration.check()?;
    Ok(calibration)
}
