//! A whisker's deflection: its filtered base angle.

use std::f64::consts::PI;

use super::low_pass::LowPass;

/// The greatest base angle (rad) that is taken for one: no hinge turns farther.
pub(super) const GREATEST_ANGLE: f64 = PI;

/// A whisker's deflection: its base angle, filtered, with the readings left out that are none.
#[derive(Debug, Clone)]
pub(super) struct FilteredBaseAngle {
    filter: LowPass,
    /// The newest valid reading (rad).
    reading: f64,
    /// Whether this tick has brought a valid reading, and the last one did.
    has_reading: bool,
    had_reading: bool,
    /// Filtered base angle (rad).
    value: f64,
}

impl FilteredBaseAngle {
    pub(super) fn new(filter: LowPass) -> Self {
        Self { filter, reading: 0.0, has_reading: true, had_reading: true, value: 0.0 }
    }

    /// Begins a tick; its readings come next.
    pub(super) fn begin(&mut self) {
        self.had_reading = self.has_reading;
        self.has_reading = false;
    }

    /// Takes one base angle (rad). One that is none is left out: until the next, the last valid one counts. After a tick
    /// without any, what was before says nothing of what is now, and the filter begins anew.
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

    /// The deflection (rad); not a number where the tick has brought no valid reading.
    pub(super) fn value(&self) -> f64 {
        if self.has_reading { self.value } else { f64::NAN }
    }
}
