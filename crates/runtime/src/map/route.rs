//! The route to a goal, and whether it is still open.

use crate::geometry::{Pose, turn_between};

use super::cells::Cells;
use super::clearance::{Ground, NearSurfaces};
use super::lattice::Lattice;
use super::route_follow::{Follower, NEAR, NEAR_HEADING, RouteMotion};
use super::route_search::{MOST_STEPS, Pace, Progress, RouteError, RouteSearch};

/// Expansions of the search in a tick. Each tests ten moves, so that they take a third of a millisecond on a small computer.
const EXPANSIONS: usize = 40;
/// Steps of a route that are tested again in a tick.
const TESTED: usize = 64;
/// Ticks after which a goal without a path is searched again, because the map grows.
const PATIENCE: u32 = 60;

/// A pose of a route, and the ground of the path to it from the pose before.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RouteStep {
    /// The pose of the body.
    pub pose: Pose,
    /// The worst ground on the path to it. It says how fast the body may go.
    pub ground: Ground,
}

/// What is known of the route.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RouteStatus {
    /// No goal was given.
    Idle,
    /// The search goes on. The body holds or goes on meanwhile.
    Searching,
    /// There is a route.
    Found,
    /// There is none. After some time it is searched again, because the map grows.
    Failed(RouteError),
}

/// The route to the last goal.
#[derive(Debug, Clone)]
pub(super) struct Route {
    lattice: Lattice,
    search: RouteSearch,
    pace: Pace,
    follower: Follower,
    goal: Option<Pose>,
    status: RouteStatus,
    is_begun: bool,
    failed_for: u32,
    steps: Vec<RouteStep>,
    tested: usize,
}

impl Route {
    /// Allocates the memory.
    pub(super) fn new(lattice: Lattice, pace: Pace) -> Self {
        Self {
            lattice,
            search: RouteSearch::new(pace),
            pace,
            follower: Follower::new(Pose::UNKNOWN),
            goal: None,
            status: RouteStatus::Idle,
            is_begun: false,
            failed_for: 0,
            steps: Vec::with_capacity(MOST_STEPS + 1),
            tested: 0,
        }
    }

    /// Sets the goal. The search begins in the next tick, unless the goal is that of the last call, up to the offsets at which a
    /// step is reached.
    pub(super) fn seek(&mut self, goal: Option<Pose>) {
        let is_same = match (self.goal, goal) {
            (Some(known), Some(goal)) => {
                (known.position - goal.position).norm() < NEAR
                    && turn_between(known.heading, goal.heading).abs() < NEAR_HEADING
            }
            (known, goal) => known.is_none() && goal.is_none(),
        };
        if !is_same {
            self.goal = goal;
            self.restart();
        }
    }

    fn restart(&mut self) {
        self.status = if self.goal.is_some() { RouteStatus::Searching } else { RouteStatus::Idle };
        (self.is_begun, self.failed_for, self.tested) = (false, 0, 0);
        self.steps.clear();
        self.follower = Follower::new(Pose::UNKNOWN);
    }

    /// The motion along the route. None while there is no route.
    pub(super) fn motion(&self) -> RouteMotion {
        self.follower.motion
    }

    /// True if the body is at the goal.
    pub(super) fn is_done(&self) -> bool {
        self.follower.is_done
    }

    /// The lattice of poses.
    pub(super) fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    pub(super) fn status(&self) -> RouteStatus {
        self.status
    }

    /// The steps of the route, if it is found.
    pub(super) fn steps(&self) -> &[RouteStep] {
        &self.steps
    }

    /// Continues with the body at `body`.
    pub(super) fn update(&mut self, cells: &Cells, near: &NearSurfaces, body: Pose) {
        let Some(goal) = self.goal else { return };
        match self.status {
            RouteStatus::Idle => {}
            RouteStatus::Searching => {
                let progress = if self.is_begun {
                    self.search.advance(&self.lattice, cells, near, EXPANSIONS)
                } else {
                    self.is_begun = true;
                    self.search.begin(&self.lattice, cells, near, body, goal)
                };
                match progress {
                    Progress::Searching => {}
                    Progress::Failed(error) => self.status = RouteStatus::Failed(error),
                    Progress::Found => self.collect(cells, near, body, goal),
                }
            }
            RouteStatus::Found => {
                self.test(cells, near);
                if self.status == RouteStatus::Found && !self.follower.update(&self.steps, &self.pace, body) {
                    self.restart();
                }
            }
            RouteStatus::Failed(_) => {
                self.failed_for += 1;
                if self.failed_for > PATIENCE {
                    self.restart();
                }
            }
        }
    }

