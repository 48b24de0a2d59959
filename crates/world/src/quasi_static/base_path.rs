//! The path of a whisker's base. The base is fixed to the platform, so no contact keeps it out of a solid.

use crate::geometry::{BoundingBox, Point2, Vector2};

use super::surface::Surfaces;

/// Detects a base that passes through a solid.
///
/// The penetration depth cannot show this: in a wall that is thinner than twice the permitted depth, no point is deep
/// enough.
#[derive(Debug, Default)]
pub(super) struct BasePath {
    /// The point of entry into the solid that contains the base, and the outward normal there. `None` outside of solids.
    entry: Option<(Point2, Vector2)>,
    /// A lower bound (m) of the distance from the base to all surfaces.
    clear: f64,
}

/// The margin (m) around a step within which surfaces are searched.
const SEARCH_MARGIN: f64 = 20e-3;

impl BasePath {
    /// Follows a straight step of the base. If the base leaves a solid by a side that faces away from the side of its
    /// entry, it has passed through the solid. The result is then the distance (m) between both points.
    pub(super) fn follow(&mut self, from: Point2, to: Point2, surfaces: &Surfaces) -> Option<f64> {
        let motion = to - from;
        self.clear -= motion.norm();
        if self.clear > 0.0 {
            return None;
        }
        let bounds = BoundingBox::around(from, to);
        let mut crossings = Vec::new();
        self.clear = SEARCH_MARGIN;
        for (_, facet) in surfaces.near(bounds, SEARCH_MARGIN) {
            self.clear = self.clear.min(facet.distance(to));
            crossings.extend(facet.crossings(from, to));
        }
        crossings.sort_by(|(one, _), (other, _)| one.total_cmp(other));
        for (share, normal) in crossings {
            let point = from + share * motion;
            if motion.dot(&normal) < 0.0 {
                self.entry.get_or_insert((point, normal));
            } else if let Some((entry, _)) = self.entry.take().filter(|(_, entered)| entered.dot(&normal) < 0.0) {
                return Some((point - entry).norm());
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use std::f64::consts::TAU;

    use proptest::prelude::*;
    use vibrissa_runtime::math;

    use super::*;
    use crate::geometry::{Contour, Pose, circle, rounded_rectangle, unit};
    use crate::solid::Solid;

    fn surfaces(outline: Contour) -> Surfaces {
        Surfaces::new(&[Solid::inside(outline).unwrap()])
    }

    /// A horizontal wall of 0.4 m.
    fn wall(centre: Point2, thickness: f64) -> Contour {
        rounded_rectangle(centre, 0.4, thickness, 0.0, 0.0).unwrap()
    }

    /// Follows a straight path in equal steps and returns the first result.
    fn along(surfaces: &Surfaces, path: &[Point2], steps: u32) -> Option<f64> {
        let mut base = BasePath::default();
        path.windows(2).find_map(|ends| {
            let at = |step: u32| ends[0] + f64::from(step) / f64::from(steps) * (ends[1] - ends[0]);
            (0..steps).find_map(|step| base.follow(at(step), at(step + 1), surfaces))
        })
    }

    proptest! {
        #[test]
        fn a_straight_path_through_a_wall_is_found_with_its_length_in_the_wall(
            thickness in 1e-5..6e-3_f64, slant in -1.2..1.2_f64, turn in 0.0..TAU, aside in -0.02..0.02_f64, steps in 1_u32..400,
        ) {
            let pose = Pose { position: Point2::new(0.3, -0.1), heading: turn };
            let wall = surfaces(wall(Point2::origin(), thickness).transformed(&pose));
            let (middle, direction) = (Point2::new(aside, 0.0), unit(std::f64::consts::FRAC_PI_2 + slant));
            let path = [middle - 0.05 * direction, middle + 0.05 * direction].map(|point| pose.point_to_world(point));
            let passed = along(&wall, &path, steps).unwrap();
            prop_assert!((passed - thickness / math::cos(slant)).abs() < 1e-9, "{passed}");
        }

        #[test]
        fn a_path_that_leaves_by_the_side_of_its_entry_does_not_pass(
            depth in 0.0..3e-3_f64, slide in -0.05..0.05_f64, steps in 1_u32..400,
        ) {
            let wall = surfaces(wall(Point2::new(0.0, -0.01), 0.02));
            let path = [(0.0, 0.02), (0.0, -depth), (slide, -depth), (slide, 0.02)].map(|(x, y)| Point2::new(x, y));
            prop_assert_eq!(along(&wall, &path, steps), None);
        }

        #[test]
        fn a_path_through_the_middle_of_a_disk_passes_and_one_that_grazes_it_does_not(
            turn in 0.0..TAU, share in 0.0..0.6_f64, steps in 1_u32..400,
        ) {
            let disk = surfaces(circle(Point2::origin(), 0.01).unwrap());
            let line = |aside: f64| [-0.03, 0.03].map(|ahead| Point2::from(ahead * unit(turn) + aside * unit(turn + TAU / 4.0)));
            let chord = 2.0 * (1.0 - share * share).sqrt() * 0.01;
            prop_assert!((along(&disk, &line(share * 0.01), steps).unwrap() - chord).abs() < 1e-9);
            prop_assert_eq!(along(&disk, &line((0.8 + share / 3.0) * 0.01), steps), None);
        }
    }
}
