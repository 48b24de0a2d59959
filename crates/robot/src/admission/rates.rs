//! The search for the rates of the loop.

use vibrissa_runtime::machine::RateRange;

use super::refusal::Shortfall;
use crate::config::MAX_ROUNDS;

/// Largest share of a control period for a tick.
const TICK_SHARE: f64 = 0.5;
/// Relative difference up to which two rates or times count as equal.
pub(super) const TOLERANCE: f64 = 1e-9;

/// Rates of the loop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rates {
    /// Control rate (Hz).
    pub(super) control: f64,
    /// Sample rate (Hz).
    pub(super) sample: f64,
    /// Acquisition rounds in a control period.
    pub(super) rounds: u32,
}

/// The rates from which the search may choose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Limits {
    /// Control rates.
    pub(super) control: RateRange,
    /// Sample rates.
    pub(super) sample: RateRange,
    /// Longest time from the end of a tick to the end of the next (s).
    pub(super) deadline: f64,
}

impl Limits {
    /// The highest control rate that the device holds, and the highest sample rate for it. `tick` gives the longest tick
    /// (s) that takes a number of rounds. The control rate is a whole number of hertz unless the limits exclude that.
    ///
    /// # Errors
    /// The [`Shortfall`] that excludes the rates that the device holds best. `None` if no sample rate is a whole multiple of a
    /// control rate.
    pub(super) fn fastest(&self, mut tick: impl FnMut(u32) -> f64) -> Result<Rates, Option<Shortfall>> {
        let (mut best, mut closest): (Option<Rates>, _) = (None, (f64::INFINITY, None));
        for rounds in 1..=MAX_ROUNDS {
            let count = f64::from(rounds);
            let low = self.control.low.max(self.sample.low / count);
            let high = self.control.high.min(self.sample.high / count);
            // With more rounds, the highest control rate only decreases.
            if best.is_some_and(|best| high < best.control * (1.0 - TOLERANCE)) {
                break;
            }
            if low > high * (1.0 + TOLERANCE) {
                continue;
            }
            let tick = tick(rounds);
            match highest_rate(low, high, tick, self.deadline) {
                Ok(control) if best.is_none_or(|best| control >= best.control) => {
                    best = Some(Rates { control, sample: (control * count).min(self.sample.high), rounds });
                }
                Err(shortfall) if tick * low < closest.0 => closest = (tick * low, Some(shortfall)),
                _ => {}
            }
        }
        best.ok_or(closest.1)
    }
}

/// The highest control rate (Hz) from `low` to `high` at which a tick of `tick` seconds leaves half of the period, and ends
/// within `deadline` seconds of the one before it. It is a whole number unless that is excluded.
///
/// # Errors
/// The [`Shortfall`] at all of these rates.
pub(super) fn highest_rate(low: f64, high: f64, tick: f64, deadline: f64) -> Result<f64, Shortfall> {
    if tick * low > TICK_SHARE * (1.0 + TOLERANCE) {
        return Err(Shortfall::Tick { tick, period: low.recip() });
    }
    let high = high.min(TICK_SHARE / tick).max(low);
    let longest_period = deadline - tick;
    if longest_period * high < 1.0 - TOLERANCE {
        return Err(Shortfall::Deadline { tick, period: high.recip() });
    }
    Ok(high.floor().max(low).max(longest_period.recip().min(high)))
}
