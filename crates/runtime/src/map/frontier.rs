//! Unknown ground beside free ground, in blocks of cells.

use crate::geometry::Point2;

use super::bits::WORD;
use super::cells::Cells;
use super::grid::Grid;

/// Cells of a block on a side. A block row of a word of cells has eight blocks.
pub(super) const BLOCK: usize = 8;
/// Free cells from which a block counts as free. The others of its 64 cells may lie in seams of margins.
const MOSTLY: u32 = 48;
/// Block rows that are looked at in a tick.
const ROWS: usize = 16;
/// Blocks about a place that fail with it. More would close positions that were never tried.
const CLOSED_AROUND: i32 = 1;
/// Failures after which a place is closed.
const FAILURES: u8 = 3;

/// What is known of a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Block {
    Unknown,
    Free,
    /// It contains a surface or blocked ground.
    Blocked,
}

/// The blocks of a map.
#[derive(Debug, Clone)]
pub(super) struct Frontier {
    side: usize,
    states: Vec<Block>,
    /// Failures of targets in each block. From [`FAILURES`] on it is closed.
    failures: Vec<u8>,
    next_row: usize,
    /// Number of frontier blocks in the rows of this pass so far, and in the last whole pass.
    counted: u32,
    last_count: Option<u32>,
}

impl Frontier {
    /// Creates unknown blocks.
    pub(super) fn new(grid: Grid) -> Self {
        let side = grid.side / BLOCK;
        Self {
            side,
            states: vec![Block::Unknown; side * side],
            failures: vec![0; side * side],
            next_row: 0,
            counted: 0,
            last_count: None,
        }
    }

    fn index(&self, column: i32, row: i32) -> Option<usize> {
        let (column, row) = (usize::try_from(column).ok()?, usize::try_from(row).ok()?);
        (column < self.side && row < self.side).then_some(row * self.side + column)
    }

    /// What is known of a block. Outside of the map everything counts as blocked, because nothing can be learnt there.
    pub(super) fn get(&self, column: i32, row: i32) -> Block {
        self.index(column, row).map_or(Block::Blocked, |index| self.states[index])
    }

    /// The block of a point (m, world frame).
    pub(super) fn block_at(grid: Grid, point: Point2) -> Option<(i32, i32)> {
        let (column, row) = grid.cell_at(point)?;
        let block = i32::try_from(BLOCK).unwrap_or(1);
        Some((column.div_euclid(block), row.div_euclid(block)))
    }

    /// The centre (m, world frame) of a block.
    pub(super) fn centre(grid: Grid, (column, row): (i32, i32)) -> Point2 {
        let block = i32::try_from(BLOCK).unwrap_or(1);
        let half = block / 2;
        let cell = grid.centre(column * block + half, row * block + half);
        // The middle is a corner of four cells.
        Point2::new(cell.x - 0.5 * grid.cell, cell.y - 0.5 * grid.cell)
    }

    /// True if targets in a block have failed too often.
    pub(super) fn is_closed(&self, column: i32, row: i32) -> bool {
        self.index(column, row).is_none_or(|index| self.failures[index] >= FAILURES)
    }

    /// Counts a failure of a target in a block, also for the blocks about it.
    pub(super) fn fail(&mut self, (column, row): (i32, i32)) {
        for down in -CLOSED_AROUND..=CLOSED_AROUND {
            for across in -CLOSED_AROUND..=CLOSED_AROUND {
                if let Some(index) = self.index(column + across, row + down) {
                    self.failures[index] = self.failures[index].saturating_add(1);
                }
            }
        }
    }

    /// True for an unknown block beside a free one and beside no surface, which is not closed.
    pub(super) fn is_frontier(&self, column: i32, row: i32) -> bool {
        !self.is_closed(column, row) && self.is_left(column, row)
    }

    /// True for an unknown block beside a free one and beside no surface.
    fn is_left(&self, column: i32, row: i32) -> bool {
        let around = (-1..=1).flat_map(|down| (-1..=1).map(move |across| (across, down)));
        self.get(column, row) == Block::Unknown
            && [(1, 0), (-1, 0), (0, 1), (0, -1)].iter().any(|(x, y)| self.get(column + x, row + y) == Block::Free)
            && !around.into_iter().any(|(x, y)| self.get(column + x, row + y) == Block::Blocked)
    }

    /// Number of unknown blocks within so many blocks of a block.
    pub(super) fn unknown_around(&self, (column, row): (i32, i32), reach: i32) -> u32 {
        let rows = row - reach..=row + reach;
        let count = rows.map(|row| {
            let columns = column - reach..=column + reach;
            columns.filter(|&column| self.get(column, row) == Block::Unknown).count()
        });
        u32::try_from(count.sum::<usize>()).unwrap_or(u32::MAX)
    }

