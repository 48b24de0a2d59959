//! The base angle of a whisker in free air, due to its inertia.

use crate::geometry::{Pose, Vector2, perpendicular, rotate, turn_between, unit};
use crate::math;
use crate::rig::{Rig, Whisker};

use super::platform_motion::Motion;

/// The base angle of an undeflected whisker on a platform that accelerates or rotates.
#[derive(Debug, Clone, Copy)]
pub(super) struct Inertia {
    /// First and second moment of the mass about the base, over the stiffness of the hinge (s²/m, s²).
    first: f64,
    second: f64,
    /// Position of the base along the shaft and to its left (m), from the centre of mass of the platform.
    base: Vector2,
    /// Direction of the undeflected shaft (rad, body frame).
    direction_body: f64,
}

/// Number of pieces of a shaft whose masses are added.
const PIECES: usize = 100;

impl Inertia {
    /// Creates the inertia of `whisker`.
    pub(super) fn new(whisker: &Whisker) -> Self {
        let whisker = whisker.vibrating();
        let shaft = &whisker.shaft;
        let (mut first, mut second) = (0.0, 0.0);
        for piece in 0..PIECES {
            let share = (piece as f64 + 0.5) / PIECES as f64;
            let (along, radius) = (share * shaft.length, shaft.radius_at(share));
            let mass = shaft.density * std::f64::consts::PI * math::square(radius) * shaft.length / PIECES as f64;
            first += mass * along / whisker.hinge.stiffness;
            second += mass * math::square(along) / whisker.hinge.stiffness;
        }
        let axis = unit(whisker.direction_body);
        let base = whisker.base_body.coords;
        let base = Vector2::new(base.dot(&axis), base.dot(&perpendicular(axis)));
        Self { first, second, base, direction_body: whisker.direction_body }
    }

    /// The base angle (rad) under an acceleration of the platform.
    pub(super) fn base_angle(&self, acceleration: &Acceleration) -> f64 {
        let across = perpendicular(unit(self.direction_body)).dot(&acceleration.linear_body);
        let pushed = self.first
            * (across + acceleration.yaw * self.base.x - math::square(acceleration.yaw_rate) * self.base.y)
            + self.second * acceleration.yaw;
        -pushed
    }
}

/// The base angle (rad) of an undeflected `whisker` per acceleration of its platform to the right of the shaft (m/s²).
#[must_use]
pub fn sway_by_acceleration(whisker: &Whisker) -> f64 {
    Inertia::new(whisker).first
}

/// Ratio of the base angles of `whisker` and of the reference whisker by inertia, on a platform with the same acceleration.
pub(super) fn sway(whisker: &Whisker) -> f64 {
    let reference = |reference: &Whisker| sway_by_acceleration(whisker) / sway_by_acceleration(reference);
    Rig::default().whiskers.first().map_or(1.0, reference)
}

/// Acceleration of a platform.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Acceleration {
    /// Of the centre of mass (m/s², body frame).
    linear_body: Vector2,
    /// Yaw rate (rad/s) and its change (rad/s²).
    yaw_rate: f64,
    yaw: f64,
}

impl Acceleration {
    /// The acceleration of a platform with this speed (m/s, rad/s) and its growth in a second, and with this heading (rad).
    pub(super) fn of([speed, growth]: [Motion; 2], heading: f64) -> Self {
        Self { linear_body: rotate(growth.xy(), -heading), yaw_rate: speed.z, yaw: growth.z }
    }
}

/// Acceleration of a platform from its measured poses.
#[derive(Debug, Clone)]
pub(super) struct MeasuredAcceleration {
    /// Pose at the last tick, or unknown.
    pose: Pose,
    /// Velocity (m/s, world frame) and yaw rate (rad/s) in the last tick, if they are known.
    velocity: Option<(Vector2, f64)>,
}

impl MeasuredAcceleration {
    /// Creates the measurement.
    pub(super) fn new() -> Self {
        Self { pose: Pose::UNKNOWN, velocity: None }
    }

    /// Adds the pose at the end of a tick of `period` (s). `None` unless three successive poses are known.
    pub(super) fn take(&mut self, pose: Pose, period: f64) -> Option<Acceleration> {
        let before = std::mem::replace(&mut self.pose, pose);
        let is_known = before.is_finite() && pose.is_finite() && period > 0.0;
        let velocity = is_known
            .then(|| ((pose.position - before.position) / period, turn_between(before.heading, pose.heading) / period));
        let last = std::mem::replace(&mut self.velocity, velocity);
        let ((before, rate_before), (now, yaw_rate)) = last.zip(velocity)?;
        let linear_body = rotate((now - before) / period, -pose.heading);
        Some(Acceleration { linear_body, yaw_rate, yaw: (yaw_rate - rate_before) / period })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::geometry::Point2;

    proptest! {
        /// The oracle differentiates the paths of single points of the shaft.
        #[test]
        fn every_point_of_the_shaft_pushes_with_its_own_acceleration(
            speed in -0.2..0.2_f64, gain in -2.0..2.0_f64, yaw_rate in -3.0..3.0_f64, yaw in -30.0..30.0_f64, heading in -3.0..3.0_f64,
        ) {
            let whisker = Rig::default().whiskers.remove(0);
            let period = 1e-3;
            let pose = |time: f64| {
                let along = speed * time + 0.5 * gain * time * time;
                let heading = heading + yaw_rate * time + 0.5 * yaw * time * time;
                Pose { position: Point2::new(along, -0.5 * along), heading }
            };
            let mut measured = MeasuredAcceleration::new();
            let found = [-period, 0.0, period].map(|time| measured.take(pose(time), period)).into_iter().flatten().next();
            let Some(acceleration) = found else { return Err(TestCaseError::fail("three poses are known")) };
            let place = |time: f64, along: f64| {
                let point = whisker.base_body + along * unit(whisker.direction_body);
                pose(time).point_to_world(point).coords
            };
            let normal = rotate(perpendicular(unit(whisker.direction_body)), heading);
            let (count, mut moment) = (2000, 0.0);
            for piece in 0..count {
                let along = (f64::from(piece) + 0.5) / f64::from(count) * whisker.shaft.length;
                let step = 1e-4;
                let change = (place(step, along) - 2.0 * place(0.0, along) + place(-step, along)) / (step * step);
                let mass = whisker.shaft.density * std::f64::consts::PI * math::square(whisker.shaft.radius) * whisker.shaft.length;
                moment -= mass / f64::from(count) * along * change.dot(&normal);
            }
            let expected = moment / whisker.hinge.stiffness;
            let base_angle = Inertia::new(&whisker).base_angle(&acceleration);
            prop_assert!((base_angle - expected).abs() < 0.02 * expected.abs() + 3e-8, "{base_angle} rad, {expected} rad");
        }
    }
}
