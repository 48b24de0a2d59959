//! The poses that the loop takes.

use std::sync::atomic::Ordering;

use vibrissa_runtime::geometry::{Pose, Vector2};

use super::order::{Order, Place};
use super::pose_packet::PosePacket;
use crate::array::is_plausible_pose;
use crate::config::Config;
use crate::vitals::Vitals;

/// Takes poses in the order of their numbers, and refuses those that the platform cannot have reached since the last one.
#[derive(Debug, Clone)]
pub struct PoseGate {
    order: Order,
    reach: Reach,
    /// The last pose that was taken, and its arrival (ns).
    last: Option<(Pose, u64)>,
}

/// How far the platform can be from its last pose.
#[derive(Debug, Clone, Copy)]
struct Reach {
    /// Limits of the rig (m/s, rad/s).
    speed: f64,
    yaw_rate: f64,
    /// Largest differences by errors of the localisation (m, rad).
    noise: f64,
    heading_noise: f64,
    /// The longest time (s) by which a pose can be later than the one before it. The packets have no times of their own.
    delay: f64,
}

impl PoseGate {
    /// The gate of a robot with this configuration.
    #[must_use]
    pub fn new(config: &Config) -> Self {
        let reach = Reach {
            speed: config.rig.platform.speed_limit,
            yaw_rate: config.rig.platform.yaw_rate_limit,
            noise: config.pose.noise,
            heading_noise: config.pose.heading_noise,
            delay: config.timeouts.pose,
        };
        Self { order: Order::new(config.timeouts.pose_ns()), reach, last: None }
    }

    /// The pose of a packet that arrives at `now_ns`, if the loop may take it. `vitals` learn of it, or why it is refused.
    pub fn take(&mut self, packet: &PosePacket, now_ns: u64, vitals: &Vitals) -> Option<Pose> {
        match self.order.place(packet.sequence, now_ns) {
            Place::Out => return None,
            Place::Anew => vitals.pose_restarted(),
            Place::Next => {}
        }
        let pose = packet.pose;
        // Before the run, nothing depends on the last pose, and it may be wrong.
        if vitals.is_running.load(Ordering::Acquire)
            && is_plausible_pose(&pose)
            && self.last.is_some_and(|(last, at_ns)| !self.reach.has(&last, &pose, now_ns.saturating_sub(at_ns)))
        {
            vitals.pose_jumped();
            return None;
        }
        if !vitals.pose_arrived(&pose, now_ns) {
            return None;
        }
        self.last = Some((pose, now_ns));
        Some(pose)
    }
}

