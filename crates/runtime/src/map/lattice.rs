//! The poses of a route search, and the ground of the moves between them.

use std::f64::consts::TAU;

use crate::geometry::{Point2, Pose, Vector2, unit, wrap};
use crate::math;

use super::cells::Cells;
use super::clearance::{self, Ground, NearSurfaces, ground_of_polygon, ground_of_span};
use super::grid::Grid;
use super::polygon::each_span;

/// Headings of the lattice: every 15°.
pub(super) const HEADINGS: usize = 24;
const HEADINGS_COUNT: u32 = 24;
/// Moves from a pose: eight translations and two rotations.
pub(super) const MOVES: usize = 10;
/// Distance (m) of neighbouring positions. A body that fits through a door with a sixth of its width to spare finds a position.
const STRIDE: f64 = 24e-3;
/// Translations of the moves, in strides.
const STEPS: [(i32, i32); 8] = [(1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, -1), (1, -1), (-1, 1)];

/// A pose of the lattice.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Node {
    pub(super) column: i32,
    pub(super) row: i32,
    pub(super) heading: usize,
}

/// The cells of each move, relative to the cell of its node.
#[derive(Debug, Clone)]
pub(super) struct Lattice {
    /// Cells between neighbouring positions, and the positions of a side.
    stride: i32,
    side: i32,
    /// Corners of the body with its margin, and without it (m, body frame).
    outline: [Point2; 4],
    exact: [Point2; 4],
    /// Rows, first and last columns.
    spans: Vec<[i16; 3]>,
    /// The end of the spans of each move of each heading.
    ends: Vec<usize>,
}

impl Lattice {
    /// Creates the lattice of a square for a body with its margin and without it (m, body frame).
    #[expect(clippy::cast_possible_truncation, reason = "small counts")]
    pub(super) fn new(grid: Grid, outline: [Point2; 4], exact: [Point2; 4]) -> Self {
        let stride = (STRIDE / grid.cell).round().clamp(1.0, 1e3) as i32;
        let side = i32::try_from(grid.side).unwrap_or(0) / stride;
        let mut lattice = Self { stride, side, outline, exact, spans: Vec::new(), ends: Vec::new() };
        for heading in 0..HEADINGS {
            for step in 0..MOVES {
                let (way, turned) = moved(heading, step);
                let to = Vector2::new(f64::from(way.0), f64::from(way.1)) * f64::from(stride);
                let corners = swept(&lattice.outline, heading_of(heading), heading_of(turned), to * grid.cell);
                let cells =
                    corners.iter().map(|corner| Point2::from(corner.coords / grid.cell) + Vector2::new(0.5, 0.5));
                let spans = &mut lattice.spans;
                each_span(&hull(&mut cells.collect::<Vec<_>>()), |row, from, to| {
                    spans.push([row, from, to].map(|at| i16::try_from(at).unwrap_or(i16::MAX)));
                });
                lattice.ends.push(lattice.spans.len());
            }
        }
        lattice.spans.shrink_to_fit();
        lattice
    }

    /// The pose after a move. `None` outside of the square.
    pub(super) fn next(&self, node: Node, step: usize) -> Option<Node> {
        let ((x, y), heading) = moved(node.heading, step);
        self.checked(Node { column: node.column + x, row: node.row + y, heading })
    }

    fn checked(&self, node: Node) -> Option<Node> {
        let is_inside = |at: i32| (0..self.side).contains(&at);
        (is_inside(node.column) && is_inside(node.row)).then_some(node)
    }

    /// Length (m) of a move on a grid, and its rotation (rad).
    pub(super) fn size(&self, grid: Grid, step: usize) -> (f64, f64) {
        match STEPS.get(step) {
            Some(&(x, y)) => (f64::from(self.stride) * grid.cell * math::hypot(f64::from(x), f64::from(y)), 0.0),
            None => (0.0, TAU / HEADINGS as f64),
        }
    }

    /// True if a move of the lattice leads ahead.
    pub(super) fn is_ahead(node: Node, step: usize) -> bool {
        let Some(&(x, y)) = STEPS.get(step) else { return true };
        leads_ahead(heading_of(node.heading), Vector2::new(f64::from(x), f64::from(y)))
    }

    /// A number of a pose, less than 2³².
    pub(super) fn key(&self, node: Node) -> u32 {
        let place = u32::try_from(node.row * self.side + node.column).unwrap_or(0);
        place * HEADINGS_COUNT + u32::try_from(node.heading).unwrap_or(0)
    }

