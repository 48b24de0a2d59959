//! Neighbouring cells of a row.

use crate::geometry::Point2;

use super::grid::Grid;

/// Neighbouring cells of a row of a map, as a rectangle that is parallel to the axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellSpan {
    /// The corner with the least coordinates (m, world frame).
    pub low: Point2,
    /// The corner with the greatest coordinates (m, world frame).
    pub high: Point2,
}

impl CellSpan {
    /// The cells of a row from one column to another one, both included.
    pub(super) fn new(grid: Grid, (row, from, to): (i32, i32, i32)) -> Self {
        let half = 0.5 * grid.cell;
        let (low, high) = (grid.centre(from, row), grid.centre(to, row));
        Self { low: Point2::new(low.x - half, low.y - half), high: Point2::new(high.x + half, high.y + half) }
    }
}
