//! What callers ask of a map.

use crate::geometry::{Point2, Pose, Vector2};

use super::cell_span::CellSpan;
use super::cells::Cell;
use super::clearance::{self, Ground};
use super::contour_ends::ContourEnd;
use super::contours::ContourPoint;
use super::first_touch::FirstTouch;
use super::frontier::{BLOCK, Frontier};
use super::route::{RouteStatus, RouteStep};
use super::route_follow::RouteMotion;
use super::shaft_contact::ShaftContact;
use super::targets::Target;
use super::touch_map::Map;

impl Map {
    /// The contact of a whisker, by its index in the policy, at a place that is fixed, while it is bent. It is one of the shaft only if
    /// [`ShaftContact::is_shaft`].
    #[must_use]
    pub fn shaft_contact(&self, whisker: usize) -> Option<&ShaftContact> {
        self.whisker(whisker)?.touch()?.contact.as_ref()
    }

    /// The part of a whisker that may have touched first, since it is bent. `None` also if all of the shaft was beside free
    /// ground.
    #[must_use]
    pub fn first_touch(&self, whisker: usize) -> Option<&FirstTouch> {
        self.whisker(whisker)?.touch()?.first.as_ref()
    }

    /// The target that should be touched or looked at next. It changes only when it is done, when it fails, or when another one is
    /// clearly better. `None` before the first pass through the map, and when nothing is left.
    #[must_use]
    pub fn next_target(&self) -> Option<Target> {
        self.targets.current().copied()
    }

    /// Tells that the target to which the last route led could not be touched, or else the next one. After three attempts it is closed,
    /// and so is what is near it. To come to the pose of an end is an attempt, too.
    pub fn fail_target(&mut self) {
        self.targets.fail(&mut self.frontier, self.cells.grid);
    }

    /// Tells that something was felt at a position (m, world frame), with free ground in the direction of `normal`. It becomes a
    /// target, unless it is known, is in ground that is proved free, or could not be touched before.
    pub fn feel(&mut self, position: Point2, normal: Vector2) {
        let Some(normal) = normal.try_normalize(0.0) else { return };
        if !self.is_placed || self.cells.is_inside_free(position, self.settings.cell) {
            return;
        }
        if let Some(cell) = self.cells.grid.cell_at(position) {
            self.near.add(cell);
            self.targets.touch(position, normal, &self.frontier, self.cells.grid);
        }
    }

    /// Sets the goal of the route, or none. The search takes some ticks, and [`route_status`](Self::route_status) tells about it. A
    /// goal that is already set changes nothing.
    pub fn seek_route(&mut self, goal: Option<Pose>) {
        if let Some(goal) = goal {
            self.targets.pursue(goal);
        }
        self.route.seek(goal);
    }

    /// What is known of the route.
    #[must_use]
    pub fn route_status(&self) -> RouteStatus {
        self.route.status()
    }

    /// The poses of the route, the goal last. Empty unless there is one.
    #[must_use]
    pub fn route(&self) -> &[RouteStep] {
        self.route.steps()
    }

    /// The motion along the route. The body stands still while there is none.
    #[must_use]
    pub fn route_motion(&self) -> RouteMotion {
        self.route.motion()
    }

    /// True if the body has followed the route to its goal and is still there.
    #[must_use]
    pub fn is_at_goal(&self) -> bool {
        self.route.is_done()
    }

    /// True if a contour was recorded within a distance (m) of a point (m, world frame).
    #[must_use]
    pub fn is_traced(&self, point: Point2, within: f64) -> bool {
        self.contours.points().iter().any(|known| (known.place - point).norm() <= within)
    }

    /// Area (m²) of the unknown ground beside free ground, in blocks of eight cells. Ground beside a known surface and ground whose
    /// targets have failed do not count. It is 0 before the first pass through the map.
    #[must_use]
    pub fn unknown_area(&self) -> f64 {
        self.frontier.area(self.cells.grid).unwrap_or(0.0)
    }

    /// True if nothing that this array can reach is left to be touched or looked at.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.targets.is_complete()
    }

    /// True if a point (m, world frame) is proved free.
    #[must_use]
    pub fn is_free(&self, point: Point2) -> bool {
        self.at(point) == Cell::Free
    }

    /// What is known of a point (m, world frame).
    #[must_use]
    pub fn at(&self, point: Point2) -> Cell {
        if self.is_placed { self.cells.at(point) } else { Cell::Unknown }
    }

    /// The ground that the body covers at a pose, with a margin for the size of the cells and for the bounds of the settings.
    #[must_use]
    pub fn ground(&self, pose: Pose) -> Ground {
        if !self.is_placed {
            return Ground::Unknown;
        }
        let corners = clearance::at_pose(&self.clear_outline, pose).map(|corner| self.cells.grid.to_cells(corner));
        clearance::ground_of_polygon(&self.cells, &self.near, &corners)
    }

    /// True if the body touches nothing at a pose: all of its ground is proved free.
    #[must_use]
    pub fn clear(&self, pose: Pose) -> bool {
        self.ground(pose) == Ground::Proved
    }

    /// The centres (m, world frame) of the cells that are proved free, row by row.
    pub fn free_cells(&self) -> impl Iterator<Item = Point2> + '_ {
        self.cells.free.set().map(|(column, row)| self.cells.grid.centre(column, row))
    }

    /// The cells that are proved free, as rectangles of a cell's height. Each is as long as possible.
    pub fn free_spans(&self) -> impl Iterator<Item = CellSpan> + '_ {
        self.cells.free.spans().map(|span| CellSpan::new(self.cells.grid, span))
    }

    /// The cells that were blocked, as rectangles of a cell's height. Some of them may have been proved free later.
    pub fn blocked_spans(&self) -> impl Iterator<Item = CellSpan> + '_ {
        self.cells.blocked.spans().map(|span| CellSpan::new(self.cells.grid, span))
    }

    /// Side (m) of a block of [unknown ground](Self::unknown_blocks).
    #[must_use]
    pub fn block_size(&self) -> f64 {
        BLOCK as f64 * self.cells.grid.cell
    }

    /// Side of a cell (m).
    #[must_use]
    pub fn cell_size(&self) -> f64 {
        self.cells.grid.cell
    }

    /// The middles (m, world frame) of the blocks of unknown ground beside free ground, in the order of rows. Other than for the
    /// [unknown area](Self::unknown_area), ground whose targets have failed counts.
    pub fn unknown_blocks(&self) -> impl Iterator<Item = Point2> + '_ {
        self.frontier.left().map(|block| Frontier::centre(self.cells.grid, block))
    }

    /// The recorded points of surfaces. The points of a piece are in order.
    pub fn contours(&self) -> impl Iterator<Item = ContourPoint> + '_ {
        self.contours.shown()
    }

    /// Length (m) of all recorded contours. A surface that was followed twice counts twice.
    #[must_use]
    pub fn contour_length(&self) -> f64 {
        self.contours.length()
    }

    /// The ends of the recorded contours.
    pub fn contour_ends(&self) -> impl Iterator<Item = ContourEnd> + '_ {
        self.ends.ends(&self.contours).map(|(_, end)| end)
    }

    /// Number of recorded tips that were refuted, because they lay in ground that is proved free or because
    /// the shaft touched.
    #[must_use]
    pub fn refuted_tips(&self) -> u64 {
        self.refuted
    }

    /// Number of recorded tips that found no memory.
    #[must_use]
    pub fn lost_tips(&self) -> u64 {
        self.contours.lost()
    }

    /// Area (m²) that is proved free.
    #[must_use]
    pub fn free_area(&self) -> f64 {
        self.cells.free_area()
    }
}
