//! A low-pass filter for base angles.

use biquad::{Biquad, Coefficients, DirectForm2Transposed, Hertz, Type};

/// A third-order Butterworth low-pass filter, initially at rest at zero. It consists of a first-order section and a
/// second-order section with the quality factor 1.
#[derive(Debug, Clone)]
pub struct LowPass {
    /// First-order section.
    first: DirectForm2Transposed<f64>,
    /// Second-order section.
    second: DirectForm2Transposed<f64>,
    /// Input value for which the sections are at rest.
    rest: f64,
}

/// Difference from rest (rad) below which the filter is set to rest.
const FADED: f64 = 1e-290;

/// A cutoff frequency outside of the valid range of the filter.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("a filter for samples at {rate} Hz needs a cutoff above 0 Hz and below {} Hz, not {cutoff} Hz", 0.5 * rate)]
pub struct CutoffError {
    /// Cutoff frequency (Hz).
    cutoff: f64,
    /// Sample rate (Hz).
    rate: f64,
}

impl LowPass {
    /// Creates a filter with its −3 dB point at `cutoff` (Hz) for samples at `rate` (Hz).
    ///
    /// # Errors
    /// [`CutoffError`] unless the cutoff is positive and below half of the rate.
    pub fn new(cutoff: f64, rate: f64) -> Result<Self, CutoffError> {
        let section = |kind, quality| {
            let (rate, cutoff) = (Hertz::<f64>::from_hz(rate)?, Hertz::<f64>::from_hz(cutoff)?);
            Coefficients::from_params(kind, rate, cutoff, quality).map(DirectForm2Transposed::new)
        };
        let section = |kind, quality| section(kind, quality).map_err(|_: biquad::Errors| CutoffError { cutoff, rate });
        Ok(Self {
            first: section(Type::SinglePoleLowPass, std::f64::consts::FRAC_1_SQRT_2)?,
            second: section(Type::LowPass, 1.0)?,
            rest: 0.0,
        })
    }

    /// Resets the filter to rest at `value`.
    pub fn settle(&mut self, value: f64) {
        self.first.reset_state();
        self.second.reset_state();
        // The gain at rest is 1, so shifting input and output by the same value changes nothing else.
        self.rest = value;
    }

    /// Ratio of the standard deviations of output and input for white noise, at most 1. It is the square root of the
    /// noise bandwidth, which is π/3 of the cutoff for this filter, over half of the sample rate.
    #[must_use]
    pub fn noise_gain(cutoff: f64, rate: f64) -> f64 {
        (std::f64::consts::FRAC_PI_3 * cutoff / (0.5 * rate)).min(1.0).sqrt()
    }

    /// Adds one sample and returns the filtered value.
    pub fn next(&mut self, value: f64) -> f64 {
        let off_rest = value - self.rest;
        let filtered = self.second.run(self.first.run(off_rest));
        // Subnormal numbers would remain forever because of rounding, and would slow down every tick.
        if off_rest == 0.0 && filtered.abs() < FADED {
            self.settle(self.rest);
            return self.rest;
        }
        self.rest + filtered
    }
}
