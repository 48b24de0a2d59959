//! Options of the stage that moves the pin or the array in planned touches.

use std::path::PathBuf;

use clap::Args;

use super::values::{parse_gcode, parse_jitter, parse_numbers, parse_stage, parse_stage_speed};
use crate::stage::{Carried, StageSettings};

/// The printer as a stage.
#[derive(Debug, Args)]
pub(super) struct StageOptions {
    /// Move by a 3-D printer at this serial device, such as `gcode:/dev/ttyUSB0`. Standard input then has two lines for each touch: the
    /// base angle in the air, which is empty if a file follows, and that in the touch
    #[arg(long, value_name = "gcode:DEVICE", requires = "continued", requires = "stage_zero", value_parser = parse_stage)]
    stage: Option<PathBuf>,
    /// What the printer carries
    #[arg(long, value_enum, default_value = "array", requires = "stage")]
    stage_carries: Carried,
    /// Position of the printer (mm) if the platform's centre of mass were at the axis of the pin, such as `110,95.5`
    #[arg(long, value_name = "X,Y", requires = "stage", allow_hyphen_values = true, value_parser = parse_numbers::<2>)]
    stage_zero: Option<[f64; 2]>,
    /// Largest positions of the printer (mm). The least are 0
    #[arg(long, value_name = "X,Y,Z", default_value = "180,180,180", requires = "stage", value_parser = parse_numbers::<3>)]
    stage_volume: [f64; 3],
    /// How far the printer rises before it passes the pin
    #[arg(long, value_name = "LENGTH", default_value = "20 mm", requires = "stage", value_parser = parse_jitter)]
    stage_lift: f64,
    /// Speed of the printer
    #[arg(long, value_name = "SPEED", default_value = "10 mm/s", requires = "stage", value_parser = parse_stage_speed)]
    stage_speed: f64,
    /// Line of G-code that the printer gets first, such as `G28`. Repeat it for more lines
    #[arg(long, value_name = "GCODE", requires = "stage", value_parser = parse_gcode)]
    stage_start: Vec<String>,
}

impl StageOptions {
    /// The settings of the stage, if there is one.
    pub(super) fn settings(&self) -> Option<StageSettings> {
        Some(StageSettings {
            device: self.stage.clone()?,
            carried: self.stage_carries,
            zero: self.stage_zero?.map(|place| 1e-3 * place),
            volume: self.stage_volume.map(|place| 1e-3 * place),
            lift: self.stage_lift,
            speed: self.stage_speed,
            start: self.stage_start.clone(),
        })
    }
}
