//! The calibration that a run used.

use std::fmt;

use serde::{Deserialize, Serialize};

use vibrissa_world::scene::{Scene, SelfCalibration};

/// The calibration of the array that control assumed in a run.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CalibrationIdentity {
    /// Its origin.
    pub kind: CalibrationKind,
    /// Hash of everything that the calibration depends on. `None` for an uncalibrated array.
    pub hash: Option<String>,
    /// True if an earlier command had made it.
    pub cached: bool,
}

/// The origin of a calibration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum CalibrationKind {
    /// The simulated array measured itself by touches of a pin before the run.
    Touches,
    /// The rig of the scenario states the calibrations of its whiskers.
    Rig,
    /// Control assumed the whiskers of the rig, although the simulated array differs from them.
    Uncalibrated,
}

impl CalibrationIdentity {
    /// The calibration of a scene's array. `hash` gives the hash of a text. `None` for an array that is the assumed one, and
    /// that no calibration changes.
    #[must_use]
    pub fn of(scene: &Scene, hash: impl FnOnce(&str) -> String) -> Option<Self> {
        if let Some(SelfCalibration { hash, cached }) = scene.self_calibration.clone() {
            return Some(Self { kind: CalibrationKind::Touches, hash: Some(hash), cached });
        }
        let stated: Vec<_> = scene.rig.whiskers.iter().map(|whisker| whisker.calibration.as_ref()).collect();
        if stated.iter().any(Option::is_some) {
            // The text has every number with all its digits.
            return Some(Self { kind: CalibrationKind::Rig, hash: Some(hash(&format!("{stated:?}"))), cached: false });
        }
        scene.mismatch.is_some().then_some(Self { kind: CalibrationKind::Uncalibrated, hash: None, cached: false })
    }
}

impl fmt::Display for CalibrationIdentity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let hash = self.hash.as_deref().unwrap_or_default();
        match self.kind {
            CalibrationKind::Touches if self.cached => write!(f, "calibrated by its own touches ({hash}, cached)"),
            CalibrationKind::Touches => write!(f, "calibrated by its own touches ({hash})"),
            CalibrationKind::Rig => write!(f, "calibrated as the rig of the scenario states ({hash})"),
            CalibrationKind::Uncalibrated => f.write_str("not calibrated"),
        }
    }
}
