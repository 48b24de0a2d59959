//! The map of a run.

use crate::geometry::{Point2, Pose, Vector2, perpendicular};
use crate::machine::{Senses, WhiskerVector};
use crate::math;
use crate::percept::Perception;
use crate::rig::Rig;
use crate::signal::{Command, MAX_WHISKERS};

use super::cells::Cells;
use super::clearance::{self, NearSurfaces};
use super::contour_ends::ContourEnds;
use super::contours::Contours;
use super::frontier::{BLOCK, Frontier};
use super::grid::Grid;
use super::lattice::Lattice;
use super::mapped_whisker::{MappedWhisker, Touch};
use super::route::Route;
use super::settings::{MapError, MapSettings};
use super::shaft_sweep::Bounds;
use super::targets::{Known, Targets};

/// A map by touch. Memory is allocated when it is created, and a tick does a bounded amount of work.
#[derive(Debug, Clone)]
pub struct Map {
    pub(super) settings: MapSettings,
    pub(super) cells: Cells,
    pub(super) contours: Contours,
    pub(super) ends: ContourEnds,
    pub(super) frontier: Frontier,
    pub(super) targets: Targets,
    pub(super) route: Route,
    /// Number of recorded tips that lay in free ground, or whose shaft touched.
    pub(super) refuted: u64,
    /// True once the square has been laid about the first known pose.
    pub(super) is_placed: bool,
    pub(super) near: NearSurfaces,
    /// Corners of the body (m, body frame), and with the margin of a clear pose.
    outline_body: [Point2; 4],
    pub(super) clear_outline: [Point2; 4],
    whiskers: Vec<MappedWhisker>,
    /// Poses of the newest ticks, the newest first. Unknown after a gap.
    poses: [Pose; MOST_WAITING + 1],
    /// Number of ticks for which a straight shaft waits.
    waiting: usize,
    /// Number of successive ticks in which the body was stopped, and the period of a tick (s).
    stopped_for: u32,
    period: f64,
    /// Largest motion (m) of a point of the array in a tick.
    jump: f64,
}

/// Standard deviations of the measured errors of poses that count as their bound.
const POSE_DEVIATIONS: f64 = 3.0;
/// Most ticks for which a straight shaft waits.
const MOST_WAITING: usize = 7;
/// Factor of the limits of the platform beyond which a motion in a tick is a jump of the measured pose.
const JUMP: f64 = 1.5;
/// Standard deviations of a tip within which it may lie outside of free ground.
const DEVIATIONS: f64 = 3.0;
/// Depth (m) behind a recorded surface that is blocked. It is more than the diagonal of two cells, so that no path leads between
/// them.
const SURFACE: f64 = 6e-3;
/// Successive ticks in which a body must be stopped. Its servos need some of them to follow a command.
const STOPPED: u32 = 5;
/// Distance (m) ahead of a body that is stopped which must not be entered.
const BLOCKED_AHEAD: f64 = 6e-3;

