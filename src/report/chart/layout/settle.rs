//! Places on a line for things that want to be somewhere and keep each other off.

/// A thing on a line.
#[derive(Clone, Copy)]
pub(super) struct Wish {
    /// Where it wants to be.
    pub(super) place: f64,
    /// How much.
    pub(super) weight: f64,
    /// The least distance to the thing before it.
    pub(super) distance: f64,
}

/// The places, in the order given and at least their distances apart, that make the weighted squares of what they are off the
/// wishes least in sum.
///
/// Less the distances, places must not decrease: an isotonic regression, solved by pooling neighbours that violate the order.
pub(super) fn settle(wishes: &[Wish]) -> Vec<f64> {
    let mut offset = 0.0;
    let mut offsets = Vec::with_capacity(wishes.len());
    // Pools of neighbours at one place: the place, the weight, how many.
    let mut pools: Vec<(f64, f64, usize)> = Vec::new();
    for (index, wish) in wishes.iter().enumerate() {
        offset += if index == 0 { 0.0 } else { wish.distance };
        offsets.push(offset);
        let mut pool = (wish.place - offset, wish.weight, 1);
        while let Some(&(place, weight, count)) = pools.last()
            && place > pool.0
        {
            pools.pop();
            pool = ((place * weight + pool.0 * pool.1) / (weight + pool.1), weight + pool.1, count + pool.2);
        }
        pools.push(pool);
    }
    let places = pools.iter().flat_map(|&(place, _, count)| std::iter::repeat_n(place, count));
    places.zip(offsets).map(|(place, offset)| place + offset).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wish(place: f64) -> Wish {
        Wish { place, weight: 1.0, distance: 10.0 }
    }

    #[test]
    fn wishes_that_agree_are_granted() {
        assert_eq!(settle(&[wish(0.0), wish(10.0), wish(50.0)]), [0.0, 10.0, 50.0]);
    }

    #[test]
    fn wishes_that_clash_are_off_by_the_same() {
        assert_eq!(settle(&[wish(5.0), wish(5.0), wish(100.0)]), [0.0, 10.0, 100.0]);
        assert_eq!(settle(&[wish(20.0), wish(0.0)]), [5.0, 15.0]);
    }

    #[test]
    fn the_greater_weight_moves_less() {
        let heavy = Wish { weight: 3.0, ..wish(0.0) };
        assert_eq!(settle(&[heavy, wish(2.0)]), [-2.0, 8.0]);
    }
}
