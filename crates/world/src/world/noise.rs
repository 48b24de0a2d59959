//! Normal noise.

use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Open01, StandardNormal};
use vibrissa_runtime::math;

/// Where the tail of [`StandardNormal`] begins. It is R of the ziggurat with 256 strips by Marsaglia and Tsang.
const TAIL: f64 = 3.654_152_885_361_009;

/// Normal noise with mean 0, and with the same bits on every target. By default there is none.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Noise {
    /// The standard deviation. With 0, no random number is drawn.
    spread: f64,
}

impl Noise {
    /// Noise with this standard deviation. There is none if it is not a positive number.
    pub(super) fn new(spread: f64) -> Self {
        Self { spread: if spread.is_finite() && spread > 0.0 { spread } else { 0.0 } }
    }

    /// The next value.
    pub(super) fn draw(self, random: &mut ChaCha8Rng) -> f64 {
        if self.spread > 0.0 { self.spread * standard_normal(random) } else { 0.0 }
    }
}

/// A value of [`StandardNormal`]. Those in the tail are logarithms, which are computed here and not by the platform.
fn standard_normal(random: &mut ChaCha8Rng) -> f64 {
    let value: f64 = StandardNormal.sample(random);
    if value.abs() < TAIL {
        return value;
    }
    // The last two numbers of 64 bits decided on the value. It follows from the first of them.
    let after = random.get_word_pos();
    random.set_word_pos(after.wrapping_sub(4));
    let uniform: f64 = Open01.sample(random);
    random.set_word_pos(after);
    (TAIL - math::ln(uniform) / TAIL).copysign(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_chacha::rand_core::SeedableRng;

    #[test]
    fn the_values_are_those_of_the_standard_normal_distribution_also_in_its_tail() {
        let (mut ours, mut theirs) = (ChaCha8Rng::seed_from_u64(1), ChaCha8Rng::seed_from_u64(1));
        let mut tail = 0;
        for _ in 0..200_000 {
            let expected: f64 = StandardNormal.sample(&mut theirs);
            let found = standard_normal(&mut ours);
            assert!((found - expected).abs() <= 2.0 * f64::EPSILON * expected.abs(), "{found} {expected}");
            assert_eq!(ours.get_word_pos(), theirs.get_word_pos());
            tail += usize::from(expected.abs() >= TAIL);
        }
        // 2.6e-4 of all values.
        assert!((25..80).contains(&tail), "{tail}");
    }
}
