//! Steering of a body or a whisker.

use crate::geometry::{Pose, Vector2, turn_between};
use crate::machine::{Action, Mover, Turn};
use crate::rig::Rig;
use crate::signal::Command;

use super::pi_controller::PiController;
use super::pose_hold::PoseHold;

/// Converts actions to commands for one rig (algorithms 1 and 2 of the baseline).
#[derive(Debug, Clone)]
pub struct Steering {
    /// Base positions of the whiskers that the policy binds (m, body frame).
    bases_body: Vec<Vector2>,
    yaw_controller: PiController,
    pose_hold: PoseHold,
    /// True if the last action was a stop.
    is_stopped: bool,
    /// Speed limit of the platform (m/s).
    speed_limit: f64,
    /// Yaw rate limit of the platform (rad/s).
    yaw_rate_limit: f64,
    /// Control period (s).
    period: f64,
    /// The last command.
    last: Command,
}

impl Steering {
    /// Creates the steering of `rig` for its whiskers with these indices, at rest. For a whisker that the rig lacks
    /// (`None`), the body is moved.
    ///
    /// # Panics
    /// If the rig has no whisker with such an index.
    #[must_use]
    pub fn new(rig: &Rig, whiskers: &[Option<usize>]) -> Self {
        let yaw = &rig.platform.yaw;
        Self {
            bases_body: whiskers
                .iter()
                .map(|index| index.map_or_else(Vector2::zeros, |index| rig.whiskers[index].base_body.coords))
                .collect(),
            yaw_controller: PiController::new(yaw.proportional, yaw.integral, yaw.limit),
            pose_hold: PoseHold::new(rig),
            is_stopped: false,
            speed_limit: rig.platform.speed_limit,
            yaw_rate_limit: rig.platform.yaw_rate_limit,
            period: 1.0 / rig.sensing.control_rate,
            last: Command::STOP,
        }
    }

    /// Returns the command for `action` with the platform at `body`.
    ///
    /// [`Action::Stop`] brakes and then holds the pose. [`Action::Hold`] keeps the last command, or continues the stop.
    ///
    /// The body always moves at the given speed. A rotation also moves a whisker's base about the body. Only the
    /// direction of the body compensates for this, not its speed. A full compensation would make the body fastest when
    /// it rotates most and knows the contour least, and contour following would lose its object within a second.
    ///
    /// Speed and yaw rate never exceed the platform's limits. The command is always finite. If it would not be, for
    /// example for an unknown pose, the platform stands still.
    pub fn command(&mut self, action: &Action, body: Pose) -> Command {
        match *action {
            Action::Hold if self.is_stopped => self.last = self.pose_hold.command(body),
            Action::Hold => {}
            Action::Stop => {
                if !self.is_stopped {
                    self.yaw_controller.reset();
                    self.pose_hold.reset();
                }
                self.is_stopped = true;
                self.last = self.pose_hold.command(body);
            }
            Action::Steer { mover, along_world, speed, turn } => {
                let speed = speed.clamp(-self.speed_limit, self.speed_limit);
                let yaw_rate = match turn {
                    Turn::Rate(rate) => {
                        self.yaw_controller.reset();
                        rate
                    }
                    Turn::Facing(heading) => self.yaw_controller.next(turn_between(body.heading, heading), self.period),
                };
                let yaw_rate = yaw_rate.clamp(-self.yaw_rate_limit, self.yaw_rate_limit);
                let velocity = at_speed(speed, along_world);
                let velocity_world = match mover {
                    Mover::Body => velocity,
                    Mover::Whisker(whisker) => {
                        let base_world = body.vector_to_world(self.bases_body[whisker]);
                        let swing = yaw_rate * Vector2::new(-base_world.y, base_world.x);
                        at_speed(speed.abs(), velocity - swing)
                    }
                };
                let command = Command { velocity_world, yaw_rate };
                self.is_stopped = false;
                self.last = if command.is_finite() { command } else { Command::STOP };
            }
        }
        self.last
    }
}

/// Scales a vector to a length. Zero remains zero.
fn at_speed(speed: f64, along: Vector2) -> Vector2 {
    speed * along.try_normalize(0.0).unwrap_or_default()
}