    /// The pose with a number.
    pub(super) fn node(&self, key: u32) -> Node {
        let place = i32::try_from(key / HEADINGS_COUNT).unwrap_or(0);
        Node { column: place % self.side, row: place / self.side, heading: key as usize % HEADINGS }
    }

    /// The cell of a pose.
    fn cell(&self, node: Node) -> (i32, i32) {
        (node.column * self.stride + self.stride / 2, node.row * self.stride + self.stride / 2)
    }

    /// A pose in the world frame.
    pub(super) fn pose(&self, grid: Grid, node: Node) -> Pose {
        let (column, row) = self.cell(node);
        Pose { position: grid.centre(column, row), heading: heading_of(node.heading) }
    }

    /// The pose of the lattice that is nearest to one in the world frame.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a heading in range")]
    pub(super) fn nearest(&self, grid: Grid, pose: Pose) -> Option<Node> {
        let (column, row) = grid.cell_at(pose.position)?;
        let heading = (pose.heading.rem_euclid(TAU) / TAU * HEADINGS as f64).round() as usize % HEADINGS;
        self.checked(Node { column: column.div_euclid(self.stride), row: row.div_euclid(self.stride), heading })
    }

    /// The ground of a move from a pose.
    pub(super) fn ground(&self, cells: &Cells, near: &NearSurfaces, node: Node, step: usize) -> Ground {
        let (column, row) = self.cell(node);
        let index = node.heading * MOVES + step;
        let from = index.checked_sub(1).map_or(0, |before| self.ends[before]);
        let mut worst = Ground::Proved;
        for &[down, left, right] in &self.spans[from..self.ends[index]] {
            let (left, right) = (column + i32::from(left), column + i32::from(right));
            worst = worst.max(ground_of_span(cells, near, row + i32::from(down), left, right));
            if worst == Ground::Blocked {
                break;
            }
        }
        worst
    }

    /// The ground between two poses of the world frame that are near each other.
    pub(super) fn ground_between(&self, cells: &Cells, near: &NearSurfaces, from: Pose, to: Pose) -> Ground {
        ground_of_sweep(&self.outline, cells, near, from, to)
    }

    /// The ground between the place of the body and a pose near it. A body that stands beside a surface, or that was stopped, has
    /// blocked ground within its margin. It may leave to a clear pose if its own outline meets none on the path. One that is partly in
    /// blocked ground or outside of the map may leave to any clear pose, slowly.
    pub(super) fn ground_leaving(&self, cells: &Cells, near: &NearSurfaces, from: Pose, to: Pose) -> Ground {
        let ground = self.ground_between(cells, near, from, to);
        if ground != Ground::Blocked {
            return ground;
        }
        let is_inside = ground_of_sweep(&self.exact, cells, near, from, from) == Ground::Blocked;
        let on_the_way =
            if is_inside { Ground::NearSurface } else { ground_of_sweep(&self.exact, cells, near, from, to) };
        on_the_way.max(self.ground_between(cells, near, to, to))
    }
}

/// True if a motion leads ahead, within 60° of the nose, for a body with this heading (rad). Whiskers feel what is ahead before the body
/// reaches it, and nothing feels what is behind. It is also true without a motion.
pub(super) fn leads_ahead(heading: f64, way: Vector2) -> bool {
    way.dot(&unit(heading)) >= 0.5 * way.norm()
}

/// The ground that an outline (m, body frame) sweeps between two poses.
fn ground_of_sweep(outline: &[Point2; 4], cells: &Cells, near: &NearSurfaces, from: Pose, to: Pose) -> Ground {
    let mut corners = swept(outline, from.heading, to.heading, to.position - from.position)
        .map(|corner| cells.grid.to_cells(from.position + corner.coords));
    let count = hull_in_place(&mut corners);
    ground_of_polygon(cells, near, &corners[..count])
}

/// The translation (strides) of a move, and the heading after it.
fn moved(heading: usize, step: usize) -> ((i32, i32), usize) {
    match STEPS.get(step) {
        Some(&way) => (way, heading),
        None if step == STEPS.len() => ((0, 0), (heading + 1) % HEADINGS),
        None => ((0, 0), (heading + HEADINGS - 1) % HEADINGS),
    }
}

/// The pose before a move.
pub(super) fn before(node: Node, step: usize) -> Node {
    // The last two moves are the rotations, each the opposite of the other one.
    let back = if step == STEPS.len() { step + 1 } else { STEPS.len() };
    let heading = if step < STEPS.len() { node.heading } else { moved(node.heading, back).1 };
    let ((x, y), _) = moved(node.heading, step);
    Node { column: node.column - x, row: node.row - y, heading }
}