impl Map {
    /// Creates the map of `rig` with its whiskers of these indices, in the order of a policy. `None` is a whisker that the
    /// rig lacks.
    ///
    /// # Errors
    /// [`MapError`] if the settings give no map.
    ///
    /// # Panics
    /// If the rig has no whisker with such an index.
    pub fn new(rig: &Rig, whiskers: &[Option<usize>], settings: MapSettings) -> Result<Self, MapError> {
        settings.check()?;
        let slots = whiskers.len();
        let fitted =
            whiskers.iter().enumerate().filter_map(|(index, at)| at.map(|at| (index, rig.whiskers[at].perceived())));
        let fitted: Vec<_> = fitted.take(MAX_WHISKERS).collect();
        let whiskers: Vec<_> =
            fitted.iter().map(|(index, whisker)| MappedWhisker::new(*index, whisker, &rig.sensing)).collect();
        let period = rig.sensing.control_rate.recip();
        // A base angle follows its moment after the delay of the hinge, and is read at the next sample.
        let delay =
            rig.whiskers.iter().map(|whisker| whisker.hinge.damping / whisker.hinge.stiffness).fold(0.0, math::max);
        let wait = delay + rig.sensing.sample_rate.recip();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
        let waiting = ((wait / period).ceil() as usize).clamp(1, MOST_WAITING);
        let reach = rig
            .whiskers
            .iter()
            .map(|whisker| whisker.base_body.coords.norm() + whisker.shaft.length)
            .fold(0.0, math::max);
        let platform = &rig.platform;
        let outline_body = platform.outline_body();
        let margin = clearance::cell_margin(settings.cell)
            + settings.position_bound
            + settings.heading_bound * clearance::reach(&outline_body);
        let longest = rig.whiskers.iter().map(|whisker| whisker.shaft.length).fold(0.0, math::max);
        let grid = Grid::new(settings.extent, settings.cell);
        let clear_outline = clearance::grown(&outline_body, margin).unwrap_or(outline_body);
        let targets = fitted.iter().map(|(index, whisker)| (*index, whisker));
        let block = BLOCK as f64 * settings.cell;
        Ok(Self {
            settings,
            frontier: Frontier::new(grid),
            targets: Targets::new(targets, platform, settings.pace, block),
            route: Route::new(Lattice::new(grid, clear_outline, outline_body), settings.pace),
            cells: Cells::new(grid),
            near: NearSurfaces::new(grid, longest),
            contours: Contours::new(slots),
            ends: ContourEnds::new(),
            refuted: 0,
            is_placed: false,
            outline_body,
            clear_outline,
            whiskers,
            poses: [Pose::UNKNOWN; MOST_WAITING + 1],
            waiting,
            stopped_for: 0,
            period,
            jump: JUMP * period * (platform.speed_limit + platform.yaw_rate_limit * reach),
        })
    }

    /// Continues the map with a tick of `perception`. `pose` is that of the body at the newest sample, usually
    /// [`Perception::pose`], and `command` is the one under which the body has moved since the last tick.
    pub fn update(&mut self, perception: &Perception, pose: Pose, command: Command) {
        let is_known = pose.is_finite() && perception.has_measured_pose();
        self.poses.rotate_right(1);
        self.poses[0] = if is_known { pose } else { Pose::UNKNOWN };
        if !is_known {
            for whisker in &mut self.whiskers {
                whisker.interrupt();
            }
            return;
        }
        if !self.is_placed {
            self.cells.grid = self.cells.grid.about(pose.position);
            self.is_placed = true;
        }
        let (position, heading) = perception.pose_deviation();
        let position = self.settings.position_bound + POSE_DEVIATIONS * position;
        let heading = self.settings.heading_bound + POSE_DEVIATIONS * heading;
        self.claim_body(pose, position, heading);
        self.follow_shafts(perception, position, heading);
        self.keep_shaft_contacts();
        self.record_tips(perception, position);
        self.ends.update(&self.contours);
        let is_stopped = perception.is_blocked() && !self.has_moved(command);
        self.stopped_for = if is_stopped { self.stopped_for.saturating_add(1) } else { 0 };
        if self.stopped_for >= STOPPED {
            self.block_ahead(pose, command);
        }
        let known = Known {
            cells: &self.cells,
            near: &self.near,
            lattice: self.route.lattice(),
            contours: &self.contours,
            ends: &self.ends,
            body: pose,
        };
        self.targets.update(known, &mut self.frontier);
        self.route.update(&self.cells, &self.near, pose);
    }

    /// Marks the positions where shafts touch, so that no path leads through them. A place in free ground is refuted.
    fn keep_shaft_contacts(&mut self) {
        for whisker in &self.whiskers {
            let Some(contact) = whisker.touch().and_then(Touch::steady_shaft) else { continue };
            if !self.cells.is_inside_free(contact.place, self.settings.cell + DEVIATIONS * contact.deviation)
                && let Some(cell) = self.cells.grid.cell_at(contact.place)
            {
                self.near.add(cell);
                self.cells.blocked.fill(cell.1, cell.0, cell.0);
                self.targets.touch(contact.place, contact.normal, &self.frontier, self.cells.grid);
            }
        }
    }