    /// Takes the route from the search.
    fn collect(&mut self, cells: &Cells, near: &NearSurfaces, body: Pose, goal: Pose) {
        self.steps.clear();
        let mut before = body;
        let poses = self.search.nodes().iter().map(|&node| self.lattice.pose(cells.grid, node));
        for pose in poses.chain([goal]).take(self.steps.capacity()) {
            let ground = if self.steps.is_empty() {
                self.lattice.ground_leaving(cells, near, before, pose)
            } else {
                self.lattice.ground_between(cells, near, before, pose)
            };
            self.steps.push(RouteStep { pose, ground });
            before = pose;
        }
        self.status = RouteStatus::Found;
        self.follower = Follower::new(body);
        self.follower.update(&self.steps, &self.pace, body);
    }

    /// Tests some steps again. The search begins anew if one is blocked. The first one began where the body was then.
    fn test(&mut self, cells: &Cells, near: &NearSurfaces) {
        for _ in 0..TESTED.min(self.steps.len().saturating_sub(1)) {
            self.tested = self.tested % (self.steps.len() - 1) + 1;
            let (from, to) = (self.steps[self.tested - 1].pose, self.steps[self.tested].pose);
            let ground = self.lattice.ground_between(cells, near, from, to);
            if ground == Ground::Blocked {
                return self.restart();
            }
            self.steps[self.tested].ground = ground;
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use std::collections::{BinaryHeap, HashMap};

    use proptest::prelude::*;

    use super::*;
    use crate::geometry::{Point2, wrap};
    use crate::map::clearance::{cell_margin, grown};
    use crate::map::grid::Grid;
    use crate::map::lattice::{MOVES, Node};
    use crate::rig::Rig;

    const PACE: Pace =
        Pace { proved: (0.1, 0.8), unknown: (0.03, 0.3), near_surface: (0.0, 0.0), has_guarded_nose: false };

    fn room(walls: &[[f64; 4]]) -> (Cells, NearSurfaces) {
        let grid = Grid::new(1.5, 4e-3);
        let mut cells = Cells::new(grid);
        let corners = |[left, low, right, high]: [f64; 4]| {
            [(left, low), (right, low), (right, high), (left, high)].map(|(x, y)| Point2::new(x, y))
        };
        for wall in walls {
            cells.block_convex(corners(*wall));
        }
        // Everything else is free.
        let side = i32::try_from(grid.side).unwrap();
        for row in 0..side {
            for column in 0..side {
                if !cells.blocked.get(column, row) {
                    cells.free.fill(row, column, column);
                }
            }
        }
        (cells, NearSurfaces::new(grid, 0.1))
    }

    fn route(cells: &Cells) -> Route {
        let outline = Rig::default().platform.outline_body();
        let margin = cell_margin(cells.grid.cell);
        Route::new(Lattice::new(cells.grid, grown(&outline, margin).unwrap(), outline), PACE)
    }

    fn found(route: &mut Route, cells: &Cells, near: &NearSurfaces, start: Pose, goal: Pose) -> RouteStatus {
        route.seek(Some(goal));
        for _ in 0..4000 {
            route.update(cells, near, start);
            if route.status() != RouteStatus::Searching {
                break;
            }
        }
        route.status()
    }

    fn at(x: f64, y: f64, heading: f64) -> Pose {
        Pose { position: Point2::new(x, y), heading }
    }

    /// Cost of the shortest path between two nodes, by Dijkstra.
    fn shortest(route: &Route, cells: &Cells, near: &NearSurfaces, from: Node, to: Node) -> Option<f64> {
        let lattice = &route.lattice;
        let mut done = HashMap::new();
        let mut open = BinaryHeap::from([(std::cmp::Reverse(0_u64), lattice.key(from))]);
        while let Some((std::cmp::Reverse(cost), key)) = open.pop() {
            if done.contains_key(&key) {
                continue;
            }
            done.insert(key, cost);
            if key == lattice.key(to) {
                return Some(cost as f64 * 1e-3);
            }
            let node = lattice.node(key);
            for step in 0..MOVES {
                if let Some(next) = lattice.next(node, step)
                    && lattice.ground(cells, near, node, step) == Ground::Proved
                {
                    let (length, turn) = lattice.size(cells.grid, step);
                    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small time")]
                    let more = ((length / PACE.proved.0 + turn / PACE.proved.1) * 1e3).round() as u64;
                    open.push((std::cmp::Reverse(cost + more), lattice.key(next)));
                }
            }
        }
        None
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(5))]

        /// The oracle is Dijkstra's method without a limit of memory or work.
        #[test]
        fn a_route_is_at_most_half_longer_than_the_shortest_one(
            door in -0.4..0.4_f64, width in 0.17..0.3_f64, start in -3.0..3.0_f64, end in -3.0..3.0_f64,
        ) {
            let (cells, near) = room(&[[-0.02, -0.8, 0.02, door - 0.5 * width], [-0.02, door + 0.5 * width, 0.02, 0.8]]);
            let mut route = route(&cells);
            let (start, goal) = (at(-0.4, 0.1, start), at(0.4, -0.1, end));
            prop_assert_eq!(found(&mut route, &cells, &near, start, goal), RouteStatus::Found);
            let steps = route.steps().to_vec();
            let time: f64 = steps.windows(2).map(|pair| {
                let [a, b] = [pair[0].pose, pair[1].pose];
                (b.position - a.position).norm() / PACE.proved.0 + wrap(b.heading - a.heading).abs() / PACE.proved.1
            }).sum();
            prop_assert!(steps.iter().all(|step| step.ground == Ground::Proved));
            prop_assert_eq!(steps.last().unwrap().pose, goal);
            let [from, to] = [steps[0].pose, goal].map(|pose| route.lattice.nearest(cells.grid, pose).unwrap());
            let least = shortest(&route, &cells, &near, from, to).unwrap();
            prop_assert!(time < 1.5 * least + 2.0, "{time} s, {least} s");
        }
    }

