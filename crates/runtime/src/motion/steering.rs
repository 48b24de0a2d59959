//! Steering a body or a whisker.

use crate::geometry::{Pose, Vector2, turn_between};
use crate::machine::{Action, Mover, Turn};
use crate::rig::Rig;
use crate::signal::Command;

use super::pi_controller::PiController;
use super::pose_hold::PoseHold;

/// Turns actions into commands for one rig (the thesis's algorithms 1 and 2).
#[derive(Debug, Clone)]
pub struct Steering {
    /// Where every whisker that the policy binds has its base, in the body frame (m).
    bases_body: Vec<Vector2>,
    yaw_controller: PiController,
    pose_hold: PoseHold,
    /// Whether the last action was to stop.
    is_stopped: bool,
    speed_limit: f64,
    yaw_rate_limit: f64,
    period: f64,
    last: Command,
}

impl Steering {
    /// Steering for `rig` and its whiskers with these indices, at rest. For `None`, which is no whisker of the rig, the body is moved.
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

    /// The command for `action` with the platform at `body`.
    ///
    /// To stop is to stand still, and then to hold that pose. To hold is to keep to the last command, or on stopping.
    ///
    /// The body always moves at the speed asked for. Turning swings a whisker's base about the body; the body's direction, but
    /// not its speed, makes up for that. To make up for all of it, the body would have to be fastest just when a contour is
    /// least known and the platform turns most; swiping then loses its object within a second.
    ///
    /// Speed and yaw rate never exceed the platform's limits. Whatever the action and the pose are, the command is finite: where
    /// it would not be, as when the pose is not a number, the platform stands still.
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

/// The vector at another length; zero stays zero.
fn at_speed(speed: f64, along: Vector2) -> Vector2 {
    speed * along.try_normalize(0.0).unwrap_or_default()
}
