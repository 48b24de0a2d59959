//! The response of a damped spring.

use vibrissa_runtime::math;

/// An angle that follows an input angle with a first-order lag, as a damped spring follows a moment.
#[derive(Debug, Clone, Copy)]
pub(super) struct FirstOrderLag {
    /// The time constant (s).
    time_constant: f64,
    value: f64,
    input: f64,
}

/// Smaller magnitudes (rad) are set to zero.
const SMALLEST_ANGLE: f64 = 1e-290;

impl FirstOrderLag {
    /// Creates the lag at rest at 0. The time constant (s) is damping over stiffness.
    pub(super) fn new(time_constant: f64) -> Self {
        Self { time_constant, value: 0.0, input: 0.0 }
    }

    pub(super) fn value(&self) -> f64 {
        self.value
    }

    /// Advances by `period` (s), while the input changes linearly to `input` (rad).
    pub(super) fn follow(&mut self, input: f64, period: f64) {
        // In the steady state of a ramp, the output is delayed by the time constant. The transient decays
        // exponentially.
        let delay = (input - self.input) / period * self.time_constant;
        let decay = if self.time_constant > 0.0 { math::exp(-period / self.time_constant) } else { 0.0 };
        let value = input - delay + (self.value - self.input + delay) * decay;
        // Rounding would keep subnormal numbers forever, and they are a hundred times slower to process.
        self.value = if value.abs() < SMALLEST_ANGLE { 0.0 } else { value };
        self.input = input;
    }
}

#[cfg(test)]
mod tests {
    use super::FirstOrderLag;

    #[test]
    fn a_lag_is_late_by_its_time_constant_and_comes_to_rest_where_it_should() {
        let mut lag = FirstOrderLag::new(0.01);
        for step in 1..=100 {
            lag.follow(0.03 * f64::from(step), 0.003);
        }
        assert!((lag.value() - (3.0 - 0.1)).abs() < 1e-9);
        for _ in 0..100 {
            lag.follow(3.0, 0.003);
        }
        assert!((lag.value() - 3.0).abs() < 1e-12);
    }

    #[test]
    fn a_lag_in_two_halves_is_the_same() {
        let (mut once, mut twice) = (FirstOrderLag::new(0.01), FirstOrderLag::new(0.01));
        once.follow(1.0, 0.004);
        twice.follow(0.5, 0.002);
        twice.follow(1.0, 0.002);
        assert!((once.value() - twice.value()).abs() < 1e-15);
    }

    #[test]
    fn what_fades_is_gone_at_last() {
        let mut lag = FirstOrderLag::new(0.01);
        lag.follow(1e-3, 0.003);
        for _ in 0..2500 {
            lag.follow(0.0, 0.003);
        }
        assert!(lag.value() == 0.0);
    }

    #[test]
    fn no_damper_is_no_lag() {
        let mut lag = FirstOrderLag::new(0.0);
        lag.follow(0.7, 0.003);
        assert!((lag.value() - 0.7).abs() < f64::EPSILON);
    }
}
