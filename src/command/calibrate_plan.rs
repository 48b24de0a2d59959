//! `vibrissa calibrate --plan`

use std::io::{BufRead, stdin};
use std::path::Path;

use vibrissa_runtime::calibration::{PlannedTouch, TouchNoise, TouchReading};
use vibrissa_runtime::math::square;
use vibrissa_runtime::rig::{Rig, Whisker};

use super::calibrate::CalibrateArguments;
use super::calibrate_array::{calibrate_touches, scene};
use super::exit::Exit;
use super::failure::Failure;
use super::output;
#[cfg(unix)]
use crate::stage::Stage;
use vibrissa_lab::calibration::{NextTouch, Pin, TouchFile, TouchLimits, read_touch_file, write_touch_file};
use vibrissa_lab::load;
use vibrissa_text::file::{CommandFiles, replace};
use vibrissa_world::geometry::{Point2, Pose};

/// Time (s) at the begin of a recording that is in the air, and at its end that is in the touch.
const RESTED: f64 = 0.5;
/// Least standard deviation (rad) of a reading relative to the air, for a reading without one.
const LEAST_DEVIATION: f64 = 1e-7;

/// The lines of standard input.
type StdinLines = std::io::Lines<std::io::StdinLock<'static>>;

/// The next line of standard input, if there is one.
fn next_line(lines: &mut StdinLines) -> Result<Option<String>, Failure> {
    lines.next().transpose().map_err(Failure::Standard)
}

/// Lets the stage make a touch. The result is the line that says its reading and that in the air.
#[cfg(unix)]
fn touched(stage: &mut Stage, next: &NextTouch, lines: &mut StdinLines) -> Result<Option<String>, Failure> {
    stage.approach(next.in_air.position, next.touch.position)?;
    output::result("  at rest in the air")?;
    let in_air = next_line(lines)?;
    let reading = match in_air {
        Some(_) => {
            stage.slide(next.touch.position)?;
            output::result("  at rest in the touch")?;
            next_line(lines)?
        }
        None => None,
    };
    stage.slide(next.in_air.position)?;
    stage.rise()?;
    Ok(in_air.zip(reading).map(|(in_air, reading)| joined(&in_air, &reading)))
}

/// `READING IN_AIR [DEVIATION]` from the two lines of a touch. `missed` and the name of a file stay as they are.
#[cfg(unix)]
fn joined(in_air: &str, line: &str) -> String {
    let mut words = line.split_whitespace();
    match words.next().filter(|word| word.parse::<f64>().is_ok()) {
        Some(reading) => words.fold(format!("{reading} {in_air}"), |line, word| format!("{line} {word}")),
        None => line.to_owned(),
    }
}

/// The touches of an array so far.
struct Session<'a> {
    path: &'a Path,
    rig: Rig,
    noise: TouchNoise,
    pin: (Pin, f64),
    /// The whisker to calibrate, or `None` for all of them.
    only: Option<usize>,
    file: TouchFile,
}

/// Says the next touch of a pin after those in the file at `path`. With `--continue`, reads its readings from standard input, adds them
/// to the file, and goes on until no further touch is planned.
pub(super) fn calibrate_plan(path: &Path, arguments: &CalibrateArguments) -> Result<Exit, Failure> {
    let mut files = CommandFiles::new();
    let rig = scene(arguments, &mut files)?.0.rig;
    let file = if path.exists() { load::touch_file(path, &mut files)? } else { TouchFile::default() };
    let in_file = file.touches.iter().map(|(name, _)| name).chain(file.missed.iter().map(|(name, _)| name));
    let names: Vec<_> = arguments.whisker.iter().chain(in_file).cloned().collect();
    let indices = rig.indices(&names).map_err(Failure::NoWhisker)?;
    // A pin as large as that of a simulated array.
    let radius = arguments.pin_radius.unwrap_or_else(|| 0.1 * rig.whiskers.first().map_or(0.1, |one| one.shaft.length));
    let mut session = Session {
        path,
        only: arguments.whisker.as_ref().and_then(|_| indices.first().copied()),
        file,
        rig,
        noise: TouchNoise { position: arguments.position_noise, heading: arguments.heading_noise },
        pin: (Pin { centre: Point2::origin(), radius }, arguments.heading),
    };
    #[cfg(unix)]
    let mut stage = arguments.stage.settings().map(Stage::open).transpose()?;
    let mut lines = stdin().lock().lines();
    while let Some((whisker, next)) = session.next() {
        let name = whisker.name.clone();
        session.say(&name, &next)?;
        if !arguments.continued {
            return Ok(Exit::Done);
        }
        #[cfg(unix)]
        let line = match &mut stage {
            Some(stage) => touched(stage, &next, &mut lines)?,
            None => next_line(&mut lines)?,
        };
        #[cfg(not(unix))]
        let line = next_line(&mut lines)?;
        let Some(line) = line else { return Ok(Exit::Done) };
        session.take(name, &next, line.trim(), &mut files)?;
    }
    output::result("no further touch is planned")?;
    if arguments.out.is_some() { calibrate_touches(path, arguments) } else { Ok(Exit::Done) }
}