/// The heading (rad) with an index.
fn heading_of(index: usize) -> f64 {
    wrap(TAU * index as f64 / HEADINGS as f64)
}

/// Corners of an outline (m, body frame) at two poses that differ by a rotation and by a translation (m).
fn swept(outline: &[Point2; 4], from: f64, to: f64, way: Vector2) -> [Point2; 8] {
    let turn = wrap(to - from).abs();
    // Between two headings the corners leave their chord by the sagitta.
    let sagitta = clearance::reach(outline) * (1.0 - math::cos(0.5 * turn));
    let outline = clearance::grown(outline, sagitta).unwrap_or(*outline);
    let first = clearance::at_pose(&outline, Pose { position: Point2::origin(), heading: from });
    let last = clearance::at_pose(&outline, Pose { position: way.into(), heading: to });
    std::array::from_fn(|index| if index < 4 { first[index] } else { last[index - 4] })
}

/// The convex hull of some points, counter-clockwise.
fn hull(points: &mut [Point2]) -> Vec<Point2> {
    let mut corners: [Point2; 8] = std::array::from_fn(|index| points[index]);
    let count = hull_in_place(&mut corners);
    corners[..count].to_vec()
}

/// Moves the convex hull of eight points to the front, counter-clockwise, and returns its number of corners (Andrew 1979).
fn hull_in_place(points: &mut [Point2; 8]) -> usize {
    points.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let mut chain = [Point2::origin(); 17];
    let mut count = 0;
    for pass in 0..2 {
        let first = count;
        for index in 0..8 {
            let point = if pass == 0 { points[index] } else { points[7 - index] };
            while count >= first + 2 && (chain[count - 1] - chain[count - 2]).perp(&(point - chain[count - 2])) <= 0.0 {
                count -= 1;
            }
            chain[count] = point;
            count += 1;
        }
        // The last point begins the other chain.
        count -= 1;
    }
    let count = count.clamp(1, 8);
    points[..count].copy_from_slice(&chain[..count]);
    count
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use proptest::prelude::*;

    use super::*;
    use crate::map::clearance::cell_margin;
    use crate::rig::Rig;

    fn lattice(grid: Grid) -> (Lattice, [Point2; 4]) {
        let outline = Rig::default().platform.outline_body();
        (Lattice::new(grid, clearance::grown(&outline, cell_margin(grid.cell)).unwrap(), outline), outline)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(6))]

        /// The oracle is the exact outline at many poses along the move.
        #[test]
        fn a_move_in_proved_ground_passes_no_unknown_point(
            holes in prop::collection::vec((-0.25..0.25_f64, -0.25..0.25_f64, 4e-3..0.03_f64), 1..5),
        ) {
            let grid = Grid::new(0.7, 2e-3);
            let (lattice, outline) = lattice(grid);
            let mut cells = Cells::new(grid);
            let side = i32::try_from(grid.side).unwrap();
            let is_covered = |point: Point2| holes.iter().any(|(x, y, radius)| (point - Point2::new(*x, *y)).norm() < *radius);
            for row in 0..side {
                for column in 0..side {
                    if !is_covered(grid.centre(column, row)) {
                        cells.free.fill(row, column, column);
                    }
                }
            }
            let near = NearSurfaces::new(grid, 0.1);
            let mut proved = 0;
            for key in 0..lattice.key(Node { column: 0, row: lattice.side, heading: 0 }) {
                let node = lattice.node(key);
                prop_assert_eq!(lattice.key(node), key);
                let step = key as usize % MOVES;
                let Some(next) = lattice.next(node, step) else { continue };
                prop_assert_eq!(before(next, step), node);
                if lattice.ground(&cells, &near, node, step) != Ground::Proved {
                    continue;
                }
                proved += 1;
                let (from, to) = (lattice.pose(grid, node), lattice.pose(grid, next));
                prop_assert_eq!(lattice.ground_between(&cells, &near, from, to), Ground::Proved);
                for share in 0..=4 {
                    let share = f64::from(share) / 4.0;
                    let position = from.position + share * (to.position - from.position);
                    let heading = from.heading + share * wrap(to.heading - from.heading);
                    for corner in clearance::at_pose(&outline, Pose { position, heading }) {
                        prop_assert!(!is_covered(corner), "{corner}");
                    }
                }
            }
            prop_assert!(proved > 100, "{proved}");
        }
    }
}
