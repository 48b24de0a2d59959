//! Steering a body or a whisker.

use crate::geometry::{Pose, Vector2, turn_between};
use crate::machine::{Action, Mover, Turn};
use crate::rig::Rig;
use crate::signal::Command;

use super::pi_controller::PiController;

/// Turns actions into commands for one rig (the thesis's algorithms 1 and 2).
#[derive(Debug, Clone)]
pub struct Steering {
    /// Where every whisker that the policy binds has its base, in the body frame (m).
    bases_body: Vec<Vector2>,
    yaw_controller: PiController,
    period: f64,
    last: Command,
}

impl Steering {
    /// Steering for `rig` and the whiskers called `names`, at rest.
    #[must_use]
    pub fn new(rig: &Rig, names: &[String]) -> Self {
        let base = |name: &String| {
            let whisker = rig.whiskers.iter().find(|whisker| whisker.name == *name);
            whisker.map_or_else(Vector2::zeros, |whisker| whisker.base_body.coords)
        };
        let yaw = &rig.platform.yaw;
        Self {
            bases_body: names.iter().map(base).collect(),
            yaw_controller: PiController::new(yaw.proportional, yaw.integral, yaw.limit),
            period: 1.0 / rig.sensing.control_rate,
            last: Command::STOP,
        }
    }

    /// The command for `action` with the platform at `body`.
    ///
    /// The body, or the whisker's base, gets the speed asked for in the direction asked for. Turning moves a whisker's base
    /// too, and the body's velocity makes up for that, so that the body may be faster than the speed asked for: by the yaw
    /// rate times the base's distance at most. (The thesis's algorithm 2 gives the body the speed asked for, and the base
    /// what comes of it.)
    pub fn command(&mut self, action: &Action, body: Pose) -> Command {
        match *action {
            Action::Hold => {}
            Action::Stop => {
                self.yaw_controller.reset();
                self.last = Command::STOP;
            }
            Action::Steer { mover, along_world, speed, turn } => {
                let yaw_rate = match turn {
                    Turn::Rate(rate) => {
                        self.yaw_controller.reset();
                        rate
                    }
                    Turn::Facing(heading) => self.yaw_controller.next(turn_between(body.heading, heading), self.period),
                };
                let velocity = speed * unit(along_world);
                let velocity_world = match mover {
                    Mover::Body => velocity,
                    Mover::Whisker(whisker) => {
                        let base_world = body.vector_to_world(self.bases_body[whisker]);
                        let swing = yaw_rate * Vector2::new(-base_world.y, base_world.x);
                        velocity - swing
                    }
                };
                self.last = Command { velocity_world, yaw_rate };
            }
        }
        self.last
    }
}

fn unit(vector: Vector2) -> Vector2 {
    let norm = vector.norm();
    if norm > 0.0 { vector / norm } else { Vector2::zeros() }
}
