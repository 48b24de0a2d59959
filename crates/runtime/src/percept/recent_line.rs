//! The straight line through the newest readings.

/// The straight line through the newest readings, taken at equal times, by least squares.
#[derive(Debug, Clone)]
pub(super) struct RecentLine {
    /// Time between readings (s).
    period: f64,
    /// How many readings the line is fitted to.
    window: usize,
    /// The newest reading last.
    readings: [f64; LONGEST],
    count: usize,
}

/// The most readings that a line is fitted to.
const LONGEST: usize = 30;
/// The fewest: of two, noise would be all.
const SHORTEST: usize = 3;

impl RecentLine {
    /// A line through as few readings as bring the spread of its value `ahead` (s) of the newest down to `deviation`, or through
    /// thirty, for readings of which each may be off by `noise`.
    pub(super) fn new(period: f64, ahead: f64, noise: f64, deviation: f64) -> Self {
        let line = |window| Self { period, window, readings: [0.0; LONGEST], count: 0 };
        (SHORTEST..LONGEST)
            .map(line)
            .find(|line| noise * line.noise_gain(ahead) <= deviation)
            .unwrap_or_else(|| line(LONGEST))
    }

    /// How many times the standard deviation of a reading that of the line's value is, `ahead` (s) of the newest.
    pub(super) fn noise_gain(&self, ahead: f64) -> f64 {
        let window = self.window as f64;
        let from_middle = ahead / self.period + 0.5 * (window - 1.0);
        (1.0 / window + from_middle.powi(2) / self.moment()).sqrt()
    }

    /// Sum of the squares of the readings' distances, in periods, from their middle.
    fn moment(&self) -> f64 {
        let window = self.window as f64;
        window * (window * window - 1.0) / 12.0
    }

    /// Forgets all readings.
    pub(super) fn clear(&mut self) {
        self.count = 0;
    }

    /// Takes a reading.
    pub(super) fn take(&mut self, reading: f64) {
        if self.count == 0 {
            self.readings = [reading; LONGEST];
        }
        // Older ones are not asked for.
        self.readings[LONGEST - self.window..].rotate_left(1);
        self.readings[LONGEST - 1] = reading;
        self.count = (self.count + 1).min(LONGEST);
    }

    /// The line's value `ahead` (s) of the newest reading, and its change with time (1/s).
    pub(super) fn at(&self, ahead: f64) -> (f64, f64) {
        let middle = 0.5 * (self.window as f64 - 1.0);
        let newest = &self.readings[LONGEST - self.window..];
        let sum: f64 = newest.iter().enumerate().map(|(index, reading)| (index as f64 - middle) * reading).sum();
        let slope = sum / self.moment() / self.period;
        let mean = newest.iter().sum::<f64>() / self.window as f64;
        (mean + slope * (ahead + middle * self.period), slope)
    }
}
