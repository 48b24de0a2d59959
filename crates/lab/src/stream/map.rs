//! How the map by touch of a run grows, as pages show it.

use serde::Serialize;
use vibrissa_runtime::map::{CellSpan, Map};
use vibrissa_world::geometry::Point2;

use super::frame::rounded;

/// Ticks between two frames with the map. At 30 ticks a second it is shown twice a second.
const INTERVAL: usize = 15;

/// A row of a map, and its first and last column.
type Span = [i32; 3];

/// What the map by touch has gained since the tick before that had one. Cells are a row, counted upwards, and its first and last
/// column, counted to the right.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct MapFrame {
    /// Side of a cell (m).
    pub cell: f64,
    /// The corner with the least coordinates of the cell 0 in row 0 (m, world frame).
    pub origin: [f64; 2],
    /// The cells that were proved free.
    pub free: Vec<[i32; 3]>,
    /// The cells of surfaces. Some of them may be proved free later.
    pub blocked: Vec<[i32; 3]>,
    /// All positions of the platform on the route (m, world frame), the goal last. Empty without a route.
    pub route: Vec<[f64; 2]>,
    /// The place that is to be touched or looked at next (m, world frame).
    pub target: Option<[f64; 2]>,
}

impl MapFrame {
    /// Adds what the map had gained before.
    pub fn prepend(&mut self, before: Self) {
        self.free.splice(0..0, before.free);
        self.blocked.splice(0..0, before.blocked);
    }
}

/// The map that pages have until now.
#[derive(Debug, Default)]
pub(super) struct MapGrowth {
    /// The corner of the cell 0 in row 0 (m, world frame). `None` before the map has a cell.
    origin: Option<Point2>,
    free: Vec<Span>,
    blocked: Vec<Span>,
}

impl MapGrowth {
    /// What the map has gained since the last frame, at some of the ticks.
    pub(super) fn frame(&mut self, tick: usize, map: &Map) -> Option<MapFrame> {
        if !tick.is_multiple_of(INTERVAL) {
            return None;
        }
        let cell = map.cell_size();
        let first = map.free_spans().chain(map.blocked_spans()).next();
        self.origin = self.origin.or(first.map(|span| span.low));
        let origin = self.origin.unwrap_or_else(Point2::origin);
        let gained = |known: &mut Vec<Span>, spans: &mut dyn Iterator<Item = CellSpan>| {
            let now: Vec<Span> = spans.map(|span| numbered(span, origin, cell)).collect();
            let new = difference(&now, known);
            *known = now;
            new
        };
        let point = |point: Point2| [rounded(point.x), rounded(point.y)];
        Some(MapFrame {
            cell,
            origin: [origin.x, origin.y],
            free: gained(&mut self.free, &mut map.free_spans()),
            blocked: gained(&mut self.blocked, &mut map.blocked_spans()),
            route: map.route().iter().map(|step| point(step.pose.position)).collect(),
            target: map.next_target().map(|target| point(target.place)),
        })
    }
}

fn numbered(CellSpan { low, high }: CellSpan, origin: Point2, cell: f64) -> Span {
    #[expect(clippy::cast_possible_truncation, reason = "a map has at most 8192 cells on a side")]
    let number = |length: f64| (length / cell).round() as i32;
    [number(low.y - origin.y), number(low.x - origin.x), number(high.x - origin.x) - 1]
}

/// The cells of `now` that are not in `before`. Both are in the order of rows and columns. No cell is lost, and each span is as long
/// as possible, so that one of `before` is within one of `now`.
fn difference(now: &[Span], before: &[Span]) -> Vec<Span> {
    let mut before = before.iter().peekable();
    let mut new = Vec::new();
    for &[row, from, to] in now {
        let mut from = from;
        while let Some([_, known, end]) = before.next_if(|span| span[0] == row && span[2] <= to) {
            if from < *known {
                new.push([row, from, known - 1]);
            }
            from = end + 1;
        }
        if from <= to {
            new.push([row, from, to]);
        }
    }
    new
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    /// The cells as spans that are as long as possible.
    fn spans(cells: &BTreeSet<(i32, i32)>) -> Vec<Span> {
        let mut spans: Vec<Span> = Vec::new();
        for &(row, column) in cells {
            match spans.last_mut() {
                Some(last) if last[0] == row && last[2] + 1 == column => last[2] = column,
                _ => spans.push([row, column, column]),
            }
        }
        spans
    }

    proptest! {
        #[test]
        fn the_difference_has_exactly_the_new_cells(
            before in proptest::collection::btree_set((0..4, 0..30), 0..60),
            more in proptest::collection::btree_set((0..4, 0..30), 0..60),
        ) {
            let now = &before | &more;
            let new = difference(&spans(&now), &spans(&before));
            let cells: Vec<_> = new.iter().flat_map(|&[row, from, to]| (from..=to).map(move |column| (row, column))).collect();
            prop_assert_eq!(cells, (&now - &before).into_iter().collect::<Vec<_>>());
        }
    }
}
