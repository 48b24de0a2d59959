//! The filtered base angle of a whisker.

use std::f64::consts::PI;

use super::low_pass::LowPass;

/// Largest valid base angle (rad). No hinge rotates farther.
pub(super) const GREATEST_ANGLE: f64 = PI;

/// The filtered base angle of a whisker, without invalid readings.
#[derive(Debug, Clone)]
pub(super) struct FilteredBaseAngle {
    filter: LowPass,
    /// Newest valid reading (rad).
    reading: f64,
    /// True if this tick has a valid reading, and if the previous tick had one.
    has_reading: bool,
    had_reading: bool,
    /// Filtered base angle (rad).
    value: f64,
    /// Time (s) since the last tick with a valid reading. It is infinite before the first one.
    silent_for: f64,
    /// Time (s) without a valid reading over which the value is kept.
    kept_for: f64,
}

impl FilteredBaseAngle {
    /// Creates the filtered base angle, initially 0.
    pub(super) fn new(filter: LowPass) -> Self {
        Self {
            filter,
            reading: 0.0,
            has_reading: true,
            had_reading: true,
            value: 0.0,
            silent_for: f64::INFINITY,
            kept_for: 0.0,
        }
    }

    /// Begins a tick. Its readings follow.
    pub(super) fn begin(&mut self) {
        self.had_reading = self.has_reading;
        self.has_reading = false;
    }

    /// Adds one base angle (rad). An invalid one is replaced by the last valid one. After a tick without valid readings
    /// the filter restarts, because earlier readings no longer describe the whisker.
    pub(super) fn take(&mut self, base_angle: f64) {
        if base_angle.abs() <= GREATEST_ANGLE {
            if !self.has_reading && !self.had_reading {
                self.filter.settle(base_angle);
            }
            self.reading = base_angle;
            self.has_reading = true;
        }
        self.value = self.filter.next(self.reading);
    }

    /// Keeps the value over ticks without a valid reading, for at most this time (s).
    pub(super) fn keep_for(&mut self, time: f64) {
        self.kept_for = time;
    }

    /// Ends a tick of this `period` (s), after its readings.
    pub(super) fn end(&mut self, period: f64) {
        self.silent_for = if self.has_reading { 0.0 } else { self.silent_for + period };
    }

    /// True if the tick has a valid reading.
    pub(super) fn has_reading(&self) -> bool {
        self.has_reading
    }

    /// The filtered base angle (rad). In a tick without a valid reading it is the last one, and NaN once it is too old.
    pub(super) fn value(&self) -> f64 {
        let is_kept = self.kept_for > 0.0 && self.silent_for <= self.kept_for;
        if self.has_reading || is_kept { self.value } else { f64::NAN }
    }
}
