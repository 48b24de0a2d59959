//! What to touch next.

use crate::geometry::{Point2, Pose, Vector2, perpendicular, turn_between};
use crate::math;
use crate::percept::SURE_AFTER;
use crate::rig::{Platform, Whisker};

use super::cells::Cells;
use super::clearance::{Ground, NearSurfaces};
use super::contour_ends::{CONTINUES, ContourEnd, ContourEnds, EndKind, piece_of};
use super::contours::Contours;
use super::frontier::Frontier;
use super::grid::Grid;
use super::lattice::Lattice;
use super::route_follow::{LEFT, NEAR, NEAR_HEADING};
use super::route_search::Pace;

/// Why a place should be touched, the most urgent first. A value by area over time alone would leave an object for empty ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum TargetKind {
    /// An open end of a contour.
    OpenEnd,
    /// A gap between two parts of contours.
    Gap,
    /// A shaft has touched there, and no tip has followed the surface.
    Untraced,
    /// Unknown ground beside free ground.
    Frontier,
}

/// A place that should be touched or looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Target {
    /// Why.
    pub kind: TargetKind,
    /// The place (m, world frame).
    pub place: Point2,
    /// Unit vector (world frame) from the place to free ground.
    pub normal: Vector2,
    /// Index in the policy of the whisker that can do it.
    pub whisker: usize,
    /// The pose of the body from which it begins. The straight tip is then before the place.
    pub pose: Pose,
    /// Newly seen area over time (m²/s).
    pub value: f64,
    /// Number of the end of a contour.
    end: Option<usize>,
}

/// Distance (m) of a straight tip before a surface from which a touch begins.
const BEFORE: f64 = 8e-3;
/// Path (m) before an end of a contour at which it is touched. The contact is then sure before the tip comes to the end.
const OVERLAP: f64 = SURE_AFTER + CONTINUES;
/// Path (m) by which an end may grow and still be the same target.
const SAME_END: f64 = 12e-3;
/// Distance (m) of the nose before unknown ground that the body will drive into, and by which a tip enters unknown ground.
const BEFORE_UNKNOWN: f64 = 30e-3;
const BEYOND: f64 = 10e-3;
/// Time (s) that any target takes besides the path.
const BASE_TIME: f64 = 2.0;
/// Factor by which the value of another target of the same kind must be larger.
const BETTER: f64 = 1.5;
/// Attempts after which an end is closed.
const FAILURES: u8 = 3;
/// Cosine of the largest angle between the normals of the same end at two times.
const SAME_NORMAL: f64 = 0.5;
/// Most positions whose attempts are remembered. The oldest is forgotten.
const MOST_ATTEMPTS: usize = 256;
/// Most blocks of the frontier whose poses are tried in a tick, also with a guarded nose, where a block has one pose. Then the headings for
/// each whisker.
const TRIED: usize = 1;
const TRIED_AHEAD: usize = 4;
const HEADINGS: usize = 8;
/// Positions where shafts have touched that are remembered, and their least distance (m).
const PLACES: usize = 64;
const APART: f64 = 10e-3;

/// A whisker that targets are for.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    index: usize,
    side: f64,
    /// True if the tip is farther to the side than the body, so that the whisker can follow a surface beside it.
    is_beside: bool,
    /// Straight tip (m, body frame), mounting direction and the usual direction of a surface's normal (rad).
    tip_body: Vector2,
    direction_body: f64,
    usual_normal: f64,
}

/// The target that the body goes to. The one that should be touched next may be another one meanwhile.
#[derive(Debug, Clone, Copy)]
struct Pursued {
    target: Target,
    /// True if the body has come to its pose and not left since. The attempt is then counted.
    is_counted: bool,
}

/// Attempts at a place of a surface.
#[derive(Debug, Clone, Copy)]
struct Attempts {
    place: Point2,
    normal: Vector2,
    count: u8,
}

impl Attempts {
    fn are_of(&self, target: &Target) -> bool {
        (self.place - target.place).norm() < SAME_END && self.normal.dot(&target.normal) > SAME_NORMAL
    }
}

