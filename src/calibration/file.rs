//! A calibration, and its file.

use std::fmt::Write;

use serde::Deserialize;

use super::angle_surface::AngleSurface;
use super::contact_curve::ContactCurve;

/// What perception is told of a whisker beyond its rig. What is left out, it takes from the mechanics.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Calibration {
    /// The format of the file.
    #[serde(rename = "vibrissa_calibration")]
    format: u32,
    /// What was measured, for people.
    pub about: String,
    /// Stiffness of the base hinge (N m/rad).
    pub hinge_stiffness: Option<f64>,
    /// What `one_channel` places tips by.
    pub one_channel: Option<ContactCurve>,
    /// What `recursive` places tips by.
    pub recursive: Option<AngleSurface>,
}

/// Why a calibration cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum CalibrationError {
    /// The text is no calibration.
    #[error("it is no calibration: {0}")]
    Syntax(String),
    /// It is in another format.
    #[error("it is in format {found}, this program reads format {FORMAT}; calibrate with this program")]
    Format {
        /// The format it is in.
        found: u32,
    },
    /// A value cannot be.
    #[error(
        "`{key}` cannot be used: a number is not finite, a range is none, or a variance is negative; calibrate again"
    )]
    Value {
        /// The key.
        key: &'static str,
    },
}

/// The format that is written and read.
const FORMAT: u32 = 2;

/// What files of all formats have.
#[derive(Deserialize)]
struct Heading {
    #[serde(rename = "vibrissa_calibration")]
    format: u32,
}

impl Calibration {
    /// A calibration that tells nothing yet.
    #[must_use]
    pub fn new(about: String) -> Self {
        Self { format: FORMAT, about, hinge_stiffness: None, one_channel: None, recursive: None }
    }

    /// Reads a calibration from the text of its file.
    ///
    /// # Errors
    /// [`CalibrationError`] when it is none that can be used.
    pub fn from_yaml(text: &str) -> Result<Self, CalibrationError> {
        let read: Self = match serde_yaml::from_str(text) {
            Ok(read) => read,
            // What another format has besides is not known here.
            Err(error) => match serde_yaml::from_str(text) {
                Ok(Heading { format: found }) if found != FORMAT => return Err(CalibrationError::Format { found }),
                _ => return Err(CalibrationError::Syntax(error.to_string())),
            },
        };
        if read.format != FORMAT {
            return Err(CalibrationError::Format { found: read.format });
        }
        let unsound = |key| Err(CalibrationError::Value { key });
        if read.hinge_stiffness.is_some_and(|stiffness| !(1e-6..=1e6).contains(&stiffness)) {
            return unsound("hinge_stiffness");
        }
        if read.one_channel.as_ref().is_some_and(|curve| !curve.is_sound()) {
            return unsound("one_channel");
        }
        if read.recursive.as_ref().is_some_and(|surface| !surface.is_sound()) {
            return unsound("recursive");
        }
        Ok(read)
    }

    /// The text of its file.
    #[must_use]
    pub fn to_yaml(&self) -> String {
        let mut text = format!(
            "# A whisker's calibration, in metres, radians and newtons; a rig loads it by `calibration: FILE`.\n\
             vibrissa_calibration: {}\nabout: {}\n",
            self.format,
            // What is in quotes in JSON is so in YAML.
            serde_json::Value::from(self.about.as_str())
        );
        // Writing to a string cannot fail.
        if let Some(stiffness) = self.hinge_stiffness {
            let _ = writeln!(text, "hinge_stiffness: {stiffness:?}");
        }
        if let Some(ContactCurve { range, x, y, covariance }) = &self.one_channel {
            let _ = write!(
                text,
                "one_channel:\n  range: {range:?}\n  x: {x:?}\n  y: {y:?}\n  covariance: {covariance:?}\n"
            );
        }
        if let Some(AngleSurface { centre, scale, coefficients, spread, reach, places }) = &self.recursive {
            let _ = write!(
                text,
                "recursive:\n  centre: {centre:?}\n  scale: {scale:?}\n  coefficients: {coefficients:?}\n  \
                 spread: {spread:?}\n  reach: {reach:?}\n  places: {places:?}\n"
            );
        }
        text
    }
}
