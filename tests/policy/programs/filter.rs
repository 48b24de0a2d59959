//! What a `lowpass` and a `pid` remember.

use vibrissa_runtime::math;

/// What one of them remembers since its state was entered.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Filter {
    /// When it was last computed (s), unless it has yet to begin.
    computed_at: Option<f64>,
    /// The filtered value, or the integral.
    value: f64,
    last_error: f64,
}

impl Filter {
    /// Between two computations the input is what it is at the later one.
    pub(crate) fn low_pass(&mut self, now: f64, input: f64, cutoff: f64) -> f64 {
        let output = match self.computed_at {
            None => input,
            Some(before) => {
                let share = -math::exp_m1(-std::f64::consts::TAU * cutoff * (now - before));
                self.value + share * (input - self.value)
            }
        };
        // What is not finite shows and is not remembered.
        if output.is_finite() {
            (self.computed_at, self.value) = (Some(now), output);
        }
        output
    }

    /// The integral stands still while the output is at its limit, and over a gap in which there is no finite output.
    pub(crate) fn pid(&mut self, now: f64, error: f64, [p, i, d, limit]: [f64; 4]) -> f64 {
        // At first no time has passed; an infinite error times that is not a number.
        let passed = self.computed_at.map_or(0.0, |before| now - before);
        let integral = self.value + error * passed;
        let change = if passed > 0.0 { (error - self.last_error) / passed } else { 0.0 };
        let wanted = p * error + i * integral + d * change;
        let limit = limit.abs();
        let output = if wanted.is_nan() || limit.is_nan() { f64::NAN } else { wanted.clamp(-limit, limit) };
        if !(error.is_finite() && output.is_finite()) {
            self.computed_at = None;
            return output;
        }
        if wanted.abs() <= limit {
            self.value = integral;
        }
        (self.computed_at, self.last_error) = (Some(now), error);
        output
    }
}
