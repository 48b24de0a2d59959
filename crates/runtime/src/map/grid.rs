//! The square that a map covers.

use crate::geometry::Point2;

use super::bits::WORD;

/// A square of cells in the world frame. Its sides are parallel to the axes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Grid {
    /// Corner with the least coordinates (m, world frame).
    corner: Point2,
    /// Side of a cell (m).
    pub(super) cell: f64,
    /// Cells of a side, a multiple of the bits in a word.
    pub(super) side: usize,
}

impl Grid {
    /// Creates a square of at least `extent` (m) about the origin, of cells with the side `cell` (m).
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
    pub(super) fn new(extent: f64, cell: f64) -> Self {
        let side = ((extent / cell).ceil() as usize).max(1).next_multiple_of(WORD);
        Self { corner: Point2::origin(), cell, side }.about(Point2::origin())
    }

    /// The same square about another centre (m, world frame).
    pub(super) fn about(self, centre: Point2) -> Self {
        let half = 0.5 * self.side as f64 * self.cell;
        Self { corner: Point2::new(centre.x - half, centre.y - half), ..self }
    }

    /// The middle of the square (m, world frame).
    pub(super) fn middle(self) -> Point2 {
        let half = 0.5 * self.side as f64 * self.cell;
        Point2::new(self.corner.x + half, self.corner.y + half)
    }

    /// A point (m, world frame) in cells.
    pub(super) fn to_cells(self, point: Point2) -> Point2 {
        ((point - self.corner) / self.cell).into()
    }

    /// The column and the row of the cell that contains a point (m, world frame). `None` for a point far outside or one
    /// that is not finite. The cell may still be outside of the square.
    #[expect(clippy::cast_possible_truncation, reason = "the coordinates are in range")]
    pub(super) fn cell_at(self, point: Point2) -> Option<(i32, i32)> {
        let cells = self.to_cells(point);
        let is_near = cells.x.abs() < 1e6 && cells.y.abs() < 1e6;
        is_near.then(|| (cells.x.floor() as i32, cells.y.floor() as i32))
    }

    /// The centre (m, world frame) of a cell.
    pub(super) fn centre(self, column: i32, row: i32) -> Point2 {
        let at = |index: i32| (f64::from(index) + 0.5) * self.cell;
        Point2::new(self.corner.x + at(column), self.corner.y + at(row))
    }

    /// Area (m²) of a cell.
    pub(super) fn cell_area(self) -> f64 {
        self.cell * self.cell
    }
}
