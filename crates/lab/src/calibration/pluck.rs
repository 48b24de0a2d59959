//! The first mode of a whisker from its readings after a pluck.

use std::f64::consts::TAU;

use vibrissa_runtime::math;

/// The first mode of a whisker that was plucked: bent, and released in the air.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pluck {
    /// Frequency (Hz), without damping.
    pub first_mode: f64,
    /// Time (s) in which the amplitude decreases to 1/e.
    pub decay: f64,
    /// Share of the vibration that the mode does not explain, as a ratio of root mean squares.
    pub misfit: f64,
}

/// A reason why readings have no first mode.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PluckError {
    /// There are too few readings after the release.
    #[error("only {count} readings follow the release of the whisker; record at least {LEAST}, until it is at rest")]
    Short {
        /// Number of readings.
        count: usize,
    },
    /// The readings hardly change.
    #[error("the readings hardly change; bend the whisker by some 100 urad, and release it in the air")]
    Still,
    /// The whisker creeps back. Many pairs of a frequency and a decay have almost this motion.
    #[error(
        "the whisker does not swing (its damping ratio is {ratio:.1}), so its readings do not tell its first mode and its decay apart; \
         leave out `first_mode`, and state `damping`"
    )]
    Creeping {
        /// Damping ratio of the best mode.
        ratio: f64,
    },
    /// The readings are no vibration in one mode.
    #[error(
        "{:.0} % of the motion after the release is no vibration in one mode; release the whisker at once, on a platform at rest, with \
         nothing in reach", 100.0 * misfit
    )]
    Other {
        /// Share of the motion that the best mode does not explain.
        misfit: f64,
    },
}

/// Least number of readings after the release.
const LEAST: usize = 20;
/// Share of the readings at the end that show the rest.
const REST_SHARE: f64 = 0.1;
/// Least excursion, in standard deviations of the rest.
const LEAST_EXCURSION: f64 = 20.0;
/// Share of the excursion below which the rest of the readings is left out.
const FADED: f64 = 0.03;
/// Time (s) after the release in which higher modes decay. The second one of a uniform shaft is six times as fast as the first, and
/// the material damps it 39 times as much.
const HIGHER_MODES: f64 = 0.02;
/// The same as a share of the decay of the first mode: 39 times as much damping leaves 2 % of the second mode.
const HIGHER_SHARE: f64 = 0.1;
/// The first grid of frequencies (Hz) and of decays (s), with the logarithms of the ratios of neighbours.
const FREQUENCIES: (f64, f64) = (0.3, 150.0);
const DECAYS: (f64, f64) = (1e-3, 30.0);
const RATIO: (f64, f64) = (0.1, 0.4);
/// Time (s) of the first readings, to which the grid is fitted. Over a longer one, the fit of a frequency is narrower than the grid.
const HEAD: f64 = 0.3;
/// Steps of a refinement. Each that finds nothing better halves the next ones.
const REFINEMENTS: usize = 60;
/// Largest damping ratio of a mode that swings back visibly. The next half of a swing then has 5 % of the first.
const MOST_RATIO: f64 = 0.7;
/// Largest misfit of one mode.
const MOST_MISFIT: f64 = 0.2;

impl Pluck {
    /// The first mode from times (s, ascending) and readings (rad). Readings that are not finite are left out.
    ///
    /// A free mode and a constant are fitted to the readings after the release, by least squares.
    ///
    /// # Errors
    /// [`PluckError`] if the readings are not those of a plucked whisker.
    pub fn of(readings: &[(f64, f64)]) -> Result<Self, PluckError> {
        let finite = readings.iter().copied().filter(|(time, reading)| time.is_finite() && reading.is_finite());
        let readings: Vec<(f64, f64)> = finite.collect();
        let free = released(&readings, HIGHER_MODES)?;
        let wait = HIGHER_SHARE * fitted(free)?.1;
        // The higher modes of a strongly damped whisker decay sooner, and its first mode must not be over by then.
        let free = if wait < HIGHER_MODES { released(&readings, wait)? } else { free };
        let (first_mode, decay) = fitted(free)?;
        let least = misfit(free, first_mode, decay);
        if least > MOST_MISFIT {
            return Err(PluckError::Other { misfit: least });
        }
        let ratio = 1.0 / (TAU * first_mode * decay);
        if ratio > MOST_RATIO {
            return Err(PluckError::Creeping { ratio });
        }
        Ok(Self { first_mode, decay, misfit: least })
    }
}

