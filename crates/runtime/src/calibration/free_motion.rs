//! The motion of a whisker in the air, as a calibration has measured it.

use serde::{Deserialize, Serialize};

use crate::rig::Whisker;

/// The motion of a whisker in the air, as a calibration has measured it: either the mode in which it swings, or the damping by which
/// it creeps back.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum FreeMotion {
    /// It swings.
    #[serde(rename = "mode")]
    Mode {
        /// Frequency of the first mode (Hz), without damping.
        first_mode: f64,
        /// Time (s) in which the amplitude decreases to 1/e.
        decay: f64,
    },
    /// It creeps back.
    #[serde(rename = "creep")]
    Creep {
        /// Damping of the material relative to its stiffness (s).
        damping: f64,
        /// Frequency of the first mode (Hz) without damping, if it was measured.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        first_mode: Option<f64>,
    },
}

impl FreeMotion {
    /// Gives a whisker of the rig this motion.
    pub(crate) fn apply(&self, whisker: &mut Whisker) {
        match *self {
            Self::Mode { first_mode, decay } => {
                (whisker.first_mode, whisker.decay) = (Some(first_mode), Some(decay));
            }
            Self::Creep { damping, first_mode } => {
                (whisker.shaft.damping, whisker.decay) = (damping, None);
                whisker.first_mode = first_mode.or(whisker.first_mode);
            }
        }
    }

    /// True if its numbers are those of a whisker.
    pub(super) fn is_sound(&self) -> bool {
        let is_frequency = |first_mode: f64| (0.1..=1e4).contains(&first_mode);
        match *self {
            Self::Mode { first_mode, decay } => is_frequency(first_mode) && (1e-4..=1e3).contains(&decay),
            Self::Creep { damping, first_mode } => {
                (0.0..=10.0).contains(&damping) && first_mode.is_none_or(is_frequency)
            }
        }
    }
}
