//! The newest poses of the platform.

use std::collections::VecDeque;

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

    /// Adds a pose. One that is not finite, or older than the newest, is ignored, and the result is false.
    pub fn push(&mut self, stamped: StampedPose) -> bool {
        if !stamped.pose.is_finite() || self.poses.back().is_some_and(|newest| stamped.time_ns <= newest.time_ns) {
            return false;
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
}
