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
}

impl FilteredBaseAngle {
    /// Creates the filtered base angle, initially 0.
    pub(super) fn new(filter: LowPass) -> Self {
        Self { filter, reading: 0.0, has_reading: true, had_reading: true, value: 0.0 }
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

    /// The filtered base angle (rad), or NaN if the tick has no valid reading.
    pub(super) fn value(&self) -> f64 {
        if self.has_reading { self.value } else { f64::NAN }
    }
}
