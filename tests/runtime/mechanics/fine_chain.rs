//! The chain comes to the elastica as its links become more.

use nalgebra::Vector2;
use proptest::prelude::*;
use vibrissa_runtime::mechanics::{Equilibrium, ShaftChain, ShaftShape};
use vibrissa_runtime::rig::Whisker;

use crate::mechanics::whisker::{any_tapered, bent, with_ratio};

/// The tip (m) of the whisker's chain with so many links, at the base angle and the direction of a bend. Of several equilibria it is
/// the one near that bend, if there is one.
fn chain_tip(whisker: &Whisker, links: usize, bend: &ShaftShape) -> Option<Vector2<f64>> {
    let mut whisker = whisker.clone();
    whisker.shaft.links = links;
    let chain = ShaftChain::new(&whisker);
    let near = Equilibrium { force: bend.force, tip_angle: bend.tip_angle, ..chain.at_rest() };
    chain.solve(bend.base_angle, bend.force_direction, &near).map(|solution| solution.tip_base)
}

#[test]
fn the_chain_comes_nearer_with_the_square_of_its_links() {
    let mut whisker = with_ratio(0.1, 0.125e-3, 5e3);
    for (taper, moment, direction) in
        [(1.0, 0.5, 1.6), (1.0, 1.6, 2.88), (1.0, 2.5, 2.6), (0.5, 1.6, 2.88), (0.3, 2.5, 2.0)]
    {
        whisker.shaft.tip_radius = Some(taper * whisker.shaft.radius);
        let bend = bent(&whisker, 0.1, moment, direction).unwrap();
        let errors =
            [16, 32, 64, 128, 256].map(|links| (chain_tip(&whisker, links, &bend).unwrap() - bend.tip_base).norm());
        for pair in errors.windows(2) {
            assert!(((pair[0] / pair[1]).log2() - 2.0).abs() < 0.03, "{taper} {moment} {direction}: {errors:?}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn a_fine_chain_extrapolated_is_the_elastica(
        whisker in any_tapered(), moment in 0.05..2.5_f64, direction in 1.2..2.9_f64,
    ) {
        let bend = bent(&whisker, whisker.shaft.length, moment, direction).unwrap();
        let [coarse, fine] = [200, 400].map(|links| chain_tip(&whisker, links, &bend));
        prop_assert!(coarse.is_some() && fine.is_some(), "{bend:?}");
        let (coarse, fine) = (coarse.unwrap(), fine.unwrap());
        let limit = fine + (fine - coarse) / 3.0;
        prop_assert!((limit - bend.tip_base).norm() < 1e-7 * whisker.shaft.length, "{bend:?} {limit}");
    }
}
