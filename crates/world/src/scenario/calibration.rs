//! The calibration file.

use std::fmt::Write;

use vibrissa_runtime::calibration::{
    AngleSurface, Calibration, ContactCurve, DeflectionPolynomial, FreeMotion, MeasuredWhisker,
};
use vibrissa_yaml::CALIBRATION_FORMAT;

/// Returns the text of a calibration file.
#[must_use]
pub fn write_calibration(calibration: &Calibration) -> String {
    format!(
        "# A whisker's calibration, in metres, radians and newtons; a rig loads it by `calibration: FILE`.\n\
         vibrissa_calibration: {CALIBRATION_FORMAT}\n{}",
        values(calibration)
    )
}

/// Returns the parts of a robot's configuration for a calibrated whisker: its calibration, and its `board` on one line.
#[must_use]
pub fn write_robot_calibration(whisker: &str, board: &str, calibration: &Calibration) -> String {
    let values = values(calibration).trim_end().replace('\n', "\n        ");
    format!(
        "# For the configuration of the robot: copy the calibration into the section `rig`, and replace the board.\n\
         # board: {board}\nrig:\n  whiskers:\n    {whisker}:\n      calibration:\n        {values}\n"
    )
}

/// The keys of a calibration.
fn values(calibration: &Calibration) -> String {
    // Quoted JSON text is valid YAML.
    let mut text = format!("about: {}\n", serde_json::Value::from(calibration.about.as_str()));
    // Writing to a string cannot fail.
    if let Some(stiffness) = calibration.hinge_stiffness {
        let _ = writeln!(text, "hinge_stiffness: {stiffness:?}");
    }
    if let Some(measured) = &calibration.measured {
        let MeasuredWhisker {
            hinge_stiffness,
            length,
            direction,
            base,
            curvature,
            taper,
            offset,
            friction,
            covariance,
        } = measured;
        let _ = write!(
            text,
            "measured:\n  hinge_stiffness: {hinge_stiffness:?}\n  length: {length:?}\n  direction: {direction:?}\n  \
             base: {base:?}\n  curvature: {curvature:?}\n  taper: {taper:?}\n  offset: {offset:?}\n  \
             friction: {friction:?}\n  covariance:\n"
        );
        for row in covariance {
            let _ = writeln!(text, "    - {row:?}");
        }
    }
    match calibration.free_motion {
        Some(FreeMotion::Mode { first_mode, decay }) => {
            let _ = writeln!(text, "free_motion:\n  mode:\n    first_mode: {first_mode:?}\n    decay: {decay:?}");
        }
        Some(FreeMotion::Creep { damping, first_mode }) => {
            let _ = writeln!(text, "free_motion:\n  creep:\n    damping: {damping:?}");
            if let Some(first_mode) = first_mode {
                let _ = writeln!(text, "    first_mode: {first_mode:?}");
            }
        }
        None => {}
    }
    if let Some(ContactCurve { range, x, y, covariance }) = &calibration.one_channel {
        let _ =
            write!(text, "one_channel:\n  range: {range:?}\n  x: {x:?}\n  y: {y:?}\n  covariance: {covariance:?}\n");
    }
    if let Some(DeflectionPolynomial { range, length, x, y, covariance }) = &calibration.polynomial {
        let _ = write!(
            text,
            "polynomial:\n  range: {range:?}\n  length: {length:?}\n  x: {x:?}\n  y: {y:?}\n  covariance: {covariance:?}\n"
        );
    }
    if let Some(AngleSurface { centre, scale, coefficients, deviation: spread, reach, positions: places }) =
        &calibration.recursive
    {
        let _ = write!(
            text,
            "recursive:\n  centre: {centre:?}\n  scale: {scale:?}\n  coefficients: {coefficients:?}\n  \
             spread: {spread:?}\n  reach: {reach:?}\n  places: {places:?}\n"
        );
    }
    text
}
