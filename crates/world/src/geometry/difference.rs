//! The difference of two outlines.

use cavalier_contours::polyline::{BooleanOp, BooleanResult, PlineBooleanOptions, PlineSource, Polyline};

use super::offset::{PER_METRE, to_pieces, to_polyline};
use super::{Contour, JOIN_TOLERANCE, Point2, TOUCHING};

impl Contour {
    /// The parts of this outline's area outside of the area of `other`, as their outlines.
    ///
    /// There is none if `other` covers this outline. Without a common area, the result is this outline. Its pieces are those
    /// of both outlines, cut at their intersections.
    ///
    /// ```
    /// use vibrissa_world::geometry::{Point2, circle, rounded_rectangle};
    /// let plate = rounded_rectangle(Point2::origin(), 0.4, 0.2, 0.0, 0.0)?;
    /// let bitten = plate.difference(&circle(Point2::new(0.2, 0.0), 0.05)?).unwrap();
    /// assert_eq!(bitten.len(), 1);
    /// assert!((bitten[0].area() - (0.08 - 0.5 * std::f64::consts::PI * 0.05_f64.powi(2))).abs() < 1e-12);
    /// # Ok::<(), vibrissa_world::geometry::ShapeError>(())
    /// ```
    ///
    /// `None` if an outline is open, if `other` would leave a hole, or if the result cannot be determined, because the outlines
    /// touch without a clear intersection.
    #[must_use]
    pub fn difference(&self, other: &Self) -> Option<Vec<Self>> {
        if !self.is_closed() || !other.is_closed() {
            return None;
        }
        let bounds = self.bounding_box().union(&other.bounding_box());
        let origin = nalgebra::center(&bounds.min, &bounds.max);
        let options =
            PlineBooleanOptions { pos_equal_eps: JOIN_TOLERANCE * PER_METRE, ..PlineBooleanOptions::default() };
        let BooleanResult::<Polyline> { pos_plines, neg_plines, .. } =
            to_polyline(self, origin).boolean_opt(&to_polyline(other, origin), BooleanOp::Not, &options);
        if !neg_plines.is_empty() {
            return None;
        }
        let found = pos_plines.iter().map(|found| Self::closed(to_pieces(&found.pline, origin)).ok());
        let found = found.collect::<Option<Vec<_>>>()?;
        self.has_difference(other, &found).then_some(found)
    }

    /// True if the result is the difference: its outlines are on those of both, on the right side of each, and they lack no part.
    fn has_difference(&self, other: &Self, found: &[Self]) -> bool {
        const ALONG: [f64; 3] = [0.02, 0.5, 0.98];
        let depth = |point: Point2| self.signed_distance(point).max(-other.signed_distance(point));
        let is_outline = |point: Point2| depth(point).abs() <= TOUCHING;
        // The outline of the difference is the set of points at which the depth is zero.
        let is_found = |point: Point2| {
            !is_outline(point) || found.iter().any(|outline| outline.nearest(point).distance <= TOUCHING)
        };
        let points = |contour: &Self| -> Vec<Point2> {
            let pieces = contour.pieces().iter();
            pieces.flat_map(|piece| ALONG.map(|share| piece.point_at(share * piece.length()))).collect()
        };
        found.iter().flat_map(points).all(is_outline) && points(self).into_iter().chain(points(other)).all(is_found)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use proptest::prelude::*;

    use super::*;
    use crate::geometry::{circle, rounded_rectangle};

    fn bar(x: f64, y: f64, width: f64, heading: f64, radius: f64) -> Contour {
        rounded_rectangle(Point2::new(x, y), width, 0.1, radius, heading).unwrap()
    }

    #[test]
    fn a_hole_and_an_open_outline_have_no_difference_and_a_covered_one_leaves_nothing() {
        let (disk, plate) = (circle(Point2::origin(), 0.03).unwrap(), bar(0.0, 0.0, 0.2, 0.0, 0.0));
        assert!(plate.difference(&disk).is_none());
        assert_eq!(disk.difference(&plate).map(|found| found.len()), Some(0));
        let open = Contour::open(plate.pieces()[..2].to_vec()).unwrap();
        assert!(open.difference(&disk).is_none() && plate.difference(&open).is_none());
        let apart = bar(1.0, 0.0, 0.2, 0.3, 0.0);
        assert!((plate.difference(&apart).unwrap()[0].area() - plate.area()).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn a_point_is_in_the_difference_if_it_is_in_the_first_and_not_in_the_second(
            x in -0.3..0.3_f64, y in -0.1..0.1_f64, width in 0.12..0.6_f64, heading in -1.5..1.5_f64,
            radius in prop_oneof![Just(0.0), 0.005..0.05_f64], is_disk: bool,
            points in prop::collection::vec((-0.35..0.35_f64, -0.15..0.15_f64), 50),
        ) {
            let plate = rounded_rectangle(Point2::origin(), 0.6, 0.2, 0.0, 0.03).unwrap();
            let other =
                if is_disk { circle(Point2::new(x, y), 0.2 * width) } else { Ok(bar(x, y, width, heading, radius)) };
            let other = other.unwrap();
            let Some(found) = plate.difference(&other) else {
                // Only a hole has no difference: the other one is inside.
                let inside = other.sample(1e-3).iter().all(|sample| plate.contains(sample.point));
                prop_assert!(inside, "{other:?}");
                return Ok(());
            };
            for (x, y) in points {
                let point = Point2::new(x, y);
                prop_assume!(plate.distance(point) > 1e-5 && other.distance(point) > 1e-5);
                let is_in = found.iter().any(|outline| outline.contains(point));
                prop_assert_eq!(is_in, plate.contains(point) && !other.contains(point));
            }
        }
    }
}