/// The choice of targets.
#[derive(Debug, Clone)]
pub(super) struct Targets {
    whiskers: Vec<Candidate>,
    /// Distance (m) of the nose ahead of the centre of mass.
    nose: f64,
    pace: Pace,
    /// Blocks within which a touch sees something new.
    reach: i32,
    block: f64,
    /// Attempts at ends of contours.
    attempts: Vec<Attempts>,
    /// Positions and normals where shafts have touched.
    touched: Vec<(Point2, Vector2)>,
    /// The best of this pass so far, and the target.
    best: Option<Target>,
    current: Option<Target>,
    /// True if the last whole pass found nothing.
    is_empty: bool,
    /// True if a target has failed in this pass.
    is_disturbed: bool,
    pursued: Option<Pursued>,
    next_end: usize,
}

/// Ends that are valued in a tick.
const ENDS: usize = 16;

/// What targets depend on.
#[derive(Clone, Copy)]
pub(super) struct Known<'m> {
    pub(super) cells: &'m Cells,
    pub(super) near: &'m NearSurfaces,
    pub(super) lattice: &'m Lattice,
    pub(super) contours: &'m Contours,
    pub(super) ends: &'m ContourEnds,
    pub(super) body: Pose,
}

impl Targets {
    /// Creates the choice for whiskers with their indices in the policy.
    pub(super) fn new<'w>(
        whiskers: impl Iterator<Item = (usize, &'w Whisker)>,
        platform: &Platform,
        pace: Pace,
        block: f64,
    ) -> Self {
        let mut longest = 0.0;
        let whiskers = whiskers.map(|(index, whisker)| {
            longest = math::max(longest, whisker.shaft.length);
            let base = whisker.base_pose();
            Candidate {
                index,
                side: whisker.side(),
                is_beside: base.point_to_world(Point2::new(whisker.shaft.length, 0.0)).y.abs()
                    > 0.5 * math::max(platform.tail_width, platform.nose_width),
                tip_body: base.point_to_world(Point2::new(whisker.shaft.length, 0.0)).coords,
                direction_body: whisker.direction_body,
                usual_normal: whisker.usual_normal(),
            }
        });
        let whiskers = whiskers.collect();
        #[expect(clippy::cast_possible_truncation, reason = "a small count")]
        let reach = (0.5 * longest / block).ceil().clamp(1.0, 8.0) as i32;
        Self {
            whiskers,
            nose: platform.length - platform.centre_of_mass,
            pace,
            reach,
            block,
            attempts: Vec::with_capacity(MOST_ATTEMPTS),
            touched: Vec::with_capacity(PLACES),
            best: None,
            current: None,
            is_empty: false,
            is_disturbed: false,
            pursued: None,
            next_end: 0,
        }
    }

    /// The target.
    pub(super) fn current(&self) -> Option<&Target> {
        self.current.as_ref()
    }

    /// True if the last whole pass found no target.
    pub(super) fn is_complete(&self) -> bool {
        self.is_empty && self.current.is_none()
    }

    /// Remembers a position where something was felt.
    pub(super) fn touch(&mut self, place: Point2, normal: Vector2, frontier: &Frontier, grid: Grid) {
        let is_known = self.touched.iter().any(|(known, _)| (known - place).norm() < APART);
        let is_closed = Frontier::block_at(grid, place).is_none_or(|(column, row)| frontier.is_closed(column, row));
        if !is_known && !is_closed && self.touched.len() < PLACES {
            self.touched.push((place, normal));
        }
    }

    /// Remembers the target that the body goes to, if the goal is the pose of one.
    pub(super) fn pursue(&mut self, goal: Pose) {
        if self.pursued.is_none_or(|pursued| pursued.target.pose != goal) {
            let target = self.current.filter(|target| target.pose == goal);
            self.pursued = target.map(|target| Pursued { target, is_counted: false });
        }
    }