/// The best frequency (Hz) and decay (s) for the readings of a free whisker.
fn fitted(free: &[(f64, f64)]) -> Result<(f64, f64), PluckError> {
    if free.len() < LEAST {
        return Err(PluckError::Short { count: free.len() });
    }
    let (begin, end) = (free[0].0, free[free.len() - 1].0);
    // A period of two readings cannot be told from slower ones.
    let fastest = FREQUENCIES.1.min(0.4 * (free.len() - 1) as f64 / (end - begin));
    let mut head = free.partition_point(|(time, _)| *time < begin + HEAD).max(LEAST);
    let mut found = coarse(&free[..head], fastest);
    loop {
        let head_time = free[head - 1].0 - begin;
        found = refined(&free[..head], found, (RATIO.0.min(0.25 / (found.0 * head_time)), RATIO.1));
        if head == free.len() {
            return Ok(found);
        }
        head = (2 * head).min(free.len());
    }
}

/// The best frequency (Hz) and decay (s) of a grid.
fn coarse(free: &[(f64, f64)], fastest: f64) -> (f64, f64) {
    let grid = |(least, greatest): (f64, f64), ratio: f64| {
        std::iter::successors(Some(least), move |value| Some(value * math::exp(ratio)))
            .take_while(move |value| *value < greatest)
    };
    let pairs = grid((FREQUENCIES.0, fastest), RATIO.0)
        .flat_map(|frequency| grid(DECAYS, RATIO.1).map(move |decay| (frequency, decay)));
    let rated = pairs.map(|pair| (misfit(free, pair.0, pair.1), pair));
    rated.min_by(|a, b| a.0.total_cmp(&b.0)).map_or((FREQUENCIES.0, DECAYS.0), |(_, pair)| pair)
}

/// A better frequency (Hz) and decay (s) near these, from steps of their logarithms that become smaller.
fn refined(free: &[(f64, f64)], (mut frequency, mut decay): (f64, f64), mut step: (f64, f64)) -> (f64, f64) {
    let mut least = misfit(free, frequency, decay);
    for _ in 0..REFINEMENTS {
        let around = [-1.0, 0.0, 1.0_f64];
        let near = around
            .iter()
            .flat_map(|f| around.map(|d| (frequency * math::exp(f * step.0), decay * math::exp(d * step.1))));
        let rated = near.map(|pair| (misfit(free, pair.0, pair.1), pair));
        match rated.min_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((better, pair)) if better < least => (least, (frequency, decay)) = (better, pair),
            _ => step = (0.5 * step.0, 0.5 * step.1),
        }
    }
    (frequency, decay)
}

/// The readings from `wait` (s) after the release until the vibration has faded.
fn released(readings: &[(f64, f64)], wait: f64) -> Result<&[(f64, f64)], PluckError> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
    let at_rest = (REST_SHARE * readings.len() as f64) as usize;
    if at_rest < 2 {
        return Err(PluckError::Short { count: readings.len() });
    }
    let end = &readings[readings.len() - at_rest..];
    let mean = end.iter().map(|(_, reading)| reading).sum::<f64>() / at_rest as f64;
    // The end of a slow decay still swings, and a fast vibration is in the differences. Each only adds to the noise.
    let rest = (end.iter().map(|(_, reading)| math::square(reading - mean)).sum::<f64>() / at_rest as f64).sqrt();
    let noise = rest.min(fourth_difference(readings));
    let off = |reading: &(f64, f64)| (reading.1 - mean).abs();
    // A held whisker hardly moves, and a released one moves fastest at first.
    let speeds = readings.windows(2).enumerate().map(|(index, pair)| (index, (pair[1].1 - pair[0].1).abs()));
    let release = speeds.max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(index, _)| index);
    let from = readings[release].0 + wait;
    let free = &readings[readings.partition_point(|(time, _)| *time < from)..];
    let excursion = free.iter().map(off).fold(0.0, f64::max);
    if excursion <= LEAST_EXCURSION * noise || excursion == 0.0 {
        return Err(PluckError::Still);
    }
    let faded = free.iter().rposition(|reading| off(reading) > FADED * excursion);
    // As much again shows the rest.
    Ok(&free[..free.len().min(LEAST.max(2 * faded.map_or(0, |last| last + 1)))])
}

/// Standard deviation of noise from the fourth differences of the readings, which a slow vibration hardly changes.
fn fourth_difference(readings: &[(f64, f64)]) -> f64 {
    // The sum of the squared coefficients is the variance of the difference of independent readings.
    const COEFFICIENTS: [f64; 5] = [1.0, -4.0, 6.0, -4.0, 1.0];
    let variance: f64 = COEFFICIENTS.iter().map(|coefficient| coefficient * coefficient).sum();
    let difference =
        |five: &[(f64, f64)]| five.iter().zip(COEFFICIENTS).map(|((_, reading), share)| reading * share).sum::<f64>();
    let squares: Vec<f64> = readings.windows(5).map(|five| math::square(difference(five))).collect();
    (squares.iter().sum::<f64>() / (variance * squares.len().max(1) as f64)).sqrt()
}

