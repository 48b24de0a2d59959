//! Holding the pose at which the platform came to rest.

use crate::geometry::{Pose, Vector2, turn_between};
use crate::rig::Rig;
use crate::signal::Command;

use super::pi_controller::PiController;

/// After so many time constants of its servos the platform has come to rest: a 20 000th of its speed is left.
const BRAKING: f64 = 10.0;
/// Output for a unit of error, times the servos' time constant and a control period together. The phase margin is at least 37° for any of
/// these times.
const PROPORTIONAL: f64 = 0.45;
/// The most speed (m/s) and yaw rate (rad/s) that a pose is held by: several times what a strongly bent whisker pushes.
const SPEED_LIMIT: f64 = 0.02;
const YAW_RATE_LIMIT: f64 = 0.2;

/// Stops the platform, and then holds its pose against lasting forces, such as those of its own bent whiskers.
///
/// A velocity servo that is told to stand still gives way: a force `F` moves it at `F T / m`, with its time constant `T`. While the
/// platform brakes nothing is commanded. What it still moves by when it has come to rest is taken to be such a push, which has been there since
/// the stop began: the pose that is held is set back by it, and the controllers begin with it.
#[derive(Debug, Clone)]
pub(super) struct PoseHold {
    /// One for x, y and the heading.
    controllers: [PiController; 3],
    /// Time between ticks (s).
    period: f64,
    /// For how long the platform brakes (s).
    braking: f64,
    /// For how long it had been told to stop (s) before the next tick.
    stopped: f64,
    /// The pose of the tick before, while it brakes, and the one that is held, afterwards.
    last: Pose,
    held: Option<Pose>,
}

impl PoseHold {
    pub(super) fn new(rig: &Rig) -> Self {
        let (servo, period) = (rig.platform.servo, 1.0 / rig.sensing.control_rate);
        let proportional = PROPORTIONAL / (servo + period);
        let controller = |limit| PiController::new(proportional, proportional * proportional / 4.0, limit);
        let speed = controller(SPEED_LIMIT.min(rig.platform.speed_limit) / 2.0_f64.sqrt());
        Self {
            controllers: [speed.clone(), speed, controller(YAW_RATE_LIMIT.min(rig.platform.yaw_rate_limit))],
            period,
            braking: BRAKING * servo,
            stopped: 0.0,
            last: Pose::UNKNOWN,
            held: None,
        }
    }

    /// Begins anew.
    pub(super) fn reset(&mut self) {
        (self.stopped, self.last, self.held) = (0.0, Pose::UNKNOWN, None);
    }

    /// The command of the next tick of a stop, with the platform at `body`. Where the pose is not a number it is to stand still.
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

    /// Begins to hold, with the platform that has come from `last` to `body` in one tick, so long (s) after the stop began. The pose that is
    /// held.
    fn begin(&mut self, last: Pose, body: Pose, stopped: f64) -> Pose {
        let (went, turned) =
            ((body.position - last.position) / self.period, turn_between(last.heading, body.heading) / self.period);
        for (controller, push) in self.controllers.iter_mut().zip([went.x, went.y, turned]) {
            controller.begin_at(-push);
        }
        Pose { position: body.position - went * stopped, heading: body.heading - turned * stopped }
    }

    fn next(&mut self, errors: [f64; 3]) -> [f64; 3] {
        let mut outputs = [0.0; 3];
        for ((output, controller), error) in outputs.iter_mut().zip(&mut self.controllers).zip(errors) {
            *output = controller.next(error, self.period);
        }
        outputs
    }
}
