//! Errors of a stage.

use std::io;
use std::path::PathBuf;

use vibrissa_text::system::in_words;

use super::port::BAUD;

/// Why the stage does not move, and what to do. Positions are those of the printer (mm).
#[derive(Debug, thiserror::Error)]
pub(crate) enum StageError {
    #[error(
        "cannot open the printer at {}: {words}; give its serial device, such as --stage gcode:/dev/ttyUSB0, and close other programs that use it",
        path.display(), words = in_words(cause)
    )]
    Open { path: PathBuf, cause: io::Error },
    #[error("the connection to the printer is lost: {words}; connect it, home it, and start the command again", words = in_words(.0))]
    Lost(#[source] io::Error),
    #[error(
        "the printer does not answer `{code}` within {seconds} s; check its power, its cable, and that it has {BAUD} baud"
    )]
    Silent { code: String, seconds: u64 },
    #[error("the printer refuses `{code}`: {said}; correct the cause, home it, and start the command again")]
    Refused { code: String, said: String },
    #[error("the printer has received `{code}` wrongly {times} times; use a shorter cable, away from motors")]
    Noise { code: String, times: u32 },
    #[error(
        "the printer asks for line {asked} and not for line {sent}; close other programs that send lines to it, and start the command again"
    )]
    Lines { asked: u32, sent: u32 },
    #[error(
        "the printer has started again, so its position is unknown; check its power, home it, and start the command again"
    )]
    Restarted,
    #[error("the printer answers M114 without a position; it needs a firmware that answers with `X: Y: Z:`")]
    NoPosition,
    #[error(
        "the printer is at {}, not at {}; its own limits may be smaller than --stage-volume, or it was not homed",
        place(found),
        place(asked)
    )]
    Elsewhere { asked: [f64; 3], found: [f64; 3] },
    #[error(
        "the stage would leave the volume of the printer: {axis} {value:.2} mm is not from 0 to {most} mm; change --stage-zero, --stage-lift or --stage-volume, or choose whiskers with --whisker"
    )]
    Outside { axis: char, value: f64, most: f64 },
}

fn place([x, y, z]: &[f64; 3]) -> String {
    format!("X{x:.3} Y{y:.3} Z{z:.3}")
}
