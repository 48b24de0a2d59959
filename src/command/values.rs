//! Parsers of the values of arguments.

use std::f64::consts::PI;
use std::fmt::Display;
use std::num::NonZeroUsize;
use std::ops::RangeInclusive;
#[cfg(unix)]
use std::path::PathBuf;
use std::str::FromStr;

use vibrissa_lab::trial::processors;
use vibrissa_runtime::machine::NESTING_LIMIT;
use vibrissa_runtime::units::{Dimension, parse_quantity};

/// Largest number of runs at a time for each processor. More only take memory.
const JOBS_PER_PROCESSOR: usize = 32;
/// Largest number of repetitions of a measurement.
const MAX_REPEATS: usize = 1000;
/// Largest number of scenes of a family, and of runs of a scenario.
const MAX_RUNS: u64 = 100_000;
/// Largest number of cases of a property.
const MAX_CASES: usize = 100_000;
/// Largest deviation of starts (m), larger than any scene.
const MAX_JITTER: f64 = 10.0;

/// Sides of a video (px).
#[cfg(feature = "render")]
const PICTURE_SIDES: RangeInclusive<u32> = 64..=4096;

/// Largest time of a recording (s), longer than any robot runs.
const MAX_TIME: f64 = 1e9;

/// Number of runs at a time.
pub(super) fn parse_jobs(text: &str) -> Result<NonZeroUsize, String> {
    let most = processors().get().saturating_mul(JOBS_PER_PROCESSOR);
    let jobs =
        parse_whole(text, 1..=most).map_err(|range| format!("{range}, {JOBS_PER_PROCESSOR} for each processor"))?;
    Ok(NonZeroUsize::new(jobs).unwrap_or(NonZeroUsize::MIN))
}

/// Number of repetitions of a measurement.
pub(super) fn parse_repeats(text: &str) -> Result<usize, String> {
    parse_whole(text, 1..=MAX_REPEATS)
}

/// Number of scenes of a family, or of runs of a scenario.
pub(super) fn parse_runs(text: &str) -> Result<u64, String> {
    parse_whole(text, 1..=MAX_RUNS)
}

/// Number of cases of a property.
pub(super) fn parse_cases(text: &str) -> Result<usize, String> {
    parse_whole(text, 1..=MAX_CASES)
}

/// Number of levels of states.
pub(super) fn parse_depth(text: &str) -> Result<usize, String> {
    parse_whole(text, 1..=NESTING_LIMIT)
}

/// A seed, or the number of a scene.
pub(super) fn parse_seed(text: &str) -> Result<u64, String> {
    parse_whole(text, 0..=u64::MAX)
}

/// Even width and height of a video (px).
#[cfg(feature = "render")]
pub(super) fn parse_picture_size(text: &str) -> Result<[u32; 2], String> {
    let side = |text: &str| text.parse().ok().filter(|side| PICTURE_SIDES.contains(side) && side % 2 == 0);
    let sides = text.trim().split_once('x').and_then(|(width, height)| Some([side(width)?, side(height)?]));
    sides.ok_or_else(|| "write two even numbers from 64 to 4096, such as 640x480".to_owned())
}

/// Frames per second of a video. A GIF cannot show more than 50.
#[cfg(feature = "render")]
pub(super) fn parse_video_rate(text: &str) -> Result<u32, String> {
    parse_whole(text, 1..=50)
}

/// Simulated seconds per second of a video.
#[cfg(feature = "render")]
pub(super) fn parse_video_speed(text: &str) -> Result<f64, String> {
    let speed = text.trim().parse().ok().filter(|speed| (0.01..=1000.0).contains(speed));
    speed.ok_or_else(|| "write a number from 0.01 to 1000, such as 10".to_owned())
}

fn parse_whole<T: FromStr + PartialOrd + Display>(text: &str, range: RangeInclusive<T>) -> Result<T, String> {
    let number = text.trim().parse().ok().filter(|number| range.contains(number));
    number.ok_or_else(|| format!("write a whole number from {} to {}", range.start(), range.end()))
}

