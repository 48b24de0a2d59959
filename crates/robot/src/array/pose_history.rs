//! The newest poses of the platform.

use std::collections::VecDeque;
use std::f64::consts::TAU;

use vibrissa_runtime::geometry::{Point2, Pose};

/// A pose with its time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StampedPose {
    /// Time of the pose since the start of the program (ns).
    pub time_ns: u64,
    /// The pose in the world frame.
    pub pose: Pose,
}

/// Number of poses that are kept: half a second at 1 kHz.
const CAPACITY: usize = 512;
/// Largest coordinate of a position (m). Those of maps are smaller, and a pose beyond is none of a robot.
const FARTHEST: f64 = 1e8;
/// Largest heading (rad), of 160 000 turns that have not been wrapped.
const MOST_TURNED: f64 = 1e6;

/// True if a robot can have this pose: its numbers are finite and not absurd.
#[must_use]
pub fn is_plausible_pose(pose: &Pose) -> bool {
    pose.position.x.abs() <= FARTHEST && pose.position.y.abs() <= FARTHEST && pose.heading.abs() <= MOST_TURNED
}

/// The newest poses, for the pose at the time of a sample.
#[derive(Debug, Clone)]
pub struct PoseHistory {
    poses: VecDeque<StampedPose>,
    reach_ns: u64,
}

impl PoseHistory {
    /// An empty history. A pose is extrapolated over at most `reach_ns`.
    #[must_use]
    pub fn new(reach_ns: u64) -> Self {
        Self { poses: VecDeque::with_capacity(CAPACITY), reach_ns }
    }

    /// Adds a pose. One that is [implausible](is_plausible_pose), or not newer than the newest, is ignored, and the result is false.
    ///
    /// Most localisations wrap headings. Here they are unwrapped: that of a pose differs from the one before by half a turn at
    /// most.
    pub fn push(&mut self, mut stamped: StampedPose) -> bool {
        if !is_plausible_pose(&stamped.pose) {
            return false;
        }
        if let Some(newest) = self.poses.back() {
            if stamped.time_ns <= newest.time_ns {
                return false;
            }
            // Headings that are not wrapped keep their bits.
            let turns = ((stamped.pose.heading - newest.pose.heading) / TAU).round();
            if turns != 0.0 {
                stamped.pose.heading -= turns * TAU;
            }
        }
        if self.poses.len() == CAPACITY {
            self.poses.pop_front();
        }
        self.poses.push_back(stamped);
        true
    }

    /// The pose at a time (ns): interpolated, or extrapolated from the two newest. Otherwise it is
    /// [`Pose::UNKNOWN`].
    #[must_use]
    pub fn at(&self, time_ns: u64) -> Pose {
        let after = self.poses.partition_point(|stamped| stamped.time_ns < time_ns);
        let (first, second) = match (after.checked_sub(1).and_then(|i| self.poses.get(i)), self.poses.get(after)) {
            (_, Some(exact)) if exact.time_ns == time_ns => return exact.pose,
            (Some(before), Some(after)) => (before, after),
            (Some(newest), None) if time_ns - newest.time_ns <= self.reach_ns => {
                match self.poses.len().checked_sub(2).and_then(|index| self.poses.get(index)) {
                    Some(previous) => (previous, newest),
                    None => return newest.pose,
                }
            }
            (None, Some(oldest)) if oldest.time_ns - time_ns <= self.reach_ns => return oldest.pose,
            _ => return Pose::UNKNOWN,
        };
        let share = (time_ns - first.time_ns) as f64 / (second.time_ns - first.time_ns) as f64;
        let between = |from: f64, to: f64| from + share * (to - from);
        Pose {
            position: Point2::new(
                between(first.pose.position.x, second.pose.position.x),
                between(first.pose.position.y, second.pose.position.y),
            ),
            heading: between(first.pose.heading, second.pose.heading),
        }
    }
}

