//! The significance of changed verdicts.

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
