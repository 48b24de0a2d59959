//! Why a trial cannot be prepared.

use std::path::PathBuf;

use vibrissa_runtime::machine::{ArtifactError, SetError};

use super::ExecuteError;
use crate::calibration::ArrayCalibrationError;
use crate::family::NoDraw;
use crate::load::LoadError;
use vibrissa_world::mismatch::MismatchError;

/// The reason why a trial cannot be prepared.
#[derive(Debug, thiserror::Error)]
pub enum TrialFault {
    /// A file cannot be read or has errors.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// A compiled machine is refused.
    #[error(transparent)]
    Machine(#[from] ArtifactError),
    /// A family has no scene.
    #[error(transparent)]
    Draw(#[from] NoDraw),
    /// The mismatch does not fit the rig of the scenario.
    #[error("{}: mismatch: {cause}", scenario.display())]
    Mismatch {
        /// The scenario.
        scenario: PathBuf,
        /// What does not fit.
        cause: MismatchError,
    },
    /// The array of the scenario cannot be calibrated.
    #[error("{}: the array cannot be calibrated: {cause}", scenario.display())]
    Calibration {
        /// The scenario.
        scenario: PathBuf,
        /// Why not.
        cause: ArrayCalibrationError,
    },
    /// A parameter of the policy cannot be set.
    #[error(transparent)]
    Set(#[from] SetError),
    /// The run cannot begin.
    #[error("{}: {cause}", scenario.display())]
    Execute {
        /// The scenario.
        scenario: PathBuf,
        /// Why not.
        cause: ExecuteError,
    },
}