/// The root mean square of what a mode and a constant do not explain, over that of the readings about their mean.
fn misfit(free: &[(f64, f64)], frequency: f64, decay: f64) -> f64 {
    let begin = free.first().map_or(0.0, |(time, _)| *time);
    let (angular, rate) = (TAU * frequency, decay.recip());
    let swing = (angular * angular - rate * rate).abs().sqrt();
    let modes = |time: f64| {
        let time = time - begin;
        if angular > rate {
            let fading = math::exp(-rate * time);
            [fading * math::cos(swing * time), fading * math::sin(swing * time), 1.0]
        } else {
            // The product of both rates is the square of the frequency. This form has no difference of near numbers.
            let fast = rate + swing;
            [math::exp(-angular * angular / fast * time), math::exp(-fast * time), 1.0]
        }
    };
    let (mut normal, mut moment, mut sums) = (nalgebra::Matrix3::zeros(), nalgebra::Vector3::zeros(), (0.0, 0.0));
    for (time, reading) in free {
        let mode = nalgebra::Vector3::from(modes(*time));
        normal += mode * mode.transpose();
        moment += *reading * mode;
        sums = (sums.0 + reading, sums.1 + reading * reading);
    }
    let count = free.len() as f64;
    let variation = sums.1 - sums.0 * sums.0 / count;
    // Two modes that are almost one have no inverse.
    normal += nalgebra::Matrix3::identity() * (1e-12 * count);
    let Some(inverse) = normal.try_inverse() else { return f64::INFINITY };
    let amplitudes = inverse * moment;
    // A whisker that is released at rest has more of the slow part than of the fast one: the speeds of both cancel.
    if angular <= rate && amplitudes[1].abs() > amplitudes[0].abs() {
        return f64::INFINITY;
    }
    let explained = moment.dot(&amplitudes);
    let share = (sums.1 - explained).max(0.0) / variation;
    if share.is_finite() { share.sqrt() } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use proptest::prelude::*;

    use super::*;

    /// Readings at 300 Hz of a whisker that is held for half a second and released. It obeys the equation of a damped oscillator, which is
    /// integrated in small steps.
    fn plucked(frequency: f64, decay: f64, noise: impl Fn(u32) -> f64) -> Vec<(f64, f64)> {
        let (mut angle, mut rate) = (200e-6, 0.0);
        let (angular, steps) = (TAU * frequency, 400_u32);
        let step = 1.0 / (300.0 * f64::from(steps));
        (0..1500)
            .map(|index| {
                for _ in 0..if index < 150 { 0 } else { steps } {
                    rate -= step * (angular * angular * angle + 2.0 / decay * rate);
                    angle += step * rate;
                }
                (f64::from(index) / 300.0, 3e-6 + angle + noise(index))
            })
            .collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40))]

        #[test]
        fn the_first_mode_of_a_whisker_that_swings_is_found(frequency in 3.0..20.0_f64, ratio in 0.01..2.0_f64) {
            let decay = 1.0 / (ratio * TAU * frequency);
            let noise = |index: u32| 0.5e-6 * math::sin(f64::from(index) * 2.4);
            match Pluck::of(&plucked(frequency, decay, noise)) {
                Ok(found) => {
                    prop_assert!(ratio < 0.8, "{found:?} for a damping ratio of {ratio}");
                    prop_assert!((found.first_mode / frequency - 1.0).abs() < 0.03, "{found:?} {frequency} {decay}");
                    prop_assert!((found.decay / decay - 1.0).abs() < 0.1, "{found:?} {frequency} {decay}");
                }
                // What creeps back is over before enough of it is seen, or has the motion of many modes.
                Err(error) => {
                    prop_assert!(ratio > 0.6, "{error:?} for a damping ratio of {ratio}");
                }
            }
        }
    }

    #[test]
    fn readings_that_are_no_pluck_are_refused() {
        assert!(matches!(Pluck::of(&[]), Err(PluckError::Short { count: 0 })));
        let still: Vec<_> =
            (0..300_u32).map(|index| (f64::from(index) / 300.0, 1e-6 * math::sin(f64::from(index) * 2.4))).collect();
        assert_eq!(Pluck::of(&still), Err(PluckError::Still));
        let ramp = (0..600_u32).map(|index| {
            let time = f64::from(index) / 300.0;
            (time, if time < 1.0 { 0.0 } else { 1e-4 * math::sin(time * 7.0).signum() * (2.0 - time) })
        });
        assert!(matches!(Pluck::of(&ramp.collect::<Vec<_>>()), Err(PluckError::Other { .. } | PluckError::Still)));
    }
}
