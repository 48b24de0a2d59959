//! The motion along a route.

use crate::geometry::{Pose, Vector2, turn_between};
use crate::math;

use super::clearance::Ground;
use super::route::RouteStep;
use super::route_search::Pace;

/// The commanded motion of the body along a route.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RouteMotion {
    /// Direction of motion (unit vector, world frame), or zero at a standstill.
    pub direction_world: Vector2,
    /// Speed (m/s).
    pub speed: f64,
    /// Yaw rate (rad/s, counter-clockwise positive).
    pub yaw_rate: f64,
}

impl RouteMotion {
    /// The body stands still.
    pub(super) const NONE: Self = Self { direction_world: Vector2::new(0.0, 0.0), speed: 0.0, yaw_rate: 0.0 };
}

/// Offsets (m, rad) from a step at which it is reached. A cell's diagonal of margin bounds the first.
pub(super) const NEAR: f64 = 2.5e-3;
pub(super) const NEAR_HEADING: f64 = 0.05;
/// Rates (Hz) at which offsets from the next step decrease. The servos follow commands several times faster.
const APPROACH: f64 = 3.0;
/// Least speed (m/s) and yaw rate (rad/s) before a step, so that it is reached.
const LEAST: (f64, f64) = (5e-3, 0.05);
/// Steps over which the body looks ahead for the next change of direction.
const AHEAD: usize = 8;
/// Cosine of the largest change of direction that counts as straight on.
const STRAIGHT: f64 = 0.999;
/// Distance (m) from the path to the next step at which the body has left the route. It is one stride of the search.
pub(super) const LEFT: f64 = 24e-3;

/// The motion of the body along the steps of a route.
#[derive(Debug, Clone, Copy)]
pub(super) struct Follower {
    /// Index of the next step.
    next: usize,
    /// Pose from which the body goes to it.
    from: Pose,
    pub(super) motion: RouteMotion,
    pub(super) is_done: bool,
}

impl Follower {
    /// At the begin of a route.
    pub(super) const fn new(from: Pose) -> Self {
        Self { next: 0, from, motion: RouteMotion::NONE, is_done: false }
    }

    /// Continues with the body at a pose. Returns false if it has left the route.
    pub(super) fn update(&mut self, steps: &[RouteStep], pace: &Pace, body: Pose) -> bool {
        self.motion = RouteMotion::NONE;
        while let Some(step) = steps.get(self.next) {
            let is_last = self.next + 1 == steps.len();
            let offset = step.pose.position - body.position;
            let way = step.pose.position - self.from.position;
            // A body that has passed a step by less than a tick's motion does not turn back.
            let is_past = !is_last && way.norm() > NEAR && offset.dot(&way) <= 0.0 && offset.norm() < 4.0 * NEAR;
            let is_turned = turn_between(body.heading, step.pose.heading).abs() < NEAR_HEADING;
            if !is_turned || !(offset.norm() < NEAR || is_past) {
                break;
            }
            self.from = step.pose;
            self.next += 1;
        }
        self.is_done = self.next >= steps.len();
        let Some(step) = steps.get(self.next) else {
            return steps.last().is_none_or(|goal| (goal.pose.position - body.position).norm() < LEFT);
        };
        let offset = step.pose.position - body.position;
        let way = (step.pose.position - self.from.position).try_normalize(0.0).unwrap_or_default();
        if (offset - way * offset.dot(&way)).norm() > LEFT {
            return false;
        }
        let (speed, yaw_rate) = match step.ground {
            Ground::Proved => pace.proved,
            // The body leaves and reaches surfaces also where no route leads along them.
            Ground::NearSurface if pace.near_surface.0 > 0.0 => pace.near_surface,
            Ground::Unknown | Ground::NearSurface | Ground::Blocked => pace.unknown,
        };
        let turn = turn_between(body.heading, step.pose.heading);
        let left = offset.norm() + self.straight_behind(steps, offset);
        self.motion = RouteMotion {
            direction_world: offset.try_normalize(0.0).unwrap_or_default(),
            speed: math::min(speed, math::max(APPROACH * left, if offset.norm() > NEAR { LEAST.0 } else { 0.0 })),
            yaw_rate: if turn.abs() < 0.5 * NEAR_HEADING {
                APPROACH * turn
            } else {
                turn.signum() * math::min(yaw_rate, math::max(APPROACH * turn.abs(), LEAST.1))
            },
        };
        true
    }

    /// Length (m) behind the next step over which the route goes straight on without a rotation.
    fn straight_behind(&self, steps: &[RouteStep], offset: Vector2) -> f64 {
        let mut length = 0.0;
        let mut direction = offset.try_normalize(0.0).unwrap_or_default();
        for pair in steps.get(self.next..).unwrap_or_default().windows(2).take(AHEAD) {
            let [step, after] = pair else { break };
            let way = after.pose.position - step.pose.position;
            let next = way.try_normalize(0.0).unwrap_or_default();
            let turn = turn_between(step.pose.heading, after.pose.heading).abs();
            if next.dot(&direction) < if length == 0.0 { 0.9 } else { STRAIGHT }
                || turn > NEAR_HEADING
                || after.ground > step.ground
            {
                break;
            }
            length += way.norm();
            direction = next;
        }
        length
    }
}
