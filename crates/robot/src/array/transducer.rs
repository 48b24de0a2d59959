//! Conversion of counts to base angles.

use vibrissa_runtime::rig::Whisker;

use super::magnet::Magnet;
use crate::config::{BoardConfig, Config, ConfigError};
use crate::sensor::{Sensor, SensorModel};

/// Conversion of the counts of a sensor to the base angle of its whisker.
///
/// The robot uses it, and the calibration of a whisker from counts does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transducer {
    /// The magnet at the base.
    pub magnet: Magnet,
    /// Field per count (µT).
    pub microtesla_per_count: f64,
    /// Stiffness of the base hinge (N m/rad).
    pub hinge_stiffness: f64,
    /// Counts of the whisker at rest.
    pub neutral: f64,
}

impl Transducer {
    /// The conversion of a board at a whisker. The neutral value is 0.
    #[must_use]
    pub fn new(board: &BoardConfig, whisker: &Whisker, sensor: &SensorModel) -> Self {
        Self {
            magnet: Magnet { field_per_moment: board.field_per_moment, cubic: board.cubic },
            microtesla_per_count: sensor.microtesla_per_count(),
            hinge_stiffness: whisker.perceived().hinge.stiffness,
            neutral: 0.0,
        }
    }

    /// The board of a whisker with its conversion.
    ///
    /// # Errors
    /// [`ConfigError`] if the sensors do not permit their settings, or if no board is assigned to the whisker.
    pub fn of<'c>(config: &'c Config, whisker: &Whisker) -> Result<(&'c BoardConfig, Self), ConfigError> {
        let sensor = config.sensor()?;
        let board = config.buses.iter().flat_map(|bus| &bus.boards).find(|board| board.whisker == whisker.name);
        let none = || ConfigError::Inconsistent(format!("the whisker `{}` has no board; give it one", whisker.name));
        let board = board.ok_or_else(none)?;
        Ok((board, Self::new(board, whisker, &sensor)))
    }

    /// The base angle (rad) at a value (counts). NaN where the field of the magnet is not invertible.
    #[must_use]
    pub fn base_angle(&self, counts: f64) -> f64 {
        let field_microtesla = (counts - self.neutral) * self.microtesla_per_count;
        self.magnet.moment(field_microtesla) / self.hinge_stiffness
    }
}
