//! A search for a route, with a bounded number of expansions in a tick.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::geometry::{Pose, turn_between};

use super::cells::Cells;
use super::clearance::{Ground, NearSurfaces};
use super::lattice::{HEADINGS, Lattice, MOVES, Node, before, leads_ahead};

/// Slots of the table of poses, and the most that are used.
const SLOTS: usize = 1 << 17;
const MOST_POSES: usize = 100_000;
/// Most open poses.
const MOST_OPEN: usize = 1 << 15;
/// Most poses of a route. At 24 mm each they are as long as the sides of the map together.
pub(super) const MOST_STEPS: usize = 1024;
/// Unit of costs (s).
const UNIT: f64 = 10e-3;
/// Additional cost of a move into unproved ground that does not lead ahead, in units. It is that of turning round in unknown ground, so
/// the body rather turns, where it can.
const UNGUARDED: u32 = 500;
/// Strides to the farthest pose at which a route may begin.
const FARTHEST_START: i32 = 4;
/// Factor, in halves, by which the estimate of the time that is left counts more. A route is then at most so much longer than the
/// shortest one, and the search expands a fraction of the poses.
const WEIGHT_IN_HALVES: u32 = 3;
/// Strides from the goal at which the rest of the path is tried.
const NEAR_GOAL: i32 = 1;

/// Speeds in each kind of ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pace {
    /// Speed (m/s) and yaw rate (rad/s) in ground that is proved free.
    pub proved: (f64, f64),
    /// In unknown ground far from known surfaces.
    pub unknown: (f64, f64),
    /// In unknown ground near known surfaces. 0 if no route may lead there.
    pub near_surface: (f64, f64),
    /// True if whiskers before the nose feel what is ahead of the body. It then enters unproved ground with the nose ahead.
    pub has_guarded_nose: bool,
}

impl Default for Pace {
    /// A tenth of a metre a second where nothing can be met, a third of it where the body must be ready to stop, and no path near
    /// surfaces, which only a rig with whiskers before its nose can take.
    fn default() -> Self {
        Self { proved: (0.1, 0.8), unknown: (0.03, 0.3), near_surface: (0.0, 0.0), has_guarded_nose: false }
    }
}

impl Pace {
    /// Cost of a move of a length (m) and a rotation (rad). `None` if it is not allowed.
    fn cost(&self, ground: Ground, (length, turn): (f64, f64)) -> Option<u32> {
        let (speed, yaw_rate) = match ground {
            Ground::Proved => self.proved,
            Ground::Unknown => self.unknown,
            Ground::NearSurface => self.near_surface,
            Ground::Blocked => return None,
        };
        let time = length / speed + turn / yaw_rate;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "limited")]
        let cost = (time / UNIT).round().clamp(1.0, 1e4) as u32;
        (speed > 0.0 && yaw_rate > 0.0).then_some(cost)
    }
}

/// Why there is no route.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum RouteError {
    /// The body cannot leave its place.
    #[error("the body cannot leave its place without entering blocked ground")]
    Enclosed,
    /// The goal is blocked or outside of the map.
    #[error("the goal is in blocked ground or outside of the map; choose another one")]
    GoalBlocked,
    /// All poses that can be reached were tried.
    #[error("no way leads to the goal through the ground that the pace allows")]
    NoWay,
    /// The memory of the search is used up.
    #[error("the way to the goal is too long for the memory of the search; choose a nearer goal")]
    TooFar,
}

/// A pose in the table.
#[derive(Debug, Clone, Copy)]
struct Entry {
    /// Number of the pose plus 1, or 0 for a free slot.
    key: u32,
    /// Cost from the start, in units, limited to 16 bits.
    cost: u16,
    /// The move that led to it, or `MOVES` for a start.
    by: u8,
    is_closed: bool,
}

const FREE: Entry = Entry { key: 0, cost: 0, by: 0, is_closed: false };

/// The search by A* with a weighted estimate.
#[derive(Debug, Clone)]
pub(super) struct RouteSearch {
    table: Vec<Entry>,
    used: usize,
    open: BinaryHeap<Reverse<(u32, u32)>>,
    goal: Pose,
    goal_node: Node,
    /// Costs of a stride, of a diagonal one and of a rotation in proved ground.
    least: [u32; 3],
    pace: Pace,
    /// The nodes of the route from the start, once it is found.
    nodes: Vec<Node>,
}

/// The result of some expansions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Progress {
    Searching,
    Found,
    Failed(RouteError),
}