impl Reach {
    /// True if the platform can be at `pose` this time (ns) after `last`.
    fn has(&self, last: &Pose, pose: &Pose, elapsed_ns: u64) -> bool {
        let time = elapsed_ns as f64 * 1e-9 + self.delay;
        let moved: Vector2 = pose.position - last.position;
        // Headings may be wrapped.
        let turned = (pose.heading - last.heading) / std::f64::consts::TAU;
        let turned = (turned - turned.round()).abs() * std::f64::consts::TAU;
        moved.norm() <= self.speed * time + self.noise && turned <= self.yaw_rate * time + self.heading_noise
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use super::*;
    use proptest::prelude::*;
    use vibrissa_runtime::geometry::Point2;
    use vibrissa_runtime::math;
    use vibrissa_runtime::rig::Rig;

    const MS: u64 = 1_000_000;

    /// The reference rig with the limits of the baseline's robot, 0.1 m/s and 60°/s.
    fn gate() -> PoseGate {
        let mut config = Config::emulated(Rig::default(), 1.5);
        (config.rig.platform.speed_limit, config.rig.platform.yaw_rate_limit) = (0.1, 60_f64.to_radians());
        PoseGate::new(&config)
    }

    fn pose(x: f64, y: f64, degrees: f64) -> Pose {
        Pose { position: Point2::new(x, y), heading: degrees.to_radians() }
    }

    /// The times (ms) at which poses are taken, and the jumps, if a packet arrives every 20 ms.
    fn taken(poses: impl IntoIterator<Item = Pose>) -> (Vec<u64>, u64) {
        let (mut gate, vitals) = (gate(), Vitals::default());
        vitals.is_running.store(true, Ordering::Release);
        let take = |(index, pose): (u64, Pose)| {
            let packet = PosePacket { sequence: index + 1, pose };
            gate.take(&packet, 20 * MS * index, &vitals).map(|_| 20 * index)
        };
        let times = (0..).zip(poses).filter_map(take).collect();
        (times, vitals.pose_jumps.load(Ordering::Relaxed))
    }

    #[test]
    fn a_jump_that_the_platform_cannot_make_is_refused_as_long_as_it_cannot() {
        let (times, jumps) = taken((0..100).map(|index| pose(if index < 10 { 0.0 } else { 0.501 }, 0.0, 0.0)));
        // 0.5 m at 0.1 m/s, less the noise of 20 mm and 60 ms for late packets.
        assert_eq!(times.iter().find(|time| **time > 180), None);
        assert_eq!((times.len(), jumps), (10, 90));
        let (times, jumps) = taken((0..400).map(|index| pose(if index < 10 { 0.0 } else { 0.501 }, 0.0, 0.0)));
        assert_eq!(times.iter().find(|time| **time > 180), Some(&(180 + 4760)));
        assert_eq!(jumps, 237);
        for heading in [90.0, -90.0, 180.0, 450.0, 12.0] {
            let (times, _) = taken([pose(0.0, 0.0, 0.0), pose(0.0, 0.0, heading), pose(0.0, 0.0, 0.0)]);
            assert_eq!(times, [0, 40], "{heading}");
        }
    }

    #[test]
    fn a_wrong_first_pose_does_not_matter_if_the_run_has_not_begun() {
        let (mut gate, vitals) = (gate(), Vitals::default());
        let mut take = |sequence: u64, x: f64| {
            gate.take(&PosePacket { sequence, pose: pose(x, 0.0, 0.0) }, 20 * MS * sequence, &vitals).is_some()
        };
        assert!(take(1, 50.0) && take(2, 0.0));
        vitals.is_running.store(true, Ordering::Release);
        assert!(!take(3, 50.0) && take(4, 0.0));
    }

    #[test]
    fn headings_may_be_wrapped_anywhere() {
        for cut in [0.0, 90.0, 180.0, 360.0, 1000.0] {
            // 30° per second, as most localisations send it.
            let wrapped = |index: i32| (f64::from(index) * 0.6 + cut).rem_euclid(360.0) - cut;
            let (times, jumps) = taken((0..2000).map(|index| pose(0.0, 0.0, wrapped(index))));
            assert_eq!((times.len(), jumps), (2000, 0), "{cut}");
        }
    }

    #[test]
    fn a_pose_of_no_robot_is_refused_also_as_the_first() {
        let bad = [1e308, -1e308, f64::MAX, 1e9, f64::INFINITY, f64::NAN];
        let bad = bad.into_iter().flat_map(|x| [pose(x, 0.0, 0.0), pose(0.0, x, 0.0), pose(0.0, 0.0, x)]);
        for bad in bad {
            let (times, _) = taken([bad, pose(3.0, -4.0, 700.0), bad, pose(3.0, -4.0, 700.0)]);
            assert_eq!(times, [20, 60], "{bad:?}");
        }
    }

    proptest! {
        #[test]
        fn no_motion_within_the_limits_is_refused(
            steps in proptest::collection::vec((0.0..std::f64::consts::TAU, 0.0..0.002_f64, -1.2..1.2, -0.009..0.009_f64), 1..200),
        ) {
            let (mut place, mut heading) = (Point2::origin(), 0.0);
            let poses = steps.iter().map(|&(direction, length, turn, noise)| {
                place += Vector2::new(math::cos(direction), math::sin(direction)) * length;
                heading += turn;
                pose(place.x + noise, place.y, heading)
            });
            let (times, jumps) = taken(poses);
            prop_assert_eq!((times.len(), jumps), (steps.len(), 0));
        }
    }
}
