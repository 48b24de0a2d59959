//! Which part of a shaft may touch first.

use crate::geometry::{Point2, Pose, perpendicular, unit};

use super::cells::{Cell, Cells};

/// The part of a straight shaft that was not proved free when it began to bend. The first contact is there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FirstTouch {
    /// Ends of that part (m, world frame), the nearer to the base first.
    pub ends: [Point2; 2],
    /// Distances of these ends from the base (m).
    pub distances: [f64; 2],
    /// True if that part reaches the tip.
    pub reaches_tip: bool,
}

/// Positions, each a cell long, by which the part is longer than what was seen at the centres of cells.
const AROUND: i32 = 2;
/// Most positions along a shaft that are looked at.
const MOST_PLACES: f64 = 512.0;

impl FirstTouch {
    /// The part of a straight shaft of this length (m) that is not beside free cells. `side` is +1 if the object is to the left of
    /// the shaft, −1 if it is to the right. `None` if all of it is beside free cells: the touch contradicts the map.
    pub(super) fn of(cells: &Cells, base: Pose, length: f64, side: f64) -> Option<Self> {
        let axis = unit(base.heading);
        let aside = side * cells.grid.cell * perpendicular(axis);
        #[expect(clippy::cast_possible_truncation, reason = "limited")]
        let places = (length / cells.grid.cell).ceil().clamp(1.0, MOST_PLACES) as i32;
        let mut ends: Option<(i32, i32)> = None;
        for place in 0..=places {
            let along = length * f64::from(place) / f64::from(places);
            if cells.at(base.position + along * axis + aside) != Cell::Free {
                ends = Some((ends.map_or(place, |(first, _)| first), place));
            }
        }
        let (first, last) = ends?;
        // A cell is free by its centre, which is up to a cell from the place.
        let distances = [(first - AROUND).max(0), (last + AROUND).min(places)]
            .map(|place| length * f64::from(place) / f64::from(places));
        Some(Self { ends: distances.map(|along| base.position + along * axis), distances, reaches_tip: last == places })
    }

    /// Distance (m) from the base of the middle of that part, and its standard deviation (m) if every place of the part is as
    /// likely.
    #[must_use]
    pub fn distance(&self) -> (f64, f64) {
        let [from, to] = self.distances;
        (0.5 * (from + to), (to - from) / 12.0_f64.sqrt())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use proptest::prelude::*;

    use super::*;
    use crate::map::grid::Grid;

    proptest! {
        #[test]
        fn the_part_is_that_beside_unknown_ground(from in 0.02..0.06_f64, width in 5e-3..0.03_f64, heading in -3.0..3.0_f64, is_left in any::<bool>()) {
            let mut cells = Cells::new(Grid::new(0.4, 2e-3));
            let base = Pose { position: Point2::new(0.013, -0.021), heading };
            let corner = |x: f64, y: f64| base.point_to_world(Point2::new(x, y));
            // Free ground on both sides, except beside a part on one side.
            let side = if is_left { 1.0 } else { -1.0 };
            let to = from + width;
            for (a, b, low, high) in [(-0.02, 0.13, 0.0, -0.02 * side), (-0.02, from, 0.0, 0.02 * side), (to, 0.13, 0.0, 0.02 * side)] {
                cells.free_quad([corner(a, low), corner(b, low), corner(b, high), corner(a, high)]);
            }
            let found = FirstTouch::of(&cells, base, 0.1, side).unwrap();
            prop_assert!((found.distances[0] - from).abs() < 7e-3 && found.distances[0] < from + 1e-9);
            prop_assert!((found.distances[1] - to).abs() < 7e-3 && found.distances[1] > to - 1e-9);
            prop_assert!(!found.reaches_tip);
            prop_assert_eq!(FirstTouch::of(&cells, base, 0.1, -side), None);
        }
    }

    #[test]
    fn all_of_a_shaft_in_unknown_ground_may_touch() {
        let cells = Cells::new(Grid::new(0.4, 2e-3));
        let found = FirstTouch::of(&cells, Pose::default(), 0.1, 1.0).unwrap();
        assert!(found.reaches_tip);
        let (middle, deviation) = found.distance();
        assert!((middle - 0.05).abs() < 1e-12 && (deviation - 0.1 / 12.0_f64.sqrt()).abs() < 1e-12);
    }
}
