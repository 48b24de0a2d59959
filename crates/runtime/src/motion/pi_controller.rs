//! A PI controller with a limited output.

/// A proportional-integral controller with a limited output. The integral does not change while the output is at its
/// limit (anti-windup).
#[derive(Debug, Clone, PartialEq)]
pub struct PiController {
    /// Output per unit of error.
    proportional: f64,
    /// Growth of the output per second and unit of error.
    integral: f64,
    /// Largest magnitude of the output.
    limit: f64,
    /// Integral part of the output.
    accumulated: f64,
}

impl PiController {
    /// Creates a controller at rest.
    #[must_use]
    pub fn new(proportional: f64, integral: f64, limit: f64) -> Self {
        Self { proportional, integral, limit, accumulated: 0.0 }
    }

    /// Returns the output for `error`, `period` seconds after the last call.
    pub fn next(&mut self, error: f64, period: f64) -> f64 {
        let accumulated = self.accumulated + self.integral * error * period;
        let output = self.proportional * error + accumulated;
        // Otherwise the integral would need an equally long time to decrease again.
        if output.abs() <= self.limit {
            self.accumulated = accumulated;
        }
        output.clamp(-self.limit, self.limit)
    }

    /// Sets the output for the error zero.
    pub fn begin_at(&mut self, output: f64) {
        self.accumulated = output.clamp(-self.limit, self.limit);
    }

    /// Resets the integral.
    pub fn reset(&mut self) {
        self.accumulated = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use super::PiController;

    #[test]
    fn the_output_never_exceeds_its_limit_and_the_integral_does_not_wind_up() {
        let mut controller = PiController::new(1.0, 10.0, 0.5);
        for _ in 0..1000 {
            assert!(controller.next(1.0, 0.1).abs() <= 0.5);
        }
        assert!(controller.next(-0.1, 0.1) < 0.0, "the output follows the error's sign at once");
    }

    #[test]
    fn a_lasting_error_is_integrated_away() {
        let mut controller = PiController::new(1.0, 2.0, 10.0);
        let (mut value, disturbance) = (0.0, 0.7);
        for _ in 0..2000 {
            value += 0.01 * (controller.next(1.0 - value, 0.01) - disturbance);
        }
        assert!((value - 1.0_f64).abs() < 1e-3);
    }
}
