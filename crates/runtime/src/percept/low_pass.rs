//! A low-pass filter for base angles.

use std::f64::consts::PI;

use biquad::{Biquad, Coefficients, DirectForm2Transposed};

use crate::math;

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
        let is_valid = rate > 0.0 && cutoff > 0.0 && 2.0 * cutoff < rate;
        if !is_valid {
            return Err(CutoffError { cutoff, rate });
        }
        let angle = PI * (2.0 * cutoff / rate);
        Ok(Self {
            first: DirectForm2Transposed::new(first_order(angle)),
            second: DirectForm2Transposed::new(second_order(angle)),
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
        math::min(std::f64::consts::FRAC_PI_3 * cutoff / (0.5 * rate), 1.0).sqrt()
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

/// The first-order section by the bilinear transform, for the rotation `angle` (rad) of the cutoff frequency per sample.
///
/// The functions of biquad that compute coefficients call the functions of the platform.
fn first_order(angle: f64) -> Coefficients<f64> {
    let tan = math::tan(angle / 2.0);
    let gain = tan / (1.0 + tan);
    Coefficients { a1: (tan - 1.0) / (1.0 + tan), a2: 0.0, b0: gain, b1: gain, b2: 0.0 }
}

/// The second-order section of quality 1 by the bilinear transform, for the rotation `angle` (rad) of the cutoff
/// frequency per sample (Bristow-Johnson, Audio EQ Cookbook).
fn second_order(angle: f64) -> Coefficients<f64> {
    let (sin, cos) = math::sin_cos(angle);
    let scale = (1.0 + 0.5 * sin).recip();
    let gain = 0.5 * (1.0 - cos) * scale;
    Coefficients { a1: -2.0 * cos * scale, a2: (1.0 - 0.5 * sin) * scale, b0: gain, b1: 2.0 * gain, b2: gain }
}
