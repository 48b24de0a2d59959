//! A loop that runs slower than configured.

use std::fmt;

use vibrissa_runtime::units::{Dimension, format_si};

use super::refusal::Shortfall;

/// A loop that runs slower than configured, because the device does not meet a need at the configured rates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slower {
    /// Control rate and sample rate of the loop (Hz).
    pub rates: [f64; 2],
    /// The configured rates (Hz).
    pub configured: [f64; 2],
    /// The need that is not met at these.
    pub shortfall: Shortfall,
}

impl fmt::Display for Slower {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rate = |rate: f64| format_si((rate * 10.0).round() / 10.0, Dimension::FREQUENCY);
        let ([control, sample], [configured, configured_sample]) = (self.rates.map(rate), self.configured.map(rate));
        write!(
            formatter,
            "the loop runs at {control} with samples at {sample}, instead of {configured} and {configured_sample}, as the \
             policy allows: {}",
            self.shortfall
        )
    }
}
