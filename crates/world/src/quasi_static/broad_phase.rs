//! The search for features of a whisker and of the surfaces that are near each other.

use super::contact::{FeaturePair, Pair, link_coordinates};
use super::rod::{Rod, Shape};
use super::surface::{Facet, Junction, Surfaces};
use super::whisker::MAX_DESCENT;

/// The distances (m) of a search.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Distances {
    /// Facets are searched within this distance of the whisker.
    search: f64,
    /// Feature pairs that are closer than this are tracked individually.
    pair: f64,
    /// The search is repeated if the clearance of the remaining pairs falls below this.
    repeat: f64,
}

/// Usual distances. Searches are rare.
const WIDE: Distances = Distances { search: 20e-3, pair: 5e-3, repeat: 1e-3 };
/// The distances near crowded facets. The number of pairs is limited, and searches are more frequent. The clearance still
/// exceeds a descent step.
const NARROW: Distances = Distances { search: 0.8e-3, pair: 0.8e-3, repeat: 0.35e-3 };
const _: () = assert!(NARROW.repeat > MAX_DESCENT);

/// How far features are from each other that no pair has.
#[derive(Debug, Clone, Copy)]
pub(super) struct Clearance {
    /// A lower bound (m) of the distance.
    pub(super) clear: f64,
    /// The distance (m) below which the search must be repeated.
    repeat: f64,
}

impl Clearance {
    /// Before the first search.
    pub(super) const UNKNOWN: Self = Self { clear: 0.0, repeat: f64::INFINITY };

    /// True if the search must be repeated.
    pub(super) fn is_used_up(&self) -> bool {
        self.clear < self.repeat
    }
}

/// Finds all feature pairs that are near each other. The state of pairs that were already in `pairs` is kept.
pub(super) fn broad_phase(rod: &Rod, shape: &Shape, surfaces: &Surfaces, pairs: &mut Vec<Pair>) -> Clearance {
    let mut previous = std::mem::take(pairs);
    previous.sort_unstable_by_key(Pair::key);
    let mut search = Search { rod, shape, pairs, previous: &previous, distances: WIDE, clear: WIDE.search };
    let is_crowded = surfaces.near(shape.bounds(), WIDE.search).any(|(index, facet)| {
        (0..rod.links()).for_each(|link| search.add(link, index, facet));
        facet.is_crowded
    });
    if is_crowded {
        search.pairs.clear();
        (search.distances, search.clear) = (NARROW, NARROW.search);
        for link in 0..rod.links() {
            let margin = NARROW.search + rod.radius(link).max(rod.end_radius(link));
            surfaces.near(shape.bounds_of(link), margin).for_each(|(index, facet)| search.add(link, index, facet));
        }
    }
    Clearance { clear: search.clear, repeat: search.distances.repeat }
}

/// A search that is going on.
struct Search<'s> {
    rod: &'s Rod,
    shape: &'s Shape,
    pairs: &'s mut Vec<Pair>,
    /// The pairs before the search, ascending by their keys.
    previous: &'s [Pair],
    distances: Distances,
    clear: f64,
}

impl Search<'_> {
    /// Adds the features of a link and a facet that are near each other.
    fn add(&mut self, link: usize, index: usize, facet: &Facet) {
        let (rod, shape) = (self.rod, self.shape);
        let (start, end) = (shape.ends[link], shape.ends[link + 1]);
        let rest = facet.distance(nalgebra::center(&start, &end)) - 0.5 * rod.link - rod.radius(link);
        if rest > self.distances.pair {
            self.clear = self.clear.min(rest);
            return;
        }
        let radius = rod.end_radius(link);
        self.add_pair(link, FeaturePair::EndOnFacet(index, facet.is_outside(end)), facet.distance(end) - radius);
        if let Junction::Convex(corner) = facet.junction {
            self.add_pair(link, FeaturePair::EndOnCorner(index), (end - corner.point).norm() - radius);
            let (along, aside) = link_coordinates(shape, link, corner.point);
            let nearest = start + along.clamp(0.0, rod.link) * shape.tangents[link];
            let distance = (corner.point - nearest).norm() - rod.radius(link);
            self.add_pair(link, FeaturePair::SideOnCorner(index, aside.signum()), distance);
        }
        if let Some((centre, bulge)) = facet.bulge() {
            let (along, _) = link_coordinates(shape, link, centre);
            let nearest = start + along.clamp(0.0, rod.link) * shape.tangents[link];
            let gap = (centre - nearest).norm() - bulge - rod.radius(link);
            self.add_pair(link, FeaturePair::SideOnBulge(index), gap.abs());
        }
    }

    fn add_pair(&mut self, link: usize, features: FeaturePair, distance: f64) {
        if distance >= self.distances.pair {
            self.clear = self.clear.min(distance);
            return;
        }
        let new = Pair::new(link, features);
        let known = self.previous.binary_search_by_key(&new.key(), Pair::key).ok();
        self.pairs.push(known.map_or(new, |known| self.previous[known]));
    }
}
