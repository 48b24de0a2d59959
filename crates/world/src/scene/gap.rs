//! The distance between a line and a piece of a contour.

use crate::geometry::{Arc, Piece, Point2, Segment};

/// The smallest distance (m) between a point of `line` and a point of `piece`, 0 up to rounding if they intersect.
///
/// It occurs at an end of one of them, at an intersection, or at a common perpendicular. For an arc, this perpendicular
/// passes through its centre. Therefore a few candidates on `line` and the ends of `piece` suffice.
pub fn gap(line: &Segment, piece: &Piece) -> f64 {
    let inner = match piece {
        Piece::Segment(segment) => [crossing(line, segment); 2],
        Piece::Arc(arc) => crossings_or_foot(line, arc),
    };
    let from_line = [line.start, line.end, inner[0], inner[1]].map(|point| piece.distance(point));
    let from_piece = [piece.start(), piece.end()].map(|point| line.distance(point));
    from_line.into_iter().chain(from_piece).fold(f64::INFINITY, f64::min)
}

/// The point of `line` nearest to the infinite line through `segment`, or its intersection. The start of `line` if both
/// are parallel.
fn crossing(line: &Segment, segment: &Segment) -> Point2 {
    let along = segment.tangent();
    let sine = line.tangent().perp(&along);
    if sine == 0.0 { line.start } else { line.point_at((segment.start - line.start).perp(&along) / sine) }
}

/// The intersections of `line` with the circle of `arc`. Without one, twice the point nearest to the centre.
fn crossings_or_foot(line: &Segment, arc: &Arc) -> [Point2; 2] {
    let to_centre = arc.centre - line.start;
    let (foot, aside) = (to_centre.dot(&line.tangent()), to_centre.perp(&line.tangent()));
    let half_chord = (arc.radius * arc.radius - aside * aside).max(0.0).sqrt();
    [foot - half_chord, foot + half_chord].map(|along| line.point_at(along))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::{PI, TAU};

    fn point() -> impl Strategy<Value = Point2> {
        (-1.0..1.0_f64, -1.0..1.0_f64).prop_map(|(x, y)| Point2::new(x, y))
    }

    fn line() -> impl Strategy<Value = Segment> {
        (point(), point())
            .prop_filter("a point", |(start, end)| (end - start).norm() > 1e-3)
            .prop_map(|(start, end)| Segment { start, end })
    }

    fn piece() -> impl Strategy<Value = Piece> {
        let arc = (point(), 0.01..2.0_f64, -PI..PI, prop_oneof![-TAU..-0.01, 0.01..TAU, Just(TAU)]);
        prop_oneof![
            line().prop_map(Piece::Segment),
            arc.prop_map(|(centre, radius, start, sweep)| Piece::arc(centre, radius, start, sweep)),
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(3000))]

        #[test]
        fn no_point_of_a_line_is_nearer_and_one_is_as_near(line in line(), piece in piece()) {
            let steps = 500;
            let step = line.length() / f64::from(steps);
            let nearest = (0..=steps)
                .map(|index| piece.distance(line.point_at(step * f64::from(index))))
                .fold(f64::INFINITY, f64::min);
            let gap = gap(&line, &piece);
            prop_assert!(gap <= nearest + 1e-12 && gap >= nearest - 0.5 * step - 1e-12, "{gap} m against {nearest} m");
        }
    }

    #[test]
    fn parallel_lines_are_as_far_apart_as_everywhere() {
        let line = Segment { start: Point2::new(0.0, 1e-5), end: Point2::new(1.0, 1e-5) };
        let below = Piece::segment(Point2::new(3.0, 0.0), Point2::new(-3.0, 0.0));
        assert!((gap(&line, &below) - 1e-5).abs() < 1e-18);
    }
}
