//! Whether a body is clear at a pose.

use crate::geometry::{Point2, Pose, perpendicular};
use crate::math;

use super::bits::{Bits, WORD};
use super::cells::Cells;
use super::frontier::BLOCK;
use super::grid::Grid;
use super::polygon::each_span;

/// The ground that a body covers, the better first. It is that of its worst cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Ground {
    /// All of it is proved free.
    Proved,
    /// A part is unknown, and no known surface is within a whisker's length of it.
    Unknown,
    /// A part is unknown, and a known surface is within a whisker's length of it.
    NearSurface,
    /// A part is blocked or outside of the map.
    Blocked,
}

/// Blocks near known surfaces, with the layout of [`Bits`]: one byte for the eight blocks of a word.
#[derive(Debug, Clone)]
pub(super) struct NearSurfaces {
    bytes: Vec<u8>,
    per_row: usize,
    /// Distance that counts as near, in blocks.
    reach: i32,
}

impl NearSurfaces {
    /// Creates blocks without a surface near them. `distance` (m) counts as near.
    #[expect(clippy::cast_possible_truncation, reason = "a small count")]
    pub(super) fn new(grid: Grid, distance: f64) -> Self {
        let per_row = grid.side / WORD;
        let reach = (distance / (grid.cell * BLOCK as f64)).ceil().clamp(0.0, 100.0) as i32;
        Self { bytes: vec![0; per_row * (grid.side / BLOCK)], per_row, reach }
    }

    /// Adds a surface in a cell.
    pub(super) fn add(&mut self, (column, row): (i32, i32)) {
        let block = |at: i32| at.div_euclid(i32::try_from(BLOCK).unwrap_or(1));
        let (column, row) = (block(column), block(row));
        for down in -self.reach..=self.reach {
            let half = f64::from(self.reach * self.reach - down * down).sqrt();
            #[expect(clippy::cast_possible_truncation, reason = "at most the reach")]
            let half = half.ceil() as i32;
            for across in column - half..=column + half {
                self.set(across, row + down);
            }
        }
    }

    fn set(&mut self, column: i32, row: i32) {
        let (Ok(column), Ok(row)) = (usize::try_from(column), usize::try_from(row)) else { return };
        if column / BLOCK < self.per_row
            && let Some(byte) = self.bytes.get_mut(row * self.per_row + column / BLOCK)
        {
            *byte |= 1 << (column % BLOCK);
        }
    }

    /// The blocks of a row of cells, one byte for each word.
    fn row(&self, row: usize) -> &[u8] {
        let first = row / BLOCK * self.per_row;
        &self.bytes[first..first + self.per_row]
    }
}

/// A word with all bits of the bytes whose bits are set in `byte`.
fn spread(byte: u8) -> u64 {
    const ONES: u64 = 0x0101_0101_0101_0101;
    // Each byte keeps its own bit, and an addition carries it to the highest bit of the byte.
    let own = (u64::from(byte) * ONES) & 0x8040_2010_0804_0201;
    let highest = ((own & (0x7f * ONES)) + 0x7f * ONES) | own;
    (highest >> 7 & ONES) * 0xff
}

/// The ground of a span of cells.
pub(super) fn ground_of_span(cells: &Cells, near: &NearSurfaces, row: i32, from: i32, to: i32) -> Ground {
    let bits: &Bits = &cells.free;
    let (true, Ok(line)) = (bits.contains(row, from, to), usize::try_from(row)) else { return Ground::Blocked };
    let (blocks, first) = (near.row(line), line * near.per_row);
    let mut worst = Ground::Proved;
    for (index, mask) in bits.words(row, from, to) {
        let unknown = mask & !bits.word(index);
        if unknown == 0 {
            continue;
        }
        if unknown & cells.blocked.word(index) != 0 {
            return Ground::Blocked;
        }
        let is_near = blocks[index - first] != 0 && unknown & spread(blocks[index - first]) != 0;
        worst = worst.max(if is_near { Ground::NearSurface } else { Ground::Unknown });
    }
    worst
}

/// The ground of a convex polygon in cells.
pub(super) fn ground_of_polygon(cells: &Cells, near: &NearSurfaces, polygon: &[Point2]) -> Ground {
    let mut worst = Ground::Proved;
    let mut is_empty = true;
    each_span(polygon, |row, from, to| {
        is_empty = false;
        if worst != Ground::Blocked {
            worst = worst.max(ground_of_span(cells, near, row, from, to));
        }
    });
    // A polygon without cells is far outside or not finite.
    if is_empty { Ground::Blocked } else { worst }
}

/// The margin (m) of a body for cells of this side (m). A cell is free if its centre is, so a wall may reach into it by half of
/// its diagonal. The body touches a cell if the centre is within another half.
pub(super) fn cell_margin(cell: f64) -> f64 {
    std::f64::consts::SQRT_2 * cell
}

/// The corners (m, world frame) of an outline (m, body frame) at a pose.
pub(super) fn at_pose(outline: &[Point2; 4], pose: Pose) -> [Point2; 4] {
    outline.map(|corner| pose.point_to_world(corner))
}

