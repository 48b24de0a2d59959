//! Exponents of costs.

use vibrissa_runtime::math;

use super::row::SizeTime;

/// The exponent `p` of a cost that grows as `size^p`: the slope between the two largest sizes on logarithmic axes. Fixed
/// costs hide it at smaller sizes. `None` with fewer than two sizes, or without a positive time.
pub(super) fn exponent(times: &[SizeTime]) -> Option<f64> {
    let mut sorted: Vec<&SizeTime> = times.iter().collect();
    sorted.sort_by_key(|time| time.size);
    let [.., smaller, larger] = sorted[..] else { return None };
    let slope = math::ln(larger.time_s / smaller.time_s) / math::ln(larger.size as f64 / smaller.size as f64);
    slope.is_finite().then_some(slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn times(cost: impl Fn(f64) -> f64) -> Vec<SizeTime> {
        [1000, 10, 100].map(|size| SizeTime { size, time_s: cost(size as f64) }).into()
    }

    #[test]
    fn the_exponent_of_an_exact_power_law_is_found() {
        for exponent in [-1.0, 0.0, 0.5, 1.0, 2.0, 3.0] {
            let found = super::exponent(&times(|size| 0.02 * math::powf(size, exponent)));
            assert!(found.is_some_and(|found| (found - exponent).abs() < 1e-12), "{exponent}: {found:?}");
        }
    }

    #[test]
    fn a_fixed_cost_that_matters_only_at_small_sizes_hardly_changes_the_exponent() {
        let found = exponent(&times(|size| 1e-3 + 1e-6 * size * size));
        assert!(found.is_some_and(|found| (1.9..2.0).contains(&found)), "{found:?}");
    }

    #[test]
    fn one_size_has_no_exponent() {
        assert_eq!(exponent(&times(|size| size)[..1]), None);
        assert_eq!(exponent(&[]), None);
    }
}
