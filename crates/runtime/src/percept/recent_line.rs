//! A straight line through the newest readings.

use crate::math;

/// The least-squares straight line through the newest readings, which are equally spaced in time.
#[derive(Debug, Clone)]
pub(super) struct RecentLine {
    /// Time between readings (s).
    period: f64,
    /// Number of readings to which the line is fitted.
    window: usize,
    /// Readings, the newest last.
    readings: [f64; LONGEST],
    /// Number of readings since the last gap, at most [`LONGEST`].
    count: usize,
}

/// Maximum number of readings of a line.
const LONGEST: usize = 30;
/// Minimum number of readings. A line through two would follow the noise.
const SHORTEST: usize = 3;

impl RecentLine {
    /// Creates a line over the fewest readings, which are `period` (s) apart.
    pub(super) fn new(period: f64) -> Self {
        Self { period, window: SHORTEST, readings: [0.0; LONGEST], count: 0 }
    }

    /// Fits the line to the fewest readings for which its value at `ahead` (s) after the newest has at most the standard
    /// deviation `deviation`. At most thirty readings are used. `noise` is the standard deviation of a reading.
    pub(super) fn fit_to(&mut self, ahead: f64, noise: f64, deviation: f64) {
        let before = self.window;
        self.window = SHORTEST;
        while self.window < LONGEST && noise * self.noise_gain(ahead) > deviation {
            self.window += 1;
        }
        // Readings before the former window are unknown.
        let oldest = self.readings[LONGEST - before];
        self.readings[..LONGEST - before].fill(oldest);
    }

    /// Ratio of the standard deviations of the line's value, at `ahead` (s) after the newest reading, and of a reading.
    pub(super) fn noise_gain(&self, ahead: f64) -> f64 {
        let window = self.window as f64;
        let from_middle = ahead / self.period + 0.5 * (window - 1.0);
        (1.0 / window + math::square(from_middle) / self.moment()).sqrt()
    }

    /// Ratio of the standard deviations of the line's slope (1/s) and of a reading.
    pub(super) fn slope_gain(&self) -> f64 {
        self.moment().sqrt().recip() / self.period
    }

    /// Sum of the squared distances, in periods, of the readings from their middle.
    fn moment(&self) -> f64 {
        let window = self.window as f64;
        window * (window * window - 1.0) / 12.0
    }

    /// Forgets all readings.
    pub(super) fn clear(&mut self) {
        self.count = 0;
    }

    /// Adds a reading.
    pub(super) fn take(&mut self, reading: f64) {
        if self.count == 0 {
            self.readings = [reading; LONGEST];
        }
        // Older readings are never used.
        self.readings[LONGEST - self.window..].rotate_left(1);
        self.readings[LONGEST - 1] = reading;
        self.count = (self.count + 1).min(LONGEST);
    }

    /// The line's value at `ahead` (s) after the newest reading, and its slope (1/s).
    pub(super) fn at(&self, ahead: f64) -> (f64, f64) {
        let middle = 0.5 * (self.window as f64 - 1.0);
        let newest = &self.readings[LONGEST - self.window..];
        let sum: f64 = newest.iter().enumerate().map(|(index, reading)| (index as f64 - middle) * reading).sum();
        let slope = sum / self.moment() / self.period;
        let mean = newest.iter().sum::<f64>() / self.window as f64;
        (mean + slope * (ahead + middle * self.period), slope)
    }
}