#[cfg(test)]
mod tests {
    use vibrissa_runtime::math;

    use super::*;

    fn moving(time_ns: u64) -> StampedPose {
        let seconds = time_ns as f64 * 1e-9;
        let position = Point2::new(0.05 * seconds, 1.0 - 0.02 * seconds);
        StampedPose { time_ns, pose: Pose { position, heading: 0.3 * seconds } }
    }

    #[test]
    fn a_uniform_motion_is_exact_between_poses_and_shortly_after_them() {
        let mut history = PoseHistory::new(50_000_000);
        for index in 1..2000 {
            assert!(history.push(moving(index * 1_000_000)));
        }
        for time_ns in [1_600_000_000, 1_600_400_000, 1_999_000_000, 2_020_000_000] {
            let (found, exact) = (history.at(time_ns), moving(time_ns).pose);
            assert!((found.position - exact.position).norm() < 1e-12 && (found.heading - exact.heading).abs() < 1e-12);
        }
        assert!(!history.at(2_100_000_000).is_finite(), "too far ahead");
        assert!(!history.at(1_000_000_000).is_finite(), "forgotten");
    }

    #[test]
    fn poses_out_of_order_and_poses_without_numbers_are_ignored() {
        let mut history = PoseHistory::new(50_000_000);
        assert!(history.push(moving(10)));
        assert!(!history.push(moving(10)) && !history.push(moving(5)));
        assert!(!history.push(StampedPose { time_ns: 20, pose: Pose::UNKNOWN }));
        assert_eq!(history.at(10), moving(10).pose);
    }

    #[test]
    fn wrapped_headings_give_the_headings_of_the_motion() {
        let heading = |seconds: f64, rate: f64| 178_f64.to_radians() + rate * seconds;
        for rate in [0.5, -0.5, 3.0, -3.0] {
            // Within (-180°, 180°], within [0°, 360°), and from one to the other.
            let half = |angle: f64| std::f64::consts::PI - (std::f64::consts::PI - angle).rem_euclid(TAU);
            let either = |angle: f64| if math::sin(angle) > 0.3 { half(angle) } else { angle.rem_euclid(TAU) };
            for wrap in [&half as &dyn Fn(f64) -> f64, &|angle| angle.rem_euclid(TAU), &either, &|angle| angle] {
                let mut history = PoseHistory::new(60_000_000);
                let begin = wrap(heading(0.0, rate)) - heading(0.0, rate);
                for index in 0..2000 {
                    let time_ns = index * 20_000_000;
                    let pose = Pose { heading: wrap(heading(time_ns as f64 * 1e-9, rate)), ..moving(time_ns).pose };
                    assert!(history.push(StampedPose { time_ns, pose }));
                    for later_ns in [0, 5_000_000, 13_000_000, 40_000_000] {
                        let time_ns = time_ns.saturating_sub(20_000_000) + later_ns;
                        let exact = begin + heading(time_ns as f64 * 1e-9, rate);
                        let found = history.at(time_ns).heading;
                        assert!(index == 0 || (found - exact).abs() < 1e-9, "{found} instead of {exact}");
                    }
                }
            }
        }
    }

    #[test]
    fn poses_that_no_robot_can_have_are_ignored() {
        let mut history = PoseHistory::new(50_000_000);
        for absurd in [1e308, -1e308, 1e9, f64::INFINITY, f64::NAN] {
            for (x, y, heading) in [(absurd, 0.0, 0.0), (0.0, absurd, 0.0), (0.0, 0.0, absurd)] {
                assert!(!history.push(StampedPose { time_ns: 1, pose: Pose { position: Point2::new(x, y), heading } }));
            }
        }
        // The corner of a map, and a robot that has turned for a day.
        let far = Pose { position: Point2::new(5e5, 9.9e6), heading: -2.7e5 };
        assert!(history.push(StampedPose { time_ns: 1, pose: far }));
    }
}
