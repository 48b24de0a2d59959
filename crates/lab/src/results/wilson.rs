//! The 95 % interval of a rate. `xtask` contains this file too, so it uses nothing but the standard library.

/// The quantile of the normal distribution for an interval of 95 %.
const QUANTILE: f64 = 1.959_963_984_540_054;

/// The 95 % interval of the rate behind `count` of `runs`, after Wilson: all rates `p` from which the share is no farther
/// than 1.96 standard deviations of `p`. `None` without runs.
#[must_use]
pub(crate) fn wilson(count: u64, runs: u64) -> Option<[f64; 2]> {
    if runs == 0 {
        return None;
    }
    let (share, runs) = (count as f64 / runs as f64, runs as f64);
    let square = QUANTILE * QUANTILE / runs;
    let half = (square * (share * (1.0 - share) + square / 4.0)).sqrt();
    // Rounding must not exclude a rate of 0 or 1.
    Some([-half, half].map(|half| ((share + square / 2.0 + half) / (1.0 + square)).clamp(0.0, 1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_of_an_interval_are_1_96_standard_deviations_from_the_share() {
        for (passed, runs) in [(0, 50), (1, 3), (44, 50), (95, 200), (200, 200)] {
            let share = passed as f64 / runs as f64;
            for end in wilson(passed, runs).into_iter().flatten() {
                assert!((0.0..=1.0).contains(&end), "{end}");
                let deviation = (end * (1.0 - end) / runs as f64).sqrt();
                assert!(((end - share).abs() - QUANTILE * deviation).abs() < 1e-6, "{passed} of {runs}: {end}");
            }
        }
    }

    #[test]
    fn nothing_has_no_rate() {
        assert_eq!(wilson(0, 0), None);
    }
}
