//! The demands of the machine and of the device on the rates of the loop.

use vibrissa_runtime::machine::{Needs, RateRange};

use super::rates::{Limits, Rates, TOLERANCE, highest_rate};
use super::refusal::Shortfall;

/// Largest share of a sample period for a round. The tick that uses the round begins a little later.
const ROUND_SHARE: f64 = 0.4;

/// The demands on the rates of the loop.
#[derive(Debug, Clone, Copy)]
pub(super) struct Demands {
    /// The needs of the machine.
    pub(super) needs: Needs,
    /// The longest round of all buses, if it was measured.
    pub(super) round: Option<LongestRound>,
    /// Age of a value when it is read, and the lateness of the loop (s).
    pub(super) latency: f64,
    /// Longest time from the end of a tick to the end of the next (s).
    pub(super) deadline: f64,
}

/// The longest round of all buses.
#[derive(Debug, Clone, Copy)]
pub(super) struct LongestRound {
    /// Index of the bus.
    pub(super) bus: usize,
    /// Time of the round (µs).
    pub(super) time_us: u32,
    /// Clock of the bus (kHz).
    pub(super) clock_khz: u32,
}

impl Demands {
    /// Checks rates of the loop. `tick` gives the longest tick (s) that takes a number of rounds.
    ///
    /// # Errors
    /// The first [`Shortfall`].
    pub(super) fn check(&self, rates: Rates, mut tick: impl FnMut(u32) -> f64) -> Result<(), Shortfall> {
        self.needs.check_rates(rates.control, rates.sample)?;
        self.check_round(rates.sample)?;
        self.check_age(rates.sample)?;
        highest_rate(rates.control, rates.control, tick(rates.rounds), self.deadline)?;
        Ok(())
    }

    /// The rates that are not above the `configured` ones and meet all demands except those on a tick.
    ///
    /// # Errors
    /// [`Shortfall`] if there are none.
    pub(super) fn limits(&self, configured: Rates) -> Result<Limits, Shortfall> {
        let allowed = |range: Option<RateRange>, rate: f64| {
            range.map_or(RateRange::only(rate), |range| RateRange { low: range.low, high: range.high.min(rate) })
        };
        let control = allowed(self.needs.control_rate, configured.control);
        let mut sample = allowed(self.needs.sample_rate, configured.sample);
        // A configured rate that is too low stays so.
        self.needs.check_rates(control.high, sample.high)?;
        self.check_round(sample.low)?;
        if let Some(round) = &self.round {
            sample.high = sample.high.min(ROUND_SHARE / round.time());
        }
        self.check_age(sample.high)?;
        if let Some(age) = self.needs.sample_age {
            sample.low = sample.low.max((age - self.latency).recip());
        }
        Ok(Limits { control, sample, deadline: self.deadline })
    }

    /// Checks that the longest round leaves enough of a sample period at `rate` (Hz).
    fn check_round(&self, rate: f64) -> Result<(), Shortfall> {
        match self.round {
            Some(round) if round.time() * rate > ROUND_SHARE * (1.0 + TOLERANCE) => {
                let LongestRound { bus, time_us, clock_khz } = round;
                Err(Shortfall::Bus { bus, time_us, clock_khz, period: rate.recip() })
            }
            _ => Ok(()),
        }
    }

    /// Checks the age of samples at `rate` (Hz). Before its successor is read, a sample becomes older by a sample period.
    fn check_age(&self, rate: f64) -> Result<(), Shortfall> {
        let age = self.latency + rate.recip();
        match self.needs.sample_age {
            Some(most) if age > most * (1.0 + TOLERANCE) => Err(Shortfall::Age { age, most }),
            _ => Ok(()),
        }
    }
}

impl LongestRound {
    /// Its time (s).
    fn time(&self) -> f64 {
        f64::from(self.time_us) * 1e-6
    }
}
