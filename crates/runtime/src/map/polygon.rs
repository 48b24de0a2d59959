//! The cells of a convex polygon.

use crate::geometry::Point2;
use crate::math;

/// Distance (cells) by which a polygon is wider than its vertices say. It exceeds the rounding of an edge, so that a cell
/// on the edge of two polygons belongs to at least one of them.
const CLOSED: f64 = 1e-9;

/// Calls `span` with the row, the first and the last column of the cells of each row whose centres are in a convex
/// `polygon`. Its vertices are in cells: the centre of the cell (i, j) is at (i + ½, j + ½).
pub(super) fn each_span(polygon: &[Point2], mut span: impl FnMut(i32, i32, i32)) {
    let (low, high) = polygon.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), vertex| {
        (math::min(low, vertex.y), math::max(high, vertex.y))
    });
    // Polygons without a finite extent have no cells.
    if !(low >= -REACH && high <= REACH) {
        return;
    }
    for row in first(low)..=last(high) {
        let y = f64::from(row) + 0.5;
        let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
        for (index, a) in polygon.iter().enumerate() {
            let b = polygon[(index + 1) % polygon.len()];
            let (below, above) = (math::min(a.y, b.y), math::max(a.y, b.y));
            if y < below - CLOSED || y > above + CLOSED {
                continue;
            }
            let ends = if above - below > CLOSED {
                let x = a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)).clamp(0.0, 1.0);
                [x, x]
            } else {
                [a.x, b.x]
            };
            for x in ends {
                (left, right) = (math::min(left, x), math::max(right, x));
            }
        }
        if left >= -REACH && right <= REACH {
            let (from, to) = (first(left), last(right));
            if from <= to {
                span(row, from, to);
            }
        }
    }
}

/// Largest coordinate (cells). It is far outside of every map and fits in an `i32`.
const REACH: f64 = 1e6;

/// The first cell whose centre is not below a coordinate (cells).
#[expect(clippy::cast_possible_truncation, reason = "within the reach")]
fn first(coordinate: f64) -> i32 {
    (coordinate - 0.5 - CLOSED).ceil() as i32
}

/// The last cell whose centre is not above a coordinate (cells).
#[expect(clippy::cast_possible_truncation, reason = "within the reach")]
fn last(coordinate: f64) -> i32 {
    (coordinate - 0.5 + CLOSED).floor() as i32
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use proptest::prelude::*;

    use super::*;

    fn cells(polygon: &[Point2]) -> HashSet<(i32, i32)> {
        let mut cells = HashSet::new();
        each_span(polygon, |row, from, to| cells.extend((from..=to).map(|column| (column, row))));
        cells
    }

    fn vertex() -> impl Strategy<Value = Point2> {
        // Quarters of cells, so that centres often lie on edges.
        (-40..40_i32, -40..40_i32).prop_map(|(x, y)| Point2::new(f64::from(x) / 4.0, f64::from(y) / 4.0))
    }

    proptest! {
        #[test]
        fn a_triangle_has_the_cells_whose_centres_are_on_the_inner_side_of_all_edges(triangle in [vertex(), vertex(), vertex()]) {
            let area = (triangle[1] - triangle[0]).perp(&(triangle[2] - triangle[0]));
            prop_assume!(area != 0.0);
            let cells = cells(&triangle);
            for column in -11..11 {
                for row in -11..11 {
                    let centre = Point2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
                    let is_inside = (0..3).all(|edge| {
                        let along = triangle[(edge + 1) % 3] - triangle[edge];
                        along.perp(&(centre - triangle[edge])) * area.signum() >= 0.0
                    });
                    prop_assert_eq!(cells.contains(&(column, row)), is_inside);
                }
            }
        }

        #[test]
        fn two_triangles_with_a_common_edge_leave_no_seam(
            a in (-40.0..-20.0_f64, -9.0..9.0_f64), b in (20.0..40.0_f64, -9.0..9.0_f64), top in 12.0..30.0_f64, bottom in -30.0..-12.0_f64,
        ) {
            let [a, b] = [a, b].map(|(x, y)| Point2::new(x, y));
            let (above, below) = (cells(&[a, b, Point2::new(0.0, top)]), cells(&[b, a, Point2::new(0.0, bottom)]));
            // Along the vertical axis, every cell between the tops belongs to one of them.
            for row in first(bottom)..=last(top) {
                let at = (-1, row);
                let centre = Point2::new(-0.5, f64::from(row) + 0.5);
                let near_a_top = centre.y > top - 2.0 || centre.y < bottom + 2.0;
                prop_assert!(near_a_top || above.contains(&at) || below.contains(&at), "{centre}");
            }
        }
    }

    #[test]
    fn a_polygon_that_is_not_finite_has_no_cells() {
        for bad in [f64::NAN, f64::INFINITY] {
            assert!(cells(&[Point2::new(0.0, 0.0), Point2::new(4.0, bad), Point2::new(bad, 4.0)]).is_empty());
        }
    }
}