impl RouteSearch {
    /// Allocates the memory.
    pub(super) fn new(pace: Pace) -> Self {
        Self {
            table: vec![FREE; SLOTS],
            used: 0,
            open: BinaryHeap::with_capacity(MOST_OPEN),
            goal: Pose::UNKNOWN,
            goal_node: Node { column: 0, row: 0, heading: 0 },
            least: [1; 3],
            pace,
            nodes: Vec::with_capacity(MOST_STEPS),
        }
    }

    /// The poses of the lattice on the route that was found.
    pub(super) fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Begins a search from one pose to another one.
    pub(super) fn begin(
        &mut self,
        lattice: &Lattice,
        cells: &Cells,
        near: &NearSurfaces,
        start: Pose,
        goal: Pose,
    ) -> Progress {
        self.table.fill(FREE);
        self.open.clear();
        self.nodes.clear();
        (self.used, self.goal) = (0, goal);
        let grid = cells.grid;
        let Some(goal_node) = lattice.nearest(grid, goal) else { return Progress::Failed(RouteError::GoalBlocked) };
        if lattice.ground_between(cells, near, goal, goal) == Ground::Blocked {
            return Progress::Failed(RouteError::GoalBlocked);
        }
        self.goal_node = goal_node;
        self.least = [0, 4, 8].map(|step| self.pace.cost(Ground::Proved, lattice.size(grid, step)).unwrap_or(1));
        let Some(nearest) = lattice.nearest(grid, start) else { return Progress::Failed(RouteError::Enclosed) };
        // Where all poses nearby are blocked, as after several stops, the body goes straight to one that is farther away.
        for reach in [1, FARTHEST_START] {
            if self.open.is_empty() {
                self.leave(lattice, cells, near, (start, nearest), reach);
            }
        }
        if self.open.is_empty() { Progress::Failed(RouteError::Enclosed) } else { Progress::Searching }
    }

    /// Reaches the poses within so many strides of the pose of the lattice that is nearest to the start.
    fn leave(
        &mut self,
        lattice: &Lattice,
        cells: &Cells,
        near: &NearSurfaces,
        (start, nearest): (Pose, Node),
        reach: i32,
    ) {
        let around = (0..3).flat_map(|turn| {
            (-reach..=reach).flat_map(move |down| (-reach..=reach).map(move |across| (turn, across, down)))
        });
        for (turn, across, down) in around {
            let heading = (nearest.heading + HEADINGS - 1 + turn) % HEADINGS;
            let node = Node { column: nearest.column + across, row: nearest.row + down, heading };
            let pose = lattice.pose(cells.grid, node);
            // The body may leave the place where it is also near a surface.
            let ground = lattice.ground_leaving(cells, near, start, pose);
            let size = ((pose.position - start.position).norm(), turn_between(start.heading, pose.heading).abs());
            let cost = self
                .pace
                .cost(ground, size)
                .or_else(|| Pace { near_surface: self.pace.unknown, ..self.pace }.cost(ground, size));
            let is_guarded = ground == Ground::Proved
                || !self.pace.has_guarded_nose
                || leads_ahead(start.heading, pose.position - start.position);
            if let (Some(cost), Some(_)) = (cost, lattice.nearest(cells.grid, pose)) {
                let cost = if is_guarded { cost } else { cost + UNGUARDED };
                self.reach(lattice.key(node), cost, MOVES, self.estimate(node));
            }
        }
    }

    /// Makes at most so many expansions.
    pub(super) fn advance(
        &mut self,
        lattice: &Lattice,
        cells: &Cells,
        near: &NearSurfaces,
        expansions: usize,
    ) -> Progress {
        for _ in 0..expansions {
            let Some(Reverse((_, slot))) = self.open.pop() else { return Progress::Failed(RouteError::NoWay) };
            let entry = &mut self.table[slot as usize];
            if entry.is_closed {
                continue;
            }
            entry.is_closed = true;
            let Entry { key, cost, .. } = *entry;
            let node = lattice.node(key - 1);
            if self.arrives(lattice, cells, near, node) {
                return self.trace(lattice, node);
            }
            for step in 0..MOVES {
                let Some(next) = lattice.next(node, step) else { continue };
                let number = lattice.key(next);
                // The ground need not be looked at if no ground makes the way through this pose shorter.
                let at_best =
                    u32::from(cost) + self.pace.cost(Ground::Proved, lattice.size(cells.grid, step)).unwrap_or(0);
                if self.is_settled(number, at_best) {
                    continue;
                }
                let ground = lattice.ground(cells, near, node, step);
                // Unproved ground is entered with the nose ahead, unless there is no other way.
                let is_guarded =
                    ground == Ground::Proved || !self.pace.has_guarded_nose || Lattice::is_ahead(node, step);
                let extra = if is_guarded { 0 } else { UNGUARDED };
                if let Some(more) = self.pace.cost(ground, lattice.size(cells.grid, step)) {
                    let estimate = self.estimate(next);
                    if !self.reach(number, u32::from(cost) + more + extra, step, estimate) {
                        return Progress::Failed(RouteError::TooFar);
                    }
                }
            }
        }
        Progress::Searching
    }

