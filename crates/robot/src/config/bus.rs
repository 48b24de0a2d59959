//! The section `buses`: I²C buses with their boards.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::{quantity, whole_number};

/// An I²C bus.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BusConfig {
    /// The device file, such as `/dev/i2c-1`.
    pub device: PathBuf,
    /// Lowest clock frequency (Hz) with which the loop starts. It is measured at the start.
    #[serde(default = "fast_mode", with = "quantity::frequency")]
    pub clock: f64,
    /// The boards, in the order of a round.
    pub boards: Vec<BoardConfig>,
}

/// A board with a sensor at the base of a whisker.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoardConfig {
    /// Name of the whisker in the rig.
    pub whisker: String,
    /// Address on the bus (7 bit).
    #[serde(deserialize_with = "whole_number::address")]
    pub address: u8,
    /// Field at the sensor per base moment (T/(N m), or µT per µN m). It is negative if the board is turned around.
    #[serde(default = "array_magnet")]
    pub field_per_moment: f64,
    /// Relative growth of the field with the square of the base moment (1/(N m)²).
    #[serde(default)]
    pub cubic: f64,
}

impl BoardConfig {
    /// A board of the baseline's array.
    #[must_use]
    pub fn array(whisker: String, address: u8) -> Self {
        Self { whisker, address, field_per_moment: array_magnet(), cubic: 0.0 }
    }
}

/// 90 % of the sensor's fastest clock.
fn fast_mode() -> f64 {
    360e3
}

/// The baseline's array: a bend of 300 µN m gives 8760 counts of 0.15 µT.
pub(super) fn array_magnet() -> f64 {
    8760.0 * 0.15 / 300.0
}
