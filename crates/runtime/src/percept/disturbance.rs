//! Detection of a blocked body.
//!
//! Why: docs/decisions/readings.md#a-blocked-body-is-detected-by-odometry.

use crate::geometry::{Point2, Pose, perpendicular, turn_between};
use crate::math;
use crate::rig::Rig;
use crate::signal::{Command, MAX_WHISKERS, Sample};

use super::platform_motion::Motion;

/// Time constant (s) of the averages of commanded and actual motions.
const AVERAGED: f64 = 0.2;
/// Share of the commanded speed whose lack means that the body is blocked, beyond the effects of whiskers and
/// [`NOISE`].
const SHARE: f64 = 0.5;
/// Speed difference (m/s) that errors of measured poses explain.
const NOISE: f64 = 2e-3;
/// Contact position, as a share of the whisker's length, for the force that a base angle implies. The force is three
/// times as large as with a tip contact.
const TOUCHED_AT: f64 = 1.0 / 3.0;

/// Compares the measured poses of the body with the expected motion of its servos.
///
/// A servo with the time constant `T` (s) follows a command `u` by `T v' = u - v`. A difference between expected and
/// actual motion is a disturbance: a force `F` reduces the speed by `F T / m`. The forces of the whiskers follow from
/// their base angles, up to a factor.
#[derive(Debug, Clone)]
pub(super) struct Disturbance {
    /// Corners of the body (m, body frame).
    corners_body: [Point2; 4],
    /// Time constants of the servos (s).
    servos: Motion,
    /// Speed (m/s) of the body's fastest corner by which each whisker may push the body, per base angle of 1 rad.
    pushes: [f64; MAX_WHISKERS],
    /// Newest base angle of each whisker (rad).
    base_angles: [f64; MAX_WHISKERS],
    /// The current command.
    command: Command,
    /// Expected speed of the servos.
    speed: Motion,
    /// Time of the last tick (s).
    time: f64,
    /// Last known pose.
    pose: Pose,
    /// Expected motion since the last known pose, and its duration (s).
    expected: Motion,
    elapsed: f64,
    /// Averages: missing speed, commanded speed of the fastest corner (m/s), speed explained by whiskers (m/s).
    missing: Motion,
    asked: f64,
    pushed: f64,
}

impl Disturbance {
    /// Creates the detection for the body of `rig`.
    pub(super) fn new(rig: &Rig) -> Self {
        let platform = &rig.platform;
        let servos = platform.servos();
        let corners_body = platform.outline_body();
        let reach = corners_body.iter().map(|corner| corner.coords.norm()).fold(0.0, math::max);
        let mut pushes = [0.0; MAX_WHISKERS];
        for (push, whisker) in pushes.iter_mut().zip(&rig.whiskers) {
            let (whisker, arm) = (whisker.perceived(), whisker.base_body.coords.norm() + whisker.shaft.length);
            let force = whisker.hinge.stiffness / (TOUCHED_AT * whisker.shaft.length);
            *push = force * servos.x * (1.0 / platform.mass + servos.z / servos.x * reach * arm / platform.inertia);
        }
        Self {
            corners_body,
            servos,
            pushes,
            base_angles: [0.0; MAX_WHISKERS],
            command: Command::STOP,
            speed: Motion::default(),
            time: 0.0,
            pose: Pose::UNKNOWN,
            expected: Motion::default(),
            elapsed: 0.0,
            missing: Motion::default(),
            asked: 0.0,
            pushed: 0.0,
        }
    }

    /// Sets the command that holds until the next tick.
    pub(super) fn command(&mut self, command: Command) {
        self.command = command;
    }

    /// Adds the samples of a tick that ends at `time` (s) with the body at `pose`, which may be unknown. `measured` is the
    /// expected motion in this tick, if the platform is known to move differently from what the rig states.
    pub(super) fn update(&mut self, samples: &[Sample], time: f64, pose: Pose, measured: Option<Motion>) {
        for sample in samples {
            for (base_angle, reading) in self.base_angles.iter_mut().zip(&sample.whiskers) {
                if reading.base_angle.is_finite() {
                    *base_angle = reading.base_angle;
                }
            }
        }
        let period = time - std::mem::replace(&mut self.time, time);
        if period > 0.0 {
            let stated = self.expect(period);
            self.expected += measured.unwrap_or(stated);
            self.elapsed += period;
        }
        if pose.is_finite() {
            let before = std::mem::replace(&mut self.pose, pose);
            if before.is_finite() && self.elapsed > 0.0 {
                self.compare(before, pose);
            }
            (self.expected, self.elapsed) = (Motion::default(), 0.0);
        }
    }

    /// The expected motion of a servo during `period` (s).
    fn expect(&mut self, period: f64) -> Motion {
        let aim = self.command.velocity_world.push(self.command.yaw_rate);
        let left = self.servos.map(|servo| math::exp(-period / servo));
        let gone = left.map(|left| 1.0 - left);
        // Equivalent time at the initial difference from the target speed.
        let behind = self.servos.component_mul(&gone);
        let motion = self.speed.component_mul(&behind) + aim.component_mul(&behind.map(|behind| period - behind));
        self.speed = self.speed.component_mul(&left) + aim.component_mul(&gone);
        motion
    }

    /// Averages the missing part of the expected motion.
    fn compare(&mut self, before: Pose, pose: Pose) {
        let mut missing = self.expected - (pose.position - before.position).push(pose.heading - before.heading);
        // Measured headings may be wrapped to one rotation.
        missing.z = turn_between(0.0, missing.z);
        let asked = self.fastest(self.expected) / self.elapsed;
        let weighted = self.base_angles.iter().zip(&self.pushes);
        let pushed: f64 = weighted.map(|(base_angle, push)| base_angle.abs() * push).sum();
        let left = math::exp(-self.elapsed / AVERAGED);
        self.missing = self.missing * left + missing * ((1.0 - left) / self.elapsed);
        self.asked = self.asked * left + asked * (1.0 - left);
        self.pushed = self.pushed * left + pushed * (1.0 - left);
    }

    /// Largest motion (m) of a corner of the body.
    fn fastest(&self, motion: Motion) -> f64 {
        let of_corner = |corner: &Point2| {
            let arm = self.pose.vector_to_world(corner.coords);
            (motion.xy() + motion.z * perpendicular(arm)).norm()
        };
        self.corners_body.iter().map(of_corner).fold(0.0, math::max)
    }

    /// Averaged speed difference (m/s) at the corner of the body with the largest one. 0 before two poses are known.
    pub(super) fn shortfall(&self) -> f64 {
        if self.pose.is_finite() { self.fastest(self.missing) } else { 0.0 }
    }

    /// True if something other than the whiskers prevents the body from following its commands.
    pub(super) fn is_blocked(&self) -> bool {
        self.shortfall() > SHARE * self.asked + self.pushed + NOISE
    }
}