    /// Gives up the target that the body went to, or else the current one, which is an attempt. After three it is closed.
    pub(super) fn fail(&mut self, frontier: &mut Frontier, grid: Grid) {
        let pursued = self.pursued.take();
        let Some(target) = pursued.map(|pursued| pursued.target).or(self.current) else { return };
        let is_other = |other: &Target| other.end != target.end || other.place != target.place;
        self.current = self.current.filter(is_other);
        // This pass may have found it again, or may have passed over others because of it.
        self.best = self.best.filter(is_other);
        self.is_disturbed = true;
        if pursued.is_none_or(|pursued| !pursued.is_counted) {
            self.count_attempt(&target, frontier, grid);
        }
        if target.end.is_none() {
            self.touched.retain(|(place, _)| (place - target.place).norm() > APART);
        }
    }

    /// Counts an attempt when the body comes to the pose of an end that it goes to. A target that is still one afterwards, and is
    /// chosen again and again, shows nothing new.
    fn arrive(&mut self, body: Pose, frontier: &mut Frontier, grid: Grid) {
        // At unknown ground, the body goes on from the pose and sees more.
        let at_end = self.pursued.filter(|pursued| pursued.target.end.is_some());
        let Some(Pursued { target, is_counted }) = at_end else { return };
        let distance = (target.pose.position - body.position).norm();
        if is_counted && distance > LEFT {
            self.pursued = Some(Pursued { target, is_counted: false });
        } else if !is_counted && distance < NEAR && turn_between(body.heading, target.pose.heading).abs() < NEAR_HEADING
        {
            self.pursued = Some(Pursued { target, is_counted: true });
            self.count_attempt(&target, frontier, grid);
        }
    }

    fn count_attempt(&mut self, target: &Target, frontier: &mut Frontier, grid: Grid) {
        if target.end.is_none() {
            if let Some(block) = Frontier::block_at(grid, target.place) {
                frontier.fail(block);
            }
        } else if let Some(known) = self.attempts.iter_mut().find(|attempts| attempts.are_of(target)) {
            known.count = known.count.saturating_add(1);
        } else {
            if self.attempts.len() == MOST_ATTEMPTS {
                self.attempts.remove(0);
            }
            self.attempts.push(Attempts { place: target.place, normal: target.normal, count: 1 });
        }
    }

    /// Continues the pass through all possible targets.
    pub(super) fn update(&mut self, known: Known<'_>, frontier: &mut Frontier) {
        self.arrive(known.body, frontier, known.cells.grid);
        self.value_ends(known, frontier);
        let most = if self.pace.has_guarded_nose { TRIED_AHEAD } else { TRIED };
        let mut tried = 0;
        let mut best = self.best.take();
        let is_end = frontier.update(known.cells, |frontier, block| {
            let place = Frontier::centre(known.cells.grid, block);
            let seen = f64::from(frontier.unknown_around(block, self.reach)) * math::square(self.block);
            let way = (place - known.body.position).norm() / self.pace.proved.0 + self.outwards(known, place);
            let value = seen / (BASE_TIME + way);
            let is_better = best.is_none_or(|best: Target| best.kind == TargetKind::Frontier && value > best.value);
            if is_better && tried < most {
                tried += 1;
                if let Some(target) = self.looking(known, frontier, block, seen) {
                    best = Some(better(best, target));
                }
            }
        });
        self.best = best;
        if is_end {
            self.value_touched(known, frontier);
            let best = self.best.take();
            self.is_empty = best.is_none() && !std::mem::take(&mut self.is_disturbed);
            self.choose(best, known, frontier);
        }
    }

    /// Takes the best target of a pass, unless the current one is still about as good.
    fn choose(&mut self, best: Option<Target>, known: Known<'_>, frontier: &Frontier) {
        let kept = self.current.filter(|current| self.is_valid(current, known, frontier));
        // The body has moved since the target was valued.
        let kept = kept.and_then(|kept| {
            let seen = self.seen(frontier, known.cells.grid, kept.place);
            self.rated(known, Target { value: seen, ..kept })
        });
        self.current = match (kept, best) {
            (Some(kept), Some(best)) if best.kind < kept.kind => Some(best),
            (Some(kept), Some(best)) if best.kind == kept.kind && best.value > BETTER * kept.value => Some(best),
            (Some(kept), _) => Some(kept),
            (None, best) => best,
        };
    }

