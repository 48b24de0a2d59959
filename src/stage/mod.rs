//! A stage that moves the pin or the array in a calibration: a 3-D printer that reads G-code from a serial line.

mod error;
mod port;
mod printer;

use std::path::{Path, PathBuf};

use vibrissa_world::geometry::Point2;

pub(crate) use error::StageError;
use printer::Printer;

/// What the printer carries.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Carried {
    /// The array, above a fixed pin.
    Array,
    /// The pin, beside a fixed array.
    Pin,
}

/// How a printer serves as a stage. Its axes X and Y are those of the world frame.
#[derive(Debug, Clone)]
pub(crate) struct StageSettings {
    /// Its serial device.
    pub(crate) device: PathBuf,
    /// What it carries.
    pub(crate) carried: Carried,
    /// Its position X, Y (m) if the centre of mass of the platform were at the axis of the pin.
    pub(crate) zero: [f64; 2],
    /// Its largest positions X, Y, Z (m). The least are 0.
    pub(crate) volume: [f64; 3],
    /// How far (m) it rises before it passes the pin.
    pub(crate) lift: f64,
    /// Its speed (m/s).
    pub(crate) speed: f64,
    /// Lines of G-code that it gets first.
    pub(crate) start: Vec<String>,
}

/// A printer as a stage. It works at the height at which it is opened.
#[derive(Debug)]
pub(crate) struct Stage {
    printer: Printer,
    settings: StageSettings,
    /// Where the printer is (mm).
    place: [f64; 3],
    /// The height (mm) of the touches.
    height: f64,
}

impl Stage {
    /// Connects to the printer. It does not move, except by the lines of `start`.
    ///
    /// # Errors
    /// [`StageError`] if there is no printer.
    pub(crate) fn open(settings: StageSettings) -> Result<Self, StageError> {
        let mut printer = Printer::connect(Path::new(&settings.device), &settings.start)?;
        let place = printer.position()?;
        Ok(Self { printer, settings, place, height: place[2] })
    }

    /// Rises, goes to a position of the platform's centre of mass (m, world frame, from the pin's axis), and sinks. Nothing moves
    /// if this position or the one `after` it is outside of the volume.
    ///
    /// # Errors
    /// [`StageError`] if a position is outside, or if the printer does not reach it.
    pub(crate) fn approach(&mut self, body: Point2, after: Point2) -> Result<(), StageError> {
        let raised = self.raised();
        let [x, y] = self.over(body);
        let [beyond_x, beyond_y] = self.over(after);
        for place in [[x, y, self.height], [x, y, raised], [beyond_x, beyond_y, self.height]] {
            self.check(place)?;
        }
        self.rise()?;
        self.go([x, y, raised])?;
        self.go([x, y, self.height])
    }

    /// Goes to a position of the platform's centre of mass at the height of the touches.
    ///
    /// # Errors
    /// As [`Self::approach`].
    pub(crate) fn slide(&mut self, body: Point2) -> Result<(), StageError> {
        let [x, y] = self.over(body);
        self.check([x, y, self.height])?;
        self.go([x, y, self.height])
    }

    /// Rises above the pin.
    ///
    /// # Errors
    /// As [`Self::approach`].
    pub(crate) fn rise(&mut self) -> Result<(), StageError> {
        let [x, y, _] = self.place;
        self.go([x, y, self.raised()])
    }

    fn raised(&self) -> f64 {
        self.height + 1e3 * self.settings.lift
    }

    /// The position X, Y (mm) of the printer for a position of the platform's centre of mass. A pin moves in the opposite direction.
    fn over(&self, body: Point2) -> [f64; 2] {
        let sign = if self.settings.carried == Carried::Array { 1.0 } else { -1.0 };
        let [x, y] = self.settings.zero;
        [1e3 * (x + sign * body.x), 1e3 * (y + sign * body.y)]
    }

    fn check(&self, place: [f64; 3]) -> Result<(), StageError> {
        let axes = "XYZ".chars().zip(place).zip(self.settings.volume.map(|most| 1e3 * most));
        for ((axis, value), most) in axes {
            if !(0.0..=most).contains(&value) {
                return Err(StageError::Outside { axis, value, most });
            }
        }
        Ok(())
    }

    fn go(&mut self, place: [f64; 3]) -> Result<(), StageError> {
        let distance = place.iter().zip(self.place).map(|(to, from)| (to - from).abs()).sum();
        self.printer.go(place, 1e3 * self.settings.speed, distance)?;
        self.place = place;
        Ok(())
    }
}
