//! The neutral values of the whiskers, measured at the start.

use vibrissa_runtime::signal::MAX_WHISKERS;

use super::zero::{Moving, Zero};

/// Measures the neutral value of every whisker over the first rounds, in which nothing may touch them. The sensor's
/// offset drifts by up to 1000 counts with temperature, so it is measured in every session.
#[derive(Debug, Clone)]
pub struct Zeroing {
    whiskers: Vec<Zero>,
}

/// Values of each whisker for its neutral value: one second.
const VALUES: u32 = 300;

/// A whisker whose neutral value cannot be measured.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the neutral value of whisker {whisker} (counted from 0) cannot be measured: {cause}")]
pub struct ZeroingFault {
    /// Index of the whisker in the rig.
    pub whisker: usize,
    cause: Moving,
}

impl Zeroing {
    /// Begins a measurement of this many whiskers. The values (counts) of one at rest differ by at most `largest_spread`.
    #[must_use]
    pub fn new(count: usize, largest_spread: u32) -> Self {
        Self { whiskers: vec![Zero::new(VALUES, largest_spread); count.min(MAX_WHISKERS)] }
    }

    /// Adds a value (counts) of a whisker.
    pub fn take(&mut self, whisker: usize, counts: i32) {
        if let Some(zero) = self.whiskers.get_mut(whisker) {
            zero.add(counts);
        }
    }

    /// The neutral values (counts), once every whisker has enough values.
    ///
    /// # Errors
    /// [`ZeroingFault`] if a whisker moves.
    pub fn finish(&self) -> Result<Option<[f64; MAX_WHISKERS]>, ZeroingFault> {
        let mut neutral = [0.0; MAX_WHISKERS];
        let mut is_complete = true;
        for (whisker, (zero, neutral)) in self.whiskers.iter().zip(&mut neutral).enumerate() {
            match zero.estimate() {
                Ok(Some(mean_counts)) => *neutral = f64::from(mean_counts),
                Ok(None) => is_complete = false,
                Err(cause) => return Err(ZeroingFault { whisker, cause }),
            }
        }
        Ok(is_complete.then_some(neutral))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use super::*;

    #[test]
    fn the_neutral_value_is_the_mean_and_a_whisker_that_moves_is_refused() {
        let mut zeroing = Zeroing::new(2, 300);
        for index in 0..300 {
            zeroing.take(0, 1000 + (index % 2) * 10);
            assert_eq!(zeroing.finish(), Ok(None));
            zeroing.take(1, -500);
        }
        let neutral = zeroing.finish().unwrap().unwrap();
        assert!((neutral[0] - 1005.0).abs() < 1e-3 && (neutral[1] + 500.0).abs() < 1e-3);
        zeroing.take(1, -900);
        assert_eq!(zeroing.finish().unwrap_err().whisker, 1);
    }
}
