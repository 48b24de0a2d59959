//! Positions on a line with preferred values and least distances.

/// A preferred position of an element on a line.
#[derive(Clone, Copy)]
pub(super) struct Wish {
    /// The preferred position.
    pub(super) position: f64,
    /// The weight.
    pub(super) weight: f64,
    /// The least distance to the previous element.
    pub(super) distance: f64,
}

/// The positions with the least weighted sum of squared deviations from the preferred positions. They are in the given
/// order and at least at their distances.
///
/// After subtraction of the distances, positions must not decrease. This is an isotonic regression, solved by pooling
/// adjacent violators.
pub(super) fn settle(wishes: &[Wish]) -> Vec<f64> {
    let mut offset = 0.0;
    let mut offsets = Vec::with_capacity(wishes.len());
    // Pools of neighbours: the position, the weight, the number of elements.
    let mut pools: Vec<(f64, f64, usize)> = Vec::new();
    for (index, wish) in wishes.iter().enumerate() {
        offset += if index == 0 { 0.0 } else { wish.distance };
        offsets.push(offset);
        let mut pool = (wish.position - offset, wish.weight, 1);
        while let Some(&(position, weight, count)) = pools.last()
            && position > pool.0
        {
            pools.pop();
            pool = ((position * weight + pool.0 * pool.1) / (weight + pool.1), weight + pool.1, count + pool.2);
        }
        pools.push(pool);
    }
    let positions = pools.iter().flat_map(|&(position, _, count)| std::iter::repeat_n(position, count));
    positions.zip(offsets).map(|(position, offset)| position + offset).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wish(position: f64) -> Wish {
        Wish { position, weight: 1.0, distance: 10.0 }
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