    /// Records the tips that perception has recorded in this tick, with this bound (m) of the error of positions. A tip inside
    /// of free ground is not one: the whisker touches with another part.
    fn record_tips(&mut self, perception: &Perception, position: f64) {
        for slot in 0..self.whiskers.len() {
            let whisker = self.whiskers[slot].index;
            let Some(tip) = perception.recorded_tip(whisker) else {
                self.contours.skip(whisker);
                continue;
            };
            if self.whiskers[slot].touch().and_then(Touch::steady_shaft).is_some() {
                self.refuted += 1;
                self.contours.skip(whisker);
                continue;
            }
            let deviation = perception.recorded_deviation(whisker);
            if self.cells.is_inside_free(tip, self.settings.cell + DEVIATIONS * deviation + position) {
                self.refuted += 1;
                self.contours.skip(whisker);
                continue;
            }
            let base = Point2::from(perception.whisker_vector(whisker, WhiskerVector::Base));
            if let Some([before, now]) = self.contours.record(whisker, tip, deviation, base) {
                let behind = -SURFACE * Vector2::new(f64::from(now.normal[0]), f64::from(now.normal[1]));
                if let Some(cell) = self.cells.grid.cell_at(tip) {
                    self.near.add(cell);
                }
                self.cells.block_convex([before.place, now.place, now.place + behind, before.place + behind]);
            }
        }
    }

    /// Makes the cells free that the body covers, in spite of these bounds of the error of its pose (m, rad).
    fn claim_body(&mut self, pose: Pose, position: f64, heading: f64) {
        let by = position + heading * clearance::reach(&self.outline_body);
        let Some(outline) = clearance::grown(&self.outline_body, -by) else { return };
        self.cells.free_convex(clearance::at_pose(&outline, pose));
    }

    /// Makes the cells free that straight shafts have swept, and follows the contacts of the others.
    fn follow_shafts(&mut self, perception: &Perception, position: f64, heading: f64) {
        // The shafts were straight here, and have been since.
        let settled = self.poses[self.waiting];
        let bounds = Bounds { base_angle: 0.0, position, heading, jump: self.jump };
        for whisker in &mut self.whiskers {
            whisker.follow(perception, &self.poses, self.waiting, &self.cells);
            if let Some(base_angle) = whisker.straight_below(self.waiting)
                && settled.is_finite()
            {
                let bounds = Bounds { base_angle, ..bounds };
                whisker.sweep.take(settled, &bounds, |quad| self.cells.free_quad(quad));
            }
        }
    }

    /// The whisker with this index in the policy.
    pub(super) fn whisker(&self, index: usize) -> Option<&MappedWhisker> {
        self.whiskers.iter().find(|whisker| whisker.index == index)
    }

    /// True if the body has moved in this tick by at least half of what a command says. A body that is merely faster than its servos
    /// should be also differs from what is expected.
    fn has_moved(&self, command: Command) -> bool {
        let [now, before] = [self.poses[0], self.poses[1]];
        if !before.is_finite() {
            return true;
        }
        let by_command = self.outline_body.iter().map(|corner| {
            let (arm, was) = (now.point_to_world(*corner), before.point_to_world(*corner));
            let asked = command.velocity_world + command.yaw_rate * perpendicular(now.vector_to_world(corner.coords));
            ((arm - was).dot(&asked), asked.norm_squared() * self.period)
        });
        // The corners together, because one of them may be the pivot.
        let (done, asked) = by_command.fold((0.0, 0.0), |sum, part| (sum.0 + part.0, sum.1 + part.1));
        done >= 0.5 * asked
    }

    /// Marks the strip ahead of a body at `pose` that does not move as commanded.
    fn block_ahead(&mut self, pose: Pose, command: Command) {
        let speed_of = |corner: &Point2| {
            let arm = pose.vector_to_world(corner.coords);
            (command.velocity_world + command.yaw_rate * perpendicular(arm)).norm()
        };
        let fastest = self.outline_body.iter().map(speed_of).fold(0.0, math::max);
        if fastest == 0.0 || !command.is_finite() {
            return;
        }
        let time = BLOCKED_AHEAD / fastest;
        let ahead = Pose {
            position: pose.position + time * command.velocity_world,
            heading: pose.heading + time * command.yaw_rate,
        };
        // The body covers its own place, so only the strip ahead is not free.
        self.cells.block_convex(clearance::at_pose(&self.outline_body, ahead));
    }
}
