//! The platform's body among the solids.

use crate::geometry::{BoundingBox, Point2, Pose, Vector2, perpendicular};
use vibrissa_runtime::rig::Platform;

use super::carriage::Twist;
use super::surface::{Joint, Surfaces};

/// The platform's body: what keeps it out of solids.
#[derive(Debug)]
pub(super) struct Hull {
    outline_body: [Point2; 4],
    mass: f64,
    inertia: f64,
    /// Every point of the body is at least this far (m) from all solids.
    clear: f64,
    /// Distance (m) of the farthest point of the body from its centre of mass.
    reach: f64,
    stops: Vec<Stop>,
}

/// A place at which the body may touch.
#[derive(Debug, Clone, Copy)]
struct Stop {
    /// From the centre of mass to the place (m, world frame).
    arm: Vector2,
    /// Away from what is there, a unit vector.
    normal: Vector2,
    /// Distance (m).
    gap: f64,
    /// What it gives to the body while that gives way: mass times way, or momentum.
    impulse: f64,
}

/// How far (m) from the body solids are looked for.
const LOOKED_FOR: f64 = 20e-3;
/// What is deeper in the body or in a solid than this (m) belongs to another side of it.
const SKIN: f64 = 2e-4;
/// Rounds in which stops take turns.
const ROUNDS: usize = 60;

impl Hull {
    pub(super) fn new(platform: &Platform) -> Self {
        let outline_body = platform.outline_body();
        Self {
            outline_body,
            mass: platform.mass,
            inertia: platform.inertia,
            clear: 0.0,
            reach: outline_body.iter().map(|corner| corner.coords.norm()).fold(0.0, f64::max),
            stops: Vec::new(),
        }
    }

    /// Keeps a body at `pose` that is to move by `motion`, at a speed of `speed` afterwards, out of the solids: takes from both what
    /// would lead into one. The speed (m/s) with which it runs into something, if it touches at all.
    pub(super) fn stop(
        &mut self,
        pose: Pose,
        motion: &mut Twist,
        speed: &mut Twist,
        surfaces: &Surfaces,
    ) -> Option<f64> {
        let way = motion.along.norm() + self.reach * motion.turn.abs();
        if self.clear > way {
            self.clear -= way;
            return None;
        }
        self.clear = self.survey(pose, surfaces) - way;
        let mut impact: Option<f64> = None;
        for stop in &self.stops {
            if stop.gap + stop.normal.dot(&motion.at(stop.arm)) < 0.0 {
                let into = -stop.normal.dot(&speed.at(stop.arm));
                impact = Some(impact.unwrap_or(0.0).max(into));
            }
        }
        if impact.is_some() {
            self.give_way(motion, |stop| stop.gap);
            self.give_way(speed, |stop| if stop.gap < SKIN { 0.0 } else { f64::INFINITY });
        }
        impact
    }

    /// Changes a motion so that it leads no farther towards any stop than there is room, as impulses would: stop by stop, each as
    /// strong as it has to be beside the others.
    fn give_way(&mut self, twist: &mut Twist, room: impl Fn(&Stop) -> f64) {
        for stop in &mut self.stops {
            stop.impulse = 0.0;
        }
        for _ in 0..ROUNDS {
            for stop in &mut self.stops {
                let lever = stop.arm.perp(&stop.normal);
                let missing = -(room(stop) + stop.normal.dot(&twist.at(stop.arm)));
                let wanted = stop.impulse + missing / (1.0 / self.mass + lever * lever / self.inertia);
                let change = wanted.max(0.0) - stop.impulse;
                stop.impulse += change;
                twist.along += change / self.mass * stop.normal;
                twist.turn += change / self.inertia * lever;
            }
        }
    }

    /// Finds all stops near a pose; no solid is nearer (m) than is returned.
    fn survey(&mut self, pose: Pose, surfaces: &Surfaces) -> f64 {
        self.stops.clear();
        let mut clear = LOOKED_FOR;
        let corners = self.outline_body.map(|corner| pose.point_to_world(corner));
        let bounds = corners
            .iter()
            .map(|&corner| BoundingBox::around(corner, corner))
            .reduce(|bounds, corner| bounds.union(&corner))
            .unwrap_or(BoundingBox::around(pose.position, pose.position));
        let sides = [0, 1, 2, 3].map(|side| Side::between(corners[side], corners[(side + 1) % 4]));
        let mut add = |place: Point2, normal: Vector2, gap: f64| {
            if gap > -SKIN && gap < LOOKED_FOR {
                clear = clear.min(gap);
                self.stops.push(Stop { arm: place - pose.position, normal, gap, impulse: 0.0 });
            }
        };
        let mut nearest_corners = LOOKED_FOR;
        for (_, facet) in surfaces.near(bounds, LOOKED_FOR) {
            for corner in corners {
                if let Some(foot) = facet.foot(corner) {
                    add(corner, foot.normal, foot.height);
                }
            }
            if let Joint::Convex(solids_corner) = facet.joint {
                for side in &sides {
                    if let Some(height) = side.height(solids_corner.point) {
                        add(solids_corner.point, -side.outwards, height);
                    }
                }
                let distances = corners.iter().map(|corner| (corner - solids_corner.point).norm());
                nearest_corners = distances.fold(nearest_corners, f64::min);
            }
            if let Some((centre, radius)) = facet.bulge() {
                for side in sides.iter().filter(|side| facet.spans(-side.outwards)) {
                    if let Some(height) = side.height(centre) {
                        add(centre - radius * side.outwards, -side.outwards, height - radius);
                    }
                }
            }
        }
        clear.min(nearest_corners).max(0.0)
    }
}

/// A side of the body.
struct Side {
    start: Point2,
    along: Vector2,
    length: f64,
    outwards: Vector2,
}

impl Side {
    fn between(start: Point2, end: Point2) -> Self {
        let length = (end - start).norm();
        let along = (end - start) / length;
        Self { start, along, length, outwards: -perpendicular(along) }
    }

    /// How far a point beside it is outside (m).
    fn height(&self, point: Point2) -> Option<f64> {
        let from_start = point - self.start;
        let along = from_start.dot(&self.along);
        (along > 0.0 && along < self.length).then(|| from_start.dot(&self.outwards))
    }
}