/// A convex polygon whose edges are moved outwards by a distance (m), or inwards by a negative one. `None` if nothing is
/// left. Its corners are counter-clockwise.
pub(super) fn grown(outline: &[Point2; 4], by: f64) -> Option<[Point2; 4]> {
    let edge = |index: usize| {
        let (a, b) = (outline[index % 4], outline[(index + 1) % 4]);
        let along = (b - a).try_normalize(0.0).unwrap_or_default();
        (a - by * perpendicular(along), along)
    };
    let corner = |index: usize| {
        let ((a, before), (b, after)) = (edge(index + 3), edge(index));
        a + before * ((b - a).perp(&after) / before.perp(&after))
    };
    let moved: [Point2; 4] = if by == 0.0 { *outline } else { std::array::from_fn(corner) };
    let keeps_its_order = (0..4).all(|index| {
        let along = outline[(index + 1) % 4] - outline[index];
        (moved[(index + 1) % 4] - moved[index]).dot(&along) > 0.0
    });
    keeps_its_order.then_some(moved)
}

/// Largest distance (m) of a corner from the origin.
pub(super) fn reach(outline: &[Point2]) -> f64 {
    outline.iter().map(|corner| corner.coords.norm()).fold(0.0, math::max)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::rig::Rig;

    /// Free ground except in some disks.
    fn ground(holes: &[(f64, f64, f64)]) -> Cells {
        let grid = Grid::new(0.6, 2e-3);
        let mut cells = Cells::new(grid);
        let side = i32::try_from(grid.side).unwrap_or(0);
        for row in 0..side {
            for column in 0..side {
                let centre = grid.centre(column, row);
                let is_covered = |(x, y, radius): &(f64, f64, f64)| (centre - Point2::new(*x, *y)).norm() < *radius;
                if !holes.iter().any(is_covered) {
                    cells.free.fill(row, column, column);
                }
            }
        }
        cells
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(60))]

        /// The oracle is the exact distance of the outline from each disk.
        #[test]
        fn a_clear_body_overlaps_no_disk_and_one_far_from_all_is_clear(
            holes in prop::collection::vec((-0.25..0.25_f64, -0.25..0.25_f64, 4e-3..0.05_f64), 0..6),
            poses in prop::collection::vec((-0.15..0.15_f64, -0.15..0.15_f64, -4.0..4.0_f64), 20),
        ) {
            let cells = ground(&holes);
            let near = NearSurfaces::new(cells.grid, 0.1);
            let outline = Rig::default().platform.outline_body();
            let margin = cell_margin(cells.grid.cell);
            let body = grown(&outline, margin).unwrap_or(outline);
            for (x, y, heading) in poses {
                let pose = Pose { position: Point2::new(x, y), heading };
                let polygon = at_pose(&body, pose).map(|corner| cells.grid.to_cells(corner));
                let found = ground_of_polygon(&cells, &near, &polygon);
                let exact = at_pose(&outline, pose);
                let depth = |(x, y, radius): &(f64, f64, f64)| {
                    let centre = Point2::new(*x, *y);
                    let distance = (0..4).map(|index| {
                        let (a, b) = (exact[index], exact[(index + 1) % 4]);
                        let share = ((centre - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0);
                        (centre - (a + share * (b - a))).norm()
                    }).fold(f64::INFINITY, math::min);
                    let is_inside = (0..4).all(|index| (exact[(index + 1) % 4] - exact[index]).perp(&(centre - exact[index])) > 0.0);
                    if is_inside { radius + distance } else { radius - distance }
                };
                let deepest = holes.iter().map(depth).fold(f64::NEG_INFINITY, math::max);
                if found == Ground::Proved {
                    prop_assert!(deepest < 1e-9, "a clear body overlaps a disk by {deepest} m");
                }
                // Mitred corners reach farther than the margin.
                if deepest < -4.0 * margin {
                    prop_assert_eq!(found, Ground::Proved);
                }
            }
        }

        #[test]
        fn unknown_ground_near_a_surface_is_told_from_other_ground(x in -0.2..0.2_f64, y in -0.2..0.2_f64) {
            let cells = Cells::new(Grid::new(0.6, 2e-3));
            let mut near = NearSurfaces::new(cells.grid, 0.1);
            let surface = cells.grid.cell_at(Point2::new(x, y)).unwrap_or_default();
            near.add(surface);
            for step in 0..900 {
                let place = Point2::new(-0.29 + 0.02 * f64::from(step % 30), -0.29 + 0.02 * f64::from(step / 30));
                let (column, row) = cells.grid.cell_at(place).unwrap_or_default();
                let found = ground_of_span(&cells, &near, row, column, column);
                let distance = (place - Point2::new(x, y)).norm();
                // A block is 16 mm wide.
                if distance < 0.1 - 0.025 {
                    prop_assert_eq!(found, Ground::NearSurface);
                } else if distance > 0.1 + 0.065 {
                    prop_assert_eq!(found, Ground::Unknown);
                }
            }
        }
    }

    #[test]
    fn a_byte_is_spread_bit_by_bit() {
        for byte in 0..=u8::MAX {
            let expected = (0..64).filter(|bit| byte >> (bit / 8) & 1 == 1).fold(0_u64, |word, bit| word | 1 << bit);
            assert_eq!(spread(byte), expected, "{byte}");
        }
    }

    #[test]
    fn a_grown_outline_has_its_edges_at_the_distance() {
        let outline = Rig::default().platform.outline_body();
        for by in [-5e-3, 0.0, 5e-3] {
            let moved = grown(&outline, by).unwrap_or(outline);
            for index in 0..4 {
                let along = (outline[(index + 1) % 4] - outline[index]).normalize();
                for corner in [moved[index], moved[(index + 1) % 4]] {
                    assert!((along.perp(&(outline[index] - corner)) - by).abs() < 1e-12);
                }
            }
        }
        assert_eq!(grown(&outline, -0.1), None);
    }
}
