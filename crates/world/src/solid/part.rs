//! The convex parts of solids in MuJoCo.

use std::f64::consts::TAU;

use vibrissa_runtime::math;

use crate::geometry::{Contour, Piece, Point2, Vector2, perpendicular};

use super::parts_fault::PartsFault;

/// The largest distance (m) of a prism's chord from its arc, if [`CHORDS_PER_TURN`] suffices.
const SAGITTA: f64 = 1e-6;
/// The largest number of chords per full turn. It applies to radii above 0.2 m. The distance of a chord from its arc is
/// then 4.7e-6 of the radius: 1.4 µm at 0.3 m, 0.24 mm at 50 m.
const CHORDS_PER_TURN: f64 = 1024.0;
/// The largest number of corners of an outline. MuJoCo's time for building it grows quadratically, to a second or two
/// at this limit.
const MAX_CORNERS: usize = 2048;

/// A convex part of a solid in MuJoCo.
#[derive(Debug, Clone, PartialEq)]
pub enum Part {
    /// An upright cylinder.
    Cylinder {
        /// The position of its axis (m, world frame).
        centre: Point2,
        /// The radius (m).
        radius: f64,
    },
    /// An upright convex prism.
    Prism {
        /// The corners, counter-clockwise (m, world frame).
        outline: Vec<Point2>,
    },
}

impl Part {
    /// The interior of a convex contour.
    ///
    /// # Errors
    /// [`PartsFault::Corners`] if the contour has too many pieces.
    pub(super) fn inside(contour: &Contour) -> Result<Self, PartsFault> {
        if let [Piece::Arc(arc)] = contour.pieces() {
            return Ok(Self::Cylinder { centre: arc.centre, radius: arc.radius });
        }
        Ok(Self::Prism { outline: corners(contour, SAGITTA)? })
    }

    /// The number of corners of its cross-section, 0 for a cylinder.
    pub(crate) fn corners(&self) -> usize {
        match self {
            Self::Cylinder { .. } => 0,
            Self::Prism { outline } => outline.len(),
        }
    }

    /// True if a line separates the part from the convex hull of these points (m, world frame) by more than `reach`
    /// (m).
    #[must_use]
    pub fn is_farther_than(&self, points: &[Point2], reach: f64) -> bool {
        let beyond =
            |place: &Point2, outwards: Vector2| points.iter().all(|point| (point - place).dot(&outwards) > reach);
        match self {
            Self::Cylinder { centre, radius } => {
                // The separating line is perpendicular to the line from the axis to the mean of the points.
                let middle = points.iter().map(|point| point - centre).sum::<Vector2>();
                middle.try_normalize(0.0).is_some_and(|outwards| beyond(&(centre + *radius * outwards), outwards))
            }
            Self::Prism { outline } => outline.iter().zip(outline.iter().cycle().skip(1)).any(|(start, end)| {
                let outwards = -perpendicular(end - start);
                outwards.try_normalize(0.0).is_some_and(|outwards| beyond(start, outwards))
            }),
        }
    }

    /// The bounding box, by its corners with the smallest and the largest coordinates (m, world frame).
    #[must_use]
    pub fn bounds(&self) -> (Point2, Point2) {
        match self {
            Self::Cylinder { centre, radius } => {
                let half = Vector2::repeat(*radius);
                (centre - half, centre + half)
            }
            Self::Prism { outline } => {
                let nowhere =
                    (Point2::from(Vector2::repeat(f64::INFINITY)), Point2::from(Vector2::repeat(f64::NEG_INFINITY)));
                outline.iter().fold(nowhere, |(low, high), corner| (low.inf(corner), high.sup(corner)))
            }
        }
    }
}

/// The corners of an outline with chords for its arcs. The distance of a chord is at most `sagitta` (m), if
/// [`CHORDS_PER_TURN`] suffices.
///
/// # Errors
/// [`PartsFault::Corners`] if there are too many.
pub(super) fn corners(contour: &Contour, sagitta: f64) -> Result<Vec<Point2>, PartsFault> {
    let count = contour.pieces().iter().map(|piece| chord_count(piece, sagitta)).sum();
    if count > MAX_CORNERS {
        return Err(PartsFault::Corners { count, limit: MAX_CORNERS });
    }
    Ok(contour.pieces().iter().flat_map(|piece| chords(piece, sagitta)).collect())
}

/// The starting points of the chords of a piece.
pub(super) fn chords(piece: &Piece, sagitta: f64) -> impl Iterator<Item = Point2> {
    let (count, length) = (chord_count(piece, sagitta), piece.length());
    (0..count).map(move |chord| piece.point_at(length * chord as f64 / count as f64))
}

fn chord_count(piece: &Piece, sagitta: f64) -> usize {
    let Piece::Arc(arc) = piece else { return 1 };
    let widest = (2.0 * math::acos((1.0 - sagitta / arc.radius).clamp(-1.0, 1.0))).max(TAU / CHORDS_PER_TURN);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small positive count")]
    let count = (arc.sweep.abs() / widest).ceil().max(1.0) as usize;
    count
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use crate::geometry::{Segment, regular_polygon, rounded_rectangle};
    use proptest::prelude::*;

    fn prism(contour: &Contour) -> Vec<Point2> {
        match Part::inside(contour) {
            Ok(Part::Prism { outline }) => outline,
            other => panic!("expected a prism, found {other:?}"),
        }
    }

    proptest! {
        #[test]
        fn chords_are_as_near_to_their_arcs_as_promised_and_bounded_in_number(exponent in -3.0..1.7_f64) {
            let radius = math::powf(10.0, exponent);
            let side = 2.0 * radius;
            let contour = rounded_rectangle(Point2::origin(), side, 1.5 * side, radius, 0.0).unwrap();
            let outline = prism(&contour);
            prop_assert!(outline.len() < 1100);
            let furthest = (0..outline.len()).map(|corner| {
                let chord = Segment { start: outline[corner], end: outline[(corner + 1) % outline.len()] };
                -contour.signed_distance(chord.point_at(0.5 * chord.length()))
            });
            prop_assert!(furthest.fold(0.0, f64::max) < 1.01 * SAGITTA.max(4.7e-6 * radius));
        }
    }

    #[test]
    fn a_polygon_of_too_many_corners_is_refused_with_the_limit() {
        let polygon = |sides| regular_polygon(Point2::origin(), 0.3, sides, 0.0).unwrap();
        assert_eq!(prism(&polygon(MAX_CORNERS)).len(), MAX_CORNERS);
        let error = Part::inside(&polygon(MAX_CORNERS + 1)).unwrap_err();
        assert_eq!(error, PartsFault::Corners { count: MAX_CORNERS + 1, limit: MAX_CORNERS });
    }
}