    /// True if the goal can be reached directly from a pose.
    fn arrives(&self, lattice: &Lattice, cells: &Cells, near: &NearSurfaces, node: Node) -> bool {
        let turn = (node.heading + HEADINGS - self.goal_node.heading) % HEADINGS;
        let is_close = (node.column - self.goal_node.column).abs() <= NEAR_GOAL
            && (node.row - self.goal_node.row).abs() <= NEAR_GOAL
            && (turn <= 1 || turn == HEADINGS - 1);
        is_close && {
            let pose = lattice.pose(cells.grid, node);
            // A goal may be near a surface, because surfaces are what whiskers go to.
            match lattice.ground_between(cells, near, pose, self.goal) {
                Ground::Proved => true,
                Ground::Unknown | Ground::NearSurface => {
                    !self.pace.has_guarded_nose || leads_ahead(pose.heading, self.goal.position - pose.position)
                }
                Ground::Blocked => false,
            }
        }
    }

    /// Collects the route to a pose.
    fn trace(&mut self, lattice: &Lattice, mut node: Node) -> Progress {
        self.nodes.clear();
        while self.nodes.len() < MOST_STEPS {
            self.nodes.push(node);
            let by = self.slot(lattice.key(node)).map_or(MOVES, |slot| usize::from(self.table[slot].by));
            if by == MOVES {
                self.nodes.reverse();
                return Progress::Found;
            }
            node = before(node, by);
        }
        Progress::Failed(RouteError::TooFar)
    }

    /// Weighted estimate of the cost from a pose to the goal.
    fn estimate(&self, node: Node) -> u32 {
        let (x, y) = (node.column.abs_diff(self.goal_node.column), node.row.abs_diff(self.goal_node.row));
        let (more, less) = (x.max(y), x.min(y));
        let turn = node.heading.abs_diff(self.goal_node.heading);
        let turn = u32::try_from(turn.min(HEADINGS - turn)).unwrap_or(0);
        let exact = (more - less) * self.least[0] + less * self.least[1] + turn * self.least[2];
        exact * WEIGHT_IN_HALVES / 2
    }

    /// The slot of a pose, or the free one for it.
    fn slot(&self, number: u32) -> Option<usize> {
        let first = (number.wrapping_mul(0x9e37_79b1) >> 15) as usize;
        (0..SLOTS).map(|index| (first + index) % SLOTS).find(|&slot| {
            let key = self.table[slot].key;
            key == 0 || key == number + 1
        })
    }

    /// True if a pose is closed or was reached at no more than this cost.
    fn is_settled(&self, number: u32, cost: u32) -> bool {
        let entry = self.slot(number).map(|slot| self.table[slot]).filter(|entry| entry.key != 0);
        entry.is_some_and(|entry| entry.is_closed || u32::from(entry.cost) <= cost)
    }

    /// Reaches a pose at a cost. Returns false if no memory is left.
    fn reach(&mut self, number: u32, cost: u32, by: usize, estimate: u32) -> bool {
        let Some(slot) = self.slot(number) else { return false };
        let limited = u16::try_from(cost).unwrap_or(u16::MAX);
        let entry = &mut self.table[slot];
        let is_new = entry.key == 0;
        if !is_new && (entry.is_closed || entry.cost <= limited) {
            return true;
        }
        if (is_new && self.used >= MOST_POSES) || self.open.len() >= MOST_OPEN {
            return false;
        }
        self.used += usize::from(is_new);
        *entry = Entry { key: number + 1, cost: limited, by: u8::try_from(by).unwrap_or(u8::MAX), is_closed: false };
        self.open.push(Reverse((cost + estimate, u32::try_from(slot).unwrap_or(0))));
        true
    }
}
