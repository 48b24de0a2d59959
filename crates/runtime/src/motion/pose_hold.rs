//! Pose hold: keeping the pose at which the platform has stopped.
//!
//! Why: docs/decisions/motion.md#a-stop-holds-the-pose.

use crate::geometry::{Pose, Vector2, turn_between};
use crate::math;
use crate::rig::Rig;
use crate::signal::Command;

use super::pi_controller::PiController;

/// Number of time constants of the servos after which the platform has stopped. 1/20 000 of its speed is left.
const BRAKING: f64 = 10.0;
/// Output per unit of error, times the sum of the servos' time constant and the control period. The phase margin is at
/// least 37° for all values of these times.
const PROPORTIONAL: f64 = 0.45;
/// Largest speed (m/s) and yaw rate (rad/s) of the pose hold. They are several times the motion due to a strongly bent
/// whisker.
const SPEED_LIMIT: f64 = 0.02;
const YAW_RATE_LIMIT: f64 = 0.2;

/// Stops the platform and then holds its pose against lasting forces, such as those of its bent whiskers.
///
/// A velocity servo with the command zero is compliant: a force `F` moves it at the speed `F T / m`, with its time
/// constant `T`. While the platform brakes, the command is zero. A speed that remains after braking is attributed to a
/// force that has been constant since the stop. The held pose is therefore moved back by the resulting displacement,
/// and the controllers start with the opposite speed.
#[derive(Debug, Clone)]
pub(super) struct PoseHold {
    /// Controllers of x, y and heading.
    controllers: [PiController; 3],
    /// Time between ticks (s).
    period: f64,
    /// Duration of braking (s).
    braking: f64,
    /// Time since the stop (s), before the next tick.
    stopped: f64,
    /// Pose of the previous tick, during braking, and the held pose afterwards.
    last: Pose,
    held: Option<Pose>,
}

impl PoseHold {
    /// Creates the pose hold of `rig`.
    pub(super) fn new(rig: &Rig) -> Self {
        let (servos, period) = (rig.platform.servos(), 1.0 / rig.sensing.control_rate);
        let controller = |servo: f64, limit| {
            let proportional = PROPORTIONAL / (servo + period);
            PiController::new(proportional, proportional * proportional / 4.0, limit)
        };
        let speed = controller(servos.x, math::min(SPEED_LIMIT, rig.platform.speed_limit) / 2.0_f64.sqrt());
        let yaw_rate = controller(servos.z, math::min(YAW_RATE_LIMIT, rig.platform.yaw_rate_limit));
        Self {
            controllers: [speed.clone(), speed, yaw_rate],
            period,
            braking: BRAKING * math::max(servos.x, servos.z),
            stopped: 0.0,
            last: Pose::UNKNOWN,
            held: None,
        }
    }

    /// Starts a new stop.
    pub(super) fn reset(&mut self) {
        (self.stopped, self.last, self.held) = (0.0, Pose::UNKNOWN, None);
    }

    /// Returns the command of the next tick of a stop, with the platform at `body`. For an unknown pose the command is
    /// zero.
    pub(super) fn command(&mut self, body: Pose) -> Command {
        let last = std::mem::replace(&mut self.last, body);
        let stopped = self.stopped;
        self.stopped += self.period;
        if self.held.is_none() && stopped > self.braking && body.is_finite() && last.is_finite() {
            self.held = Some(self.begin(last, body, stopped));
        }
        let Some(held) = self.held.filter(|_| body.is_finite()) else { return Command::STOP };
        let off = held.position - body.position;
        let errors = [off.x, off.y, turn_between(body.heading, held.heading)];
        let [x, y, yaw_rate] = self.next(errors);
        Command { velocity_world: Vector2::new(x, y), yaw_rate }
    }

    /// Starts the hold and returns the held pose. The platform has moved from `last` to `body` in one tick, `stopped`
    /// (s) after the stop.
    fn begin(&mut self, last: Pose, body: Pose, stopped: f64) -> Pose {
        let (velocity, yaw_rate) =
            ((body.position - last.position) / self.period, turn_between(last.heading, body.heading) / self.period);
        for (controller, push) in self.controllers.iter_mut().zip([velocity.x, velocity.y, yaw_rate]) {
            controller.begin_at(-push);
        }
        Pose { position: body.position - velocity * stopped, heading: body.heading - yaw_rate * stopped }
    }

    /// The outputs of the controllers for errors of x, y and heading.
    fn next(&mut self, errors: [f64; 3]) -> [f64; 3] {
        let mut outputs = [0.0; 3];
        for ((output, controller), error) in outputs.iter_mut().zip(&mut self.controllers).zip(errors) {
            *output = controller.next(error, self.period);
        }
        outputs
    }
}