/// A coefficient of friction from 0 to 1.
pub(super) fn parse_friction(text: &str) -> Result<f64, String> {
    let friction = text.trim().parse().ok().filter(|friction| (0.0..=1.0).contains(friction));
    friction.ok_or_else(|| "write a number from 0 to 1, such as 0.3".to_owned())
}

/// Largest deviation of a start from that of a scenario (m).
pub(super) fn parse_jitter(text: &str) -> Result<f64, String> {
    parse_size(text, Dimension::LENGTH, MAX_JITTER, "from 0 to 10 m, such as \"20 mm\"")
}

/// Largest deviation of a heading from that of a scenario (rad). Half a turn to either side includes every heading.
pub(super) fn parse_jitter_heading(text: &str) -> Result<f64, String> {
    parse_size(text, Dimension::ANGLE, PI, "from 0 to 180 deg, such as \"10 deg\"")
}

/// A heading (rad).
pub(super) fn parse_heading(text: &str) -> Result<f64, String> {
    let size = text.trim().trim_start_matches('-');
    let heading = parse_size(size, Dimension::ANGLE, PI, "from -180 to 180 deg, such as \"90 deg\"")?;
    Ok(if size.len() < text.trim().len() { -heading } else { heading })
}

/// The serial device of a printer behind `gcode:`.
#[cfg(unix)]
pub(super) fn parse_stage(text: &str) -> Result<PathBuf, String> {
    let device = text.strip_prefix("gcode:").filter(|device| !device.is_empty());
    device.map(PathBuf::from).ok_or_else(|| "write `gcode:` and a serial device, such as gcode:/dev/ttyUSB0".to_owned())
}

/// The speed of a stage (m/s).
#[cfg(unix)]
pub(super) fn parse_stage_speed(text: &str) -> Result<f64, String> {
    let range = "from 0.1 mm/s to 1 m/s, such as \"10 mm/s\"";
    let speed = parse_size(text, Dimension::SPEED, 1.0, range)?;
    if speed >= 1e-4 { Ok(speed) } else { Err(format!("write a speed {range}")) }
}

/// A line of G-code.
#[cfg(unix)]
pub(super) fn parse_gcode(text: &str) -> Result<String, String> {
    let line = text.trim();
    let is_line = !line.is_empty() && line.chars().all(|c| (' '..='~').contains(&c) && !";*".contains(c));
    if is_line {
        Ok(line.to_owned())
    } else {
        Err("write one line of G-code without a comment, such as G28".to_owned())
    }
}

/// Numbers of this count, separated by commas.
#[cfg(unix)]
pub(super) fn parse_numbers<const N: usize>(text: &str) -> Result<[f64; N], String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    let numbers = numbers.filter(|numbers| numbers.iter().all(|number| number.abs() <= 1e4));
    let found = numbers.and_then(|numbers| <[f64; N]>::try_from(numbers).ok());
    found.ok_or_else(|| format!("write {N} numbers (mm) with commas between them, such as {}", ["110"; N].join(",")))
}

/// A time of a recording (s).
pub(super) fn parse_time(text: &str) -> Result<f64, String> {
    parse_size(text, Dimension::TIME, MAX_TIME, "from 0 to 1e9 s, such as \"12.3 s\"")
}

/// A quantity (SI) of this dimension from 0 to `most`. `range` describes it in messages.
fn parse_size(text: &str, dimension: Dimension, most: f64, range: &str) -> Result<f64, String> {
    let quantity = parse_quantity(text.trim()).map_err(|error| format!("{error}; {}", error.hint()))?;
    let fits = quantity.dimension == dimension && (0.0..=most).contains(&quantity.value_si);
    fits.then_some(quantity.value_si).ok_or_else(|| format!("write {} {range}", dimension.phrase()))
}