    #[test]
    fn a_closed_wall_has_no_way_and_a_new_wall_restarts_the_search() {
        let (mut cells, near) = room(&[]);
        let mut route = route(&cells);
        let (start, goal) = (at(-0.3, 0.0, 0.0), at(0.3, 0.0, 1.0));
        assert_eq!(found(&mut route, &cells, &near, start, goal), RouteStatus::Found);
        let grid = cells.grid;
        let wall = |x: f64| grid.cell_at(Point2::new(x, 0.0)).unwrap().0;
        let (closed, near) = room(&[[-0.01, -0.8, 0.01, 0.8]]);
        assert!(!closed.free.get(wall(0.0), 100));
        cells = closed;
        for _ in 0..10 {
            route.update(&cells, &near, start);
        }
        assert_eq!(route.status(), RouteStatus::Searching);
        assert!(route.steps().is_empty());
        assert_eq!(found(&mut route, &cells, &near, start, goal), RouteStatus::Failed(RouteError::NoWay));
        assert_eq!(
            found(&mut route, &cells, &near, start, at(0.0, 0.0, 0.0)),
            RouteStatus::Failed(RouteError::GoalBlocked)
        );
        route.seek(None);
        assert_eq!(route.status(), RouteStatus::Idle);
    }

    #[test]
    fn a_body_that_was_stopped_finds_a_way_back() {
        let (mut cells, near) = room(&[]);
        // Ground right before the nose has become blocked.
        let wall = [(0.11, -0.3), (0.13, -0.3), (0.13, 0.3), (0.11, 0.3)].map(|(x, y)| Point2::new(x, y));
        cells = {
            let mut walled = Cells::new(cells.grid);
            walled.block_convex(wall);
            let side = i32::try_from(cells.grid.side).unwrap();
            for row in 0..side {
                for column in (0..side).filter(|&column| !walled.blocked.get(column, row)) {
                    walled.free.fill(row, column, column);
                }
            }
            walled
        };
        let mut route = route(&cells);
        let start = at(0.0, 0.0, 0.0);
        assert_eq!(route.lattice.ground_between(&cells, &near, start, start), Ground::Blocked);
        assert_eq!(found(&mut route, &cells, &near, start, at(-0.3, 0.2, 2.0)), RouteStatus::Found);
        assert!(route.steps().iter().all(|step| step.ground == Ground::Proved));
        assert!(route.steps().iter().all(|step| step.pose.position.x < 0.0));
    }

    #[test]
    fn a_body_partly_outside_of_the_map_finds_a_way_back() {
        let (cells, near) = room(&[]);
        let mut route = route(&cells);
        let start = at(0.665, 0.0, 0.0);
        assert_eq!(found(&mut route, &cells, &near, start, at(-0.3, 0.2, 2.0)), RouteStatus::Found);
        assert_eq!(route.steps()[0].ground, Ground::NearSurface);
        assert!(route.steps()[1..].iter().all(|step| step.ground == Ground::Proved));
    }

    #[test]
    fn a_route_leaves_ground_near_surfaces_out_if_the_pace_forbids_it() {
        let cells = Cells::new(Grid::new(1.5, 4e-3));
        let mut near = NearSurfaces::new(cells.grid, 0.1);
        // A row of surfaces with an end at the top.
        for step in 0..80 {
            near.add(cells.grid.cell_at(Point2::new(0.0, -0.7 + 0.01 * f64::from(step))).unwrap());
        }
        let mut route = route(&cells);
        let (start, goal) = (at(-0.35, 0.0, 0.0), at(0.35, 0.0, 0.0));
        assert_eq!(found(&mut route, &cells, &near, start, goal), RouteStatus::Found);
        assert!(route.steps().iter().all(|step| step.ground == Ground::Unknown));
        let highest = route.steps().iter().map(|step| step.pose.position.y).fold(0.0, crate::math::max);
        assert!(highest > 0.25, "{highest} m");
    }
}