    /// The unknown blocks beside free ones and beside no surface, in the order of rows. Closed ones are among them.
    pub(super) fn left(&self) -> impl Iterator<Item = (i32, i32)> + '_ {
        let side = i32::try_from(self.side).unwrap_or(0);
        let all = (0..side).flat_map(move |row| (0..side).map(move |column| (column, row)));
        all.filter(|(column, row)| self.is_left(*column, *row))
    }

    /// Area (m²) of the frontier in the last whole pass. `None` before the first one has ended.
    pub(super) fn area(&self, grid: Grid) -> Option<f64> {
        let block = (BLOCK * BLOCK) as f64 * grid.cell_area();
        self.last_count.map(|count| f64::from(count) * block)
    }

    /// Looks at the next rows, and calls `found` for each block of the frontier in them. Returns true at the end of a pass.
    pub(super) fn update(&mut self, cells: &Cells, mut found: impl FnMut(&Self, (i32, i32))) -> bool {
        let last = (self.next_row + ROWS).min(self.side);
        for row in self.next_row..last {
            self.look(cells, row);
        }
        // A block needs the row below it, which is looked at now, and the one above it, which was looked at before.
        let from = self.next_row.saturating_sub(1);
        let to = if last == self.side { last } else { last - 1 };
        for row in from..to {
            for column in 0..self.side {
                let block = (i32::try_from(column).unwrap_or(0), i32::try_from(row).unwrap_or(0));
                if self.states[row * self.side + column] == Block::Unknown && self.is_frontier(block.0, block.1) {
                    self.counted += 1;
                    found(self, block);
                }
            }
        }
        let is_end = last == self.side;
        self.next_row = if is_end { 0 } else { last };
        if is_end {
            self.last_count = Some(self.counted);
            self.counted = 0;
        }
        is_end
    }

    /// Looks at the cells of a block row.
    fn look(&mut self, cells: &Cells, row: usize) {
        let per_row = cells.grid.side / WORD;
        for word in 0..per_row {
            let (mut free, mut blocked) = ([0_u32; BLOCK], 0_u64);
            for line in 0..BLOCK {
                let index = (row * BLOCK + line) * per_row + word;
                let bits = cells.free.word(index);
                blocked |= cells.blocked.word(index) & !bits;
                if bits != 0 {
                    for (block, count) in free.iter_mut().enumerate() {
                        *count += (bits >> (block * BLOCK) & 0xff).count_ones();
                    }
                }
            }
            for (block, count) in free.into_iter().enumerate() {
                let state = if blocked >> (block * BLOCK) & 0xff != 0 {
                    Block::Blocked
                } else if count >= MOSTLY {
                    Block::Free
                } else {
                    Block::Unknown
                };
                self.states[row * self.side + word * BLOCK + block] = state;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40))]

        #[test]
        fn the_frontier_is_the_unknown_ring_about_free_ground(left in -0.2..0.0_f64, low in -0.2..0.0_f64, width in 0.06..0.2_f64, height in 0.06..0.2_f64) {
            let grid = Grid::new(0.8, 2e-3);
            let mut cells = Cells::new(grid);
            let corners = [(left, low), (left + width, low), (left + width, low + height), (left, low + height)];
            cells.free_convex(corners.map(|(x, y)| Point2::new(x, y)));
            let mut frontier = Frontier::new(grid);
            let mut blocks = Vec::new();
            while !frontier.update(&cells, |_, block| blocks.push(block)) {}
            let side = grid.cell * BLOCK as f64;
            // One block on each side, up to rounding to whole blocks.
            let expected = 2.0 * (width + height) / side;
            prop_assert!((blocks.len() as f64 - expected).abs() <= 8.0, "{} {expected}", blocks.len());
            prop_assert!((frontier.area(grid).unwrap_or(0.0) - blocks.len() as f64 * side * side).abs() < 1e-12);
            for block in &blocks {
                let centre = Frontier::centre(grid, *block);
                prop_assert_eq!(Frontier::block_at(grid, centre), Some(*block));
                let outside = [left - centre.x, centre.x - left - width, low - centre.y, centre.y - low - height];
                let distance = outside.into_iter().fold(f64::NEG_INFINITY, crate::math::max);
                prop_assert!(distance > -side && distance < 1.6 * side, "{distance} m");
            }
            // A surface beside it, or three failures, ends the frontier there.
            let Some(&block) = blocks.first() else { return Ok(()) };
            for _ in 0..3 {
                prop_assert!(frontier.is_frontier(block.0, block.1));
                frontier.fail(block);
            }
            prop_assert!(!frontier.is_frontier(block.0, block.1));
        }
    }
}
