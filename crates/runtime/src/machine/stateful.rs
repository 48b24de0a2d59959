//! Operations with memory: a low-pass filter and a PID controller.
//!
//! The memory is registers that are zero before the first use and after every entry of the state. Each operation uses
//! the time since its last use, so late ticks are filtered correctly. A non-finite value appears in the result but does
//! not change the memory.

use crate::math;

/// Started (1) or not (0), time of the last use (s), filtered value.
type LowPassMemory = [f64; 3];
/// Started (1) or not (0), time of the last use (s), integrated error, last error.
type PidMemory = [f64; 4];

/// One step of a first-order low-pass filter with its −3 dB point at `cutoff` (Hz). It starts at the first value.
pub(super) fn low_pass(memory: LowPassMemory, now: f64, value: f64, cutoff: f64) -> (LowPassMemory, f64) {
    let [started, before, filtered] = memory;
    let filtered = if started > 0.5 {
        // This step is exact for a value that is constant between two uses.
        let share = -math::exp_m1(-std::f64::consts::TAU * cutoff * (now - before));
        filtered + share * (value - filtered)
    } else {
        value
    };
    if filtered.is_finite() { ([1.0, now, filtered], filtered) } else { (memory, filtered) }
}

/// One step of a PID controller with the gains `[p, i, d, limit]`. The output is limited to ± `limit`. At the limit the
/// integral does not grow. The time of a non-finite output is not integrated.
pub(super) fn pid(memory: PidMemory, now: f64, error: f64, [p, i, d, limit]: [f64; 4]) -> (PidMemory, f64) {
    let [started, before, integral, last] = memory;
    let passed = if started > 0.5 { now - before } else { 0.0 };
    let grown = integral + error * passed;
    let change = if passed > 0.0 { (error - last) / passed } else { 0.0 };
    let output = p * error + i * grown + d * change;
    let integral = if output.abs() <= limit.abs() { grown } else { integral };
    // `clamp` panics on a NaN limit. A NaN must appear in the output.
    let limited = if output.abs() <= limit.abs() { output } else { limit.abs() * output.signum() };
    if limited.is_finite() && integral.is_finite() && error.is_finite() {
        ([1.0, now, integral, error], limited)
    } else {
        ([0.0, before, memory[2], last], limited)
    }
}

#[cfg(test)]
mod tests {
    use super::{low_pass, pid};
    use crate::math;

    #[test]
    fn a_step_passes_a_low_pass_filter_as_an_exponential_whatever_the_ticks() {
        let (mut memory, first) = low_pass([0.0; 3], 0.0, 0.0, 2.0);
        assert!(first.abs() < 1e-15);
        let mut now = 0.0;
        for passed in [0.01, 0.5, 1e-4, 0.033, 0.2] {
            now += passed;
            let filtered;
            (memory, filtered) = low_pass(memory, now, 1.0, 2.0);
            assert!((filtered - (1.0 - math::exp(-std::f64::consts::TAU * 2.0 * now))).abs() < 1e-12);
        }
    }

    #[test]
    fn a_pid_controller_adds_its_three_parts() {
        let (memory, output) = pid([0.0; 4], 1.0, 0.5, [2.0, 3.0, 5.0, 100.0]);
        assert!((output - 1.0).abs() < 1e-12, "at first there is neither past nor change");
        let (_, output) = pid(memory, 1.1, 0.7, [2.0, 3.0, 5.0, 100.0]);
        assert!((output - (1.4 + 3.0 * 0.07 + 5.0 * 2.0)).abs() < 1e-9);
    }

    #[test]
    fn a_pid_controller_at_its_limit_does_not_wind_up() {
        let mut memory = [0.0; 4];
        for tick in 0..1000 {
            let output;
            (memory, output) = pid(memory, f64::from(tick), 1.0, [1.0, 1.0, 0.0, 2.0]);
            assert!(output <= 2.0);
        }
        assert!(pid(memory, 1000.0, -2.0, [1.0, 1.0, 0.0, 2.0]).1 < 0.0);
    }

    #[test]
    fn after_a_non_finite_value_a_filter_continues_and_a_controller_has_integrated_nothing() {
        let (memory, _) = low_pass([0.0; 3], 0.0, 1.0, 2.0);
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let (kept, shown) = low_pass(memory, 0.1, bad, 2.0);
            assert!(!shown.is_finite());
            assert_eq!(low_pass(kept, 0.2, 3.0, 2.0), low_pass(memory, 0.2, 3.0, 2.0));
        }
        let gains = [1.0, 1.0, 1.0, 100.0];
        let (memory, _) = pid(pid([0.0; 4], 0.0, 1.0, gains).0, 1.0, 1.0, gains);
        for bad in [f64::NAN, f64::INFINITY] {
            let (kept, _) = pid(memory, 2.0, bad, gains);
            let (kept, output) = pid(kept, 60.0, 3.0, gains);
            assert!((output - 4.0).abs() < 1e-12, "p and the integral from before");
            assert!((pid(kept, 61.0, 3.0, gains).1 - 7.0).abs() < 1e-12, "and on it goes");
        }
    }

    #[test]
    fn a_nan_appears_in_the_output() {
        assert!(low_pass([1.0, 0.0, 0.0], 0.1, f64::NAN, 1.0).1.is_nan());
        assert!(pid([1.0, 0.0, 0.0, 0.0], 0.1, f64::NAN, [1.0, 0.0, 0.0, 1.0]).1.is_nan());
        assert!(pid([1.0, 0.0, 0.0, 0.0], 0.1, 1.0, [1.0, 0.0, 0.0, f64::NAN]).1.is_nan());
    }
}