    /// True if a target is still one.
    fn is_valid(&self, target: &Target, known: Known<'_>, frontier: &Frontier) -> bool {
        if known.lattice.ground_between(known.cells, known.near, target.pose, target.pose) == Ground::Blocked {
            return false;
        }
        match (target.kind, target.end) {
            (TargetKind::Frontier, _) => Frontier::block_at(known.cells.grid, target.place)
                .is_some_and(|(column, row)| frontier.is_frontier(column, row)),
            (TargetKind::Untraced, _) => self.touched.iter().any(|(place, _)| (place - target.place).norm() < APART),
            (_, Some(end)) => {
                known.ends.ends(known.contours).any(|(number, found)| {
                    number == end && found.kind != EndKind::Joined && (found.place - target.place).norm() < SAME_END
                }) && self.is_open(target)
            }
            (_, None) => false,
        }
    }

    /// True if the place of an end was not tried too often.
    fn is_open(&self, target: &Target) -> bool {
        !self.attempts.iter().any(|attempts| attempts.count >= FAILURES && attempts.are_of(target))
    }

    /// Values some ends of contours.
    fn value_ends(&mut self, known: Known<'_>, frontier: &Frontier) {
        let (mut count, mut best) = (0, self.best.take());
        for (number, end) in known.ends.ends(known.contours).skip(self.next_end).take(ENDS) {
            count += 1;
            if end.kind != EndKind::Joined
                && let Some(target) = self.following(known, frontier, number, &end)
                && self.is_open(&target)
            {
                best = Some(better(best, target));
            }
        }
        self.next_end = if count < ENDS { 0 } else { self.next_end + count };
        self.best = best;
    }

    /// Values the positions where shafts have touched, and forgets those that a contour has reached or that are closed.
    fn value_touched(&mut self, known: Known<'_>, frontier: &Frontier) {
        self.touched.retain(|(place, _)| {
            let is_closed = Frontier::block_at(known.cells.grid, *place)
                .is_none_or(|(column, row)| frontier.is_closed(column, row));
            !is_closed && !known.contours.points().iter().any(|point| (point.place - place).norm() < APART)
        });
        for index in 0..self.touched.len() {
            let (place, normal) = self.touched[index];
            let target = self.whiskers.iter().filter(|whisker| whisker.is_beside).filter_map(|whisker| {
                self.touching(known, frontier, whisker, TargetKind::Untraced, (place, normal), place)
            });
            self.best = target.fold(self.best, |best, target| Some(better(best, target)));
        }
    }

    /// A target that follows a contour beyond its end.
    fn following(&self, known: Known<'_>, frontier: &Frontier, number: usize, end: &ContourEnd) -> Option<Target> {
        let kind = if end.kind == EndKind::Open { TargetKind::OpenEnd } else { TargetKind::Gap };
        // The body goes along the contour with the surface on one side.
        let side = -perpendicular(end.outwards).dot(&end.normal).signum();
        let (piece, at) = piece_of(number);
        let known_point = known.contours.before(piece, at, OVERLAP)?;
        let normal = Vector2::new(f64::from(known_point.normal[0]), f64::from(known_point.normal[1]));
        let whiskers = self.whiskers.iter().filter(|whisker| whisker.is_beside && whisker.side * side > 0.0);
        let target = whiskers
            .filter_map(|whisker| self.touching(known, frontier, whisker, kind, (end.place, normal), known_point.place))
            .max_by(|a, b| a.value.total_cmp(&b.value))?;
        Some(Target { end: Some(number), ..target })
    }

    /// A target whose whisker touches the surface at `touched` in its usual posture.
    fn touching(
        &self,
        known: Known<'_>,
        frontier: &Frontier,
        whisker: &Candidate,
        kind: TargetKind,
        (place, normal): (Point2, Vector2),
        touched: Point2,
    ) -> Option<Target> {
        let heading = math::atan2(normal.y, normal.x) - whisker.direction_body - whisker.side * whisker.usual_normal;
        let tip = touched + BEFORE * normal;
        let pose = with_tip(whisker, tip, heading);
        let seen = self.seen(frontier, known.cells.grid, place);
        self.rated(known, Target { kind, place, normal, whisker: whisker.index, pose, value: seen, end: None })
    }

