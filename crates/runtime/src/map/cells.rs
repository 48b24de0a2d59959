//! Free, blocked and unknown cells.

use crate::geometry::Point2;

use super::bits::Bits;
use super::grid::Grid;
use super::polygon::each_span;

/// What is known of a cell. It is free or blocked as a whole if its centre is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cell {
    /// The body or a straight shaft has passed over its centre, so no object covers it.
    Free,
    /// Nothing is known.
    Unknown,
    /// The body must not enter: there is a surface, or the body was stopped there.
    Blocked,
}

/// Most cells around a point that are looked at.
const MOST_REACH: f64 = 64.0;

/// The cells of a map. A cell that has been proved free remains free.
#[derive(Debug, Clone)]
pub(super) struct Cells {
    pub(super) grid: Grid,
    pub(super) free: Bits,
    pub(super) blocked: Bits,
    /// Number of free cells.
    free_count: u64,
}

impl Cells {
    /// Creates unknown cells.
    pub(super) fn new(grid: Grid) -> Self {
        Self { grid, free: Bits::new(grid.side), blocked: Bits::new(grid.side), free_count: 0 }
    }

    /// What is known of the cell at a point (m, world frame). Outside of the square nothing is known.
    pub(super) fn at(&self, point: Point2) -> Cell {
        self.grid.cell_at(point).map_or(Cell::Unknown, |(column, row)| self.get(column, row))
    }

    /// What is known of a cell.
    pub(super) fn get(&self, column: i32, row: i32) -> Cell {
        if self.free.get(column, row) {
            Cell::Free
        } else if self.blocked.get(column, row) {
            Cell::Blocked
        } else {
            Cell::Unknown
        }
    }

    /// True if all cells within `distance` (m) of a point (m, world frame) are free, and at least its neighbours.
    #[expect(clippy::cast_possible_truncation, reason = "limited")]
    pub(super) fn is_inside_free(&self, point: Point2, distance: f64) -> bool {
        let Some((column, row)) = self.grid.cell_at(point) else { return false };
        let reach = (distance / self.grid.cell).ceil().clamp(1.0, MOST_REACH) as i32;
        (row - reach..=row + reach).all(|row| self.free.are_set(row, column - reach, column + reach))
    }

    /// Area (m²) of the free cells.
    pub(super) fn free_area(&self) -> f64 {
        self.free_count as f64 * self.grid.cell_area()
    }

    /// Makes the cells of a convex polygon (m, world frame) free.
    pub(super) fn free_convex(&mut self, polygon: [Point2; 4]) {
        let (free, mut new) = (&mut self.free, 0);
        each_span(&polygon.map(|vertex| self.grid.to_cells(vertex)), |row, from, to| new += free.fill(row, from, to));
        self.free_count += u64::from(new);
    }

    /// Makes the cells of a quadrilateral (m, world frame) free. It is divided by a diagonal, because it need not be
    /// convex.
    pub(super) fn free_quad(&mut self, [a, b, c, d]: [Point2; 4]) {
        self.free_convex([a, b, c, c]);
        self.free_convex([a, c, d, d]);
    }

    /// Makes the cells of a convex polygon (m, world frame) blocked, unless they are free.
    pub(super) fn block_convex(&mut self, polygon: [Point2; 4]) {
        let blocked = &mut self.blocked;
        each_span(&polygon.map(|vertex| self.grid.to_cells(vertex)), |row, from, to| {
            blocked.fill(row, from, to);
        });
    }
}
