//! Statements about shares of random scenes.

/// The quantile of the normal distribution for an interval of 95 %.
const QUANTILE: f64 = 1.959_963_984_540_054;

/// The 95 % interval of a share, after Wilson: all shares `p` from which `passed / runs` is no farther than 1.96 standard
/// deviations of `p`.
pub(super) fn interval(passed: u64, runs: u64) -> [f64; 2] {
    let (share, runs) = (passed as f64 / runs as f64, runs as f64);
    let square = QUANTILE * QUANTILE / runs;
    let half = (square * (share * (1.0 - share) + square / 4.0)).sqrt();
    [-half, half].map(|half| (share + square / 2.0 + half) / (1.0 + square))
}

/// The probability that of `lost + gained` changed verdicts at least as many are on one side, if both sides are equally likely
/// (the exact two-sided sign test).
pub(super) fn sign_test(lost: u64, gained: u64) -> f64 {
    let (all, most) = (lost + gained, lost.max(gained));
    // The probability that `side` of them are on one side, from the one before, as a logarithm: it may be tiny.
    let mut log = -(all as f64) * std::f64::consts::LN_2;
    let mut sum = 0.0;
    for side in 0..=all {
        if side >= most {
            sum += log.exp();
        }
        log += ((all - side) as f64 / (side + 1) as f64).ln();
    }
    (2.0 * sum).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_of_an_interval_are_1_96_standard_deviations_from_the_share() {
        for (passed, runs) in [(0, 50), (1, 3), (44, 50), (95, 200), (200, 200)] {
            let share = passed as f64 / runs as f64;
            for end in interval(passed, runs) {
                assert!((-1e-12..=1.0 + 1e-12).contains(&end), "{end}");
                let deviation = (end * (1.0 - end) / runs as f64).max(0.0).sqrt();
                assert!(((end - share).abs() - QUANTILE * deviation).abs() < 1e-6, "{passed} of {runs}: {end}");
            }
        }
    }

    /// Each bit is a changed verdict. All patterns are equally likely.
    #[test]
    fn the_sign_test_is_the_share_of_patterns_that_are_as_one_sided() {
        for (lost, gained) in [(0_u64, 1_u64), (5, 0), (3, 3), (9, 1), (2, 7), (12, 4)] {
            let all = lost + gained;
            let patterns = (0..1_u32 << all).filter(|pattern| {
                let ones = u64::from(pattern.count_ones());
                ones.max(all - ones) >= lost.max(gained)
            });
            let expected = patterns.count() as f64 / f64::from(1_u32 << all);
            assert!((sign_test(lost, gained) - expected).abs() < 1e-12, "{lost} and {gained}");
        }
        assert!((sign_test(0, 0) - 1.0).abs() < 1e-12);
        assert!(sign_test(2000, 0) < 1e-300 && (sign_test(1000, 1000) - 1.0).abs() < 1e-9);
    }
}