    /// Unknown area (m²) that a whisker at a place would see, at least that of a block.
    fn seen(&self, frontier: &Frontier, grid: Grid, place: Point2) -> f64 {
        let blocks = Frontier::block_at(grid, place).map_or(0, |block| frontier.unknown_around(block, self.reach));
        math::max(f64::from(blocks), 1.0) * math::square(self.block)
    }

    /// A target that looks at a block of the frontier.
    fn looking(&self, known: Known<'_>, frontier: &Frontier, block: (i32, i32), seen: f64) -> Option<Target> {
        use super::frontier::Block;
        let place = Frontier::centre(known.cells.grid, block);
        // Towards the free blocks beside it.
        let free = [(1, 0), (-1, 0), (0, 1), (0, -1)]
            .into_iter()
            .filter(|(x, y)| frontier.get(block.0 + x, block.1 + y) == Block::Free);
        let normal = free.map(|(x, y)| Vector2::new(f64::from(x), f64::from(y))).sum::<Vector2>();
        let normal = normal.try_normalize(0.5).unwrap_or_else(|| Vector2::new(1.0, 0.0));
        let target =
            |whisker, pose| Target { kind: TargetKind::Frontier, place, normal, whisker, pose, value: seen, end: None };
        // With whiskers before its nose, the body drives into the unknown ground.
        if self.pace.has_guarded_nose {
            let pose = Pose {
                position: place + (self.nose + BEFORE_UNKNOWN) * normal,
                heading: math::atan2(-normal.y, -normal.x),
            };
            return self.rated(known, target(self.whiskers.first()?.index, pose));
        }
        // Without them, a whisker enters it.
        let tip = place - BEYOND * normal;
        let poses = self.whiskers.iter().flat_map(|whisker| {
            (0..HEADINGS).map(move |index| {
                let heading = std::f64::consts::TAU * index as f64 / HEADINGS as f64;
                (whisker.index, with_tip(whisker, tip, heading))
            })
        });
        poses
            .filter_map(|(whisker, pose)| self.rated(known, target(whisker, pose)))
            .max_by(|a, b| a.value.total_cmp(&b.value))
    }

    /// Time (s) by which a body with a guarded nose puts off a look far from the start, so that the known ground grows compactly. Ground
    /// that is left behind has to be looked at later, through the unknown ground between.
    fn outwards(&self, known: Known<'_>, place: Point2) -> f64 {
        let out = (place - known.cells.grid.middle()).norm() / self.pace.unknown.0;
        if self.pace.has_guarded_nose { out } else { 0.0 }
    }

    /// A target whose value is its newly seen area, with that over the time. `None` if its pose is blocked, or in ground near
    /// surfaces that the pace forbids for a look.
    fn rated(&self, known: Known<'_>, target: Target) -> Option<Target> {
        let ground = known.lattice.ground_between(known.cells, known.near, target.pose, target.pose);
        let is_allowed = match ground {
            Ground::Proved | Ground::Unknown => true,
            Ground::NearSurface => target.kind != TargetKind::Frontier || self.pace.near_surface.0 > 0.0,
            Ground::Blocked => false,
        };
        let way = (target.pose.position - known.body.position).norm() / self.pace.proved.0;
        let turn = turn_between(known.body.heading, target.pose.heading).abs() / self.pace.proved.1;
        let out = if target.kind == TargetKind::Frontier { self.outwards(known, target.place) } else { 0.0 };
        is_allowed.then_some(Target { value: target.value / (BASE_TIME + way + turn + out), ..target })
    }
}

/// The pose of the body with a heading (rad) whose straight whisker has its tip at a place (m, world frame).
fn with_tip(whisker: &Candidate, tip: Point2, heading: f64) -> Pose {
    let pose = Pose { position: tip, heading };
    Pose { position: tip - pose.vector_to_world(whisker.tip_body), heading }
}

/// The better of two targets.
fn better(best: Option<Target>, other: Target) -> Target {
    best.filter(|best| (best.kind, -best.value) <= (other.kind, -other.value)).unwrap_or(other)
}