impl Session<'_> {
    /// The next touch of the first whisker that needs one.
    fn next(&self) -> Option<(&Whisker, NextTouch)> {
        let wanted =
            self.rig.whiskers.iter().enumerate().filter(|(index, _)| self.only.is_none_or(|only| only == *index));
        let mut needed = wanted.filter_map(|(_, whisker)| {
            let of_whisker = |name: &String| *name == whisker.name;
            let touches = self.file.touches.iter().filter(|(name, _)| of_whisker(name));
            let missed = self.file.missed.iter().filter(|(name, _)| of_whisker(name));
            let readings: Vec<TouchReading> = touches.map(|(_, touch)| *touch).collect();
            let missed: Vec<PlannedTouch> = missed.map(|(_, touch)| touch.planned(whisker)).collect();
            let limits = TouchLimits::default();
            Some((whisker, NextTouch::of(whisker, &readings, &missed, &self.noise, self.pin, &limits)?))
        });
        needed.next()
    }

    fn say(&self, name: &str, next: &NextTouch) -> Result<(), Failure> {
        let pose = |Pose { position, heading }: Pose| {
            format!(
                "x {:.2} mm, y {:.2} mm, heading {:.2} deg",
                1e3 * position.x,
                1e3 * position.y,
                heading.to_degrees()
            )
        };
        let number = self.file.touches.iter().filter(|(other, _)| other == name).count() + 1;
        output::result(format_args!("{name}, touch {number}; tips are known to {:.3} mm", 1e3 * next.tip_deviation))?;
        output::result(format_args!("  in the air: {}", pose(next.in_air)))?;
        output::result(format_args!("  touch:      {}", pose(next.touch)))?;
        output::result(format_args!("  about {:.0} urad are expected", 1e6 * next.planned.base_angle))
    }

    /// Adds the touch of a line: `READING IN_AIR [DEVIATION]` (urad), `missed`, or the name of a file of readings.
    fn take(&mut self, name: String, next: &NextTouch, line: &str, files: &mut CommandFiles) -> Result<(), Failure> {
        if line == "missed" {
            self.file.missed.push((name, next.missed()));
            return self.write(&write_touch_file(&self.file)?);
        }
        let numbers: Result<Vec<f64>, _> = line.split_whitespace().map(str::parse).collect();
        let touch = match numbers.as_deref() {
            Ok(&[reading, in_air]) => next.reading(1e-6 * reading, 1e-6 * in_air, LEAST_DEVIATION),
            Ok(&[reading, in_air, deviation]) => next.reading(1e-6 * reading, 1e-6 * in_air, 1e-6 * deviation),
            _ if line.is_empty() || numbers.is_ok() => {
                let usage = "give `READING IN_AIR [DEVIATION]` in urad, `missed`, or the name of a file with readings";
                output::message(usage);
                return Ok(());
            }
            _ => recorded(next, &load::timed_readings(Path::new(line), files)?),
        };
        self.file.touches.push((name, touch));
        let text = write_touch_file(&self.file)?;
        // The file that is written must be one that is read.
        if let Err(refusal) = read_touch_file(text.as_bytes()) {
            output::message(format_args!("this touch is left out: {refusal}"));
            self.file.touches.pop();
            return Ok(());
        }
        self.write(&text)
    }

    fn write(&self, text: &str) -> Result<(), Failure> {
        replace(self.path, text.as_bytes()).map_err(|cause| Failure::Plan { path: self.path.to_owned(), cause })
    }
}

/// The touch of a recording that begins in the air and ends in the touch.
fn recorded(next: &NextTouch, readings: &[(f64, f64)]) -> TouchReading {
    let (begin, end) = (readings.first().map_or(0.0, |one| one.0), readings.last().map_or(0.0, |one| one.0));
    let mean = |is_in: &dyn Fn(f64) -> bool| {
        let inside: Vec<f64> = readings.iter().filter(|(time, _)| is_in(*time)).map(|(_, reading)| *reading).collect();
        let count = inside.len().max(1) as f64;
        let mean = inside.iter().sum::<f64>() / count;
        (mean, inside.iter().map(|reading| square(reading - mean)).sum::<f64>() / (count * (count - 1.0).max(1.0)))
    };
    let (in_air, first) = mean(&|time| time <= begin + RESTED);
    let (base_angle, last) = mean(&|time| time >= end - RESTED);
    next.reading(base_angle, in_air, (first + last).sqrt().max(LEAST_DEVIATION))
}
