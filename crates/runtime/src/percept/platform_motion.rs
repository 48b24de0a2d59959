//! The motion of the platform by its commands: its measured delay and servo.

use nalgebra::Vector3;

use crate::geometry::{Pose, turn_between};
use crate::math;
use crate::rig::Rig;
use crate::signal::Command;

/// A motion of the body: x and y of the centre of mass (m, world frame) and the rotation (rad).
pub(super) type Motion = Vector3<f64>;

/// Measures how the platform follows its commands.
///
/// A platform follows a command after a delay, with the time constant of its servos. Expected motions for a grid of both
/// are compared with measured poses. The expected motions of a servo are the same for all delays, but later. So they are
/// computed once for each servo and remembered.
#[derive(Debug, Clone)]
pub(super) struct PlatformMotion {
    /// Time between ticks and between steps (s), and the number of steps in a tick.
    period: f64,
    step: f64,
    steps: usize,
    /// Time constants (s) of the grid for velocities.
    times: EachServo,
    /// Share of the speed difference that is left after a step, the equivalent time (s) at that difference, and the speed, by
    /// coordinate.
    left: [EachServo; 3],
    behind: [EachServo; 3],
    speed: [EachServo; 3],
    /// Motion since the start of the run at the newest steps, by coordinate.
    motions: [[EachServo; 3]; MEMORY],
    /// Index of the newest step in the memory of motions, and the number of steps since the last gap.
    newest: usize,
    known: usize,
    /// Averages of squared differences (m²), by delay.
    costs: [EachServo; DELAYS],
    /// Pose of the last tick, or unknown.
    pose: Pose,
    /// The current command.
    command: Command,
    /// Time constant of the servos (s) for velocities according to the rig, and as measured. That for yaw rates has the same
    /// ratio to the one of the rig, because one number for both is measured sooner.
    stated_servo: f64,
    servo: f64,
    /// Measured delay (s) of a pose behind its command.
    delay: f64,
    /// True if delay and servo hardly change any more.
    is_settled: bool,
}

/// A value for each servo of the grid, fastest first. Neighbouring values let one instruction compute several of them.
type EachServo = [f64; SERVOS.len()];

/// Time constants of the grid over that of the rig, and the index of the rig's one.
const SERVOS: [f64; 8] = [
    0.5,
    std::f64::consts::FRAC_1_SQRT_2,
    1.0,
    std::f64::consts::SQRT_2,
    2.0,
    2.0 * std::f64::consts::SQRT_2,
    4.0,
    4.0 * std::f64::consts::SQRT_2,
];
const STATED: usize = 2;
/// Wanted time between steps (s), and the most steps in a tick.
const STEP: f64 = 1.0 / 300.0;
const MOST_STEPS: usize = 15;
/// Number of delays of the grid, and of steps between two of them.
const DELAYS: usize = 16;
const DELAY_STEPS: usize = 3;
/// Number of remembered steps.
const MEMORY: usize = 64;
/// Distance (m) from the centre of mass at which a rotation counts like a translation.
const ARM: f64 = 0.1;
/// Share of a difference that is left after a tick. Differences of half a minute count.
const REMEMBERED: f64 = 0.999;
/// Smallest sum of squared differences (m²) that is not due to forces or errors of poses, and the largest share of it
/// that another servo or delay may leave. A platform that is blocked leaves more with all of them.
const LEAST_COST: f64 = 1e-6;
const MOST_LEFT: f64 = 0.15;
/// Smallest delay (s), and the smallest ratio of time constants, that is corrected.
const LEAST_DELAY: f64 = 8e-3;
const LEAST_RATIO: f64 = 1.2;
/// Relative difference of time constants that has no effect.
const NEAR: f64 = 1e-3;
/// Difference of a delay (s), and relative difference of a time constant, that is still to be followed.
const SETTLED: (f64, f64) = (4e-3, 0.1);
/// Time (s) in which a correction follows what is measured.
const FOLLOWING: f64 = 1.0;

impl PlatformMotion {
    /// Creates the measurement for the platform of `rig`, at rest.
    pub(super) fn new(rig: &Rig) -> Self {
        let period = rig.sensing.control_rate.recip();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
        let steps = ((period / STEP).round() as usize).clamp(1, MOST_STEPS);
        let step = period / steps as f64;
        let stated = rig.platform.servos();
        let stated_servo = stated.x;
        let times = <[f64; 3]>::from(stated).map(|stated| SERVOS.map(|factor| factor * stated));
        let left = times.map(|times| times.map(|time| math::exp(-step / time)));
        let behind = [0, 1, 2].map(|axis| std::array::from_fn(|servo| times[axis][servo] * (1.0 - left[axis][servo])));
        let none = [[0.0; SERVOS.len()]; 3];
        Self {
            period,
            step,
            steps,
            times: times[0],
            left,
            behind,
            speed: none,
            motions: [none; MEMORY],
            newest: 0,
            known: 0,
            costs: [[0.0; SERVOS.len()]; DELAYS],
            pose: Pose::UNKNOWN,
            command: Command::STOP,
            stated_servo,
            servo: stated_servo,
            delay: 0.0,
            is_settled: false,
        }
    }

    /// Sets the command that holds until the next tick.
    pub(super) fn command(&mut self, command: Command) {
        self.command = command;
    }

    /// Measured time constant of the servos (s) for velocities, if it is not the stated one.
    pub(super) fn servo(&self) -> Option<f64> {
        ((self.servo - self.stated_servo).abs() > NEAR * self.stated_servo).then_some(self.servo)
    }

    /// Delay (s) of measured poses behind their commands. It does not include the servos.
    pub(super) fn delay(&self) -> f64 {
        self.delay
    }

    /// Continues the expected motion for a tick of `period` (s).
    pub(super) fn advance(&mut self, period: f64) {
        // After a tick of another length the times of earlier steps are wrong.
        if (period - self.period).abs() > 0.5 * self.period {
            self.known = 0;
        }
        let aim: [f64; 3] = self.command.velocity_world.push(self.command.yaw_rate).into();
        let (step, steps, first) = (self.step, self.steps, self.newest);
        for (axis, aim) in aim.into_iter().enumerate() {
            let (left, behind) = (&self.left[axis], &self.behind[axis]);
            let (mut by_aim, mut gained) = ([0.0; SERVOS.len()], [0.0; SERVOS.len()]);
            for servo in 0..SERVOS.len() {
                by_aim[servo] = aim * (step - behind[servo]);
                gained[servo] = aim * (1.0 - left[servo]);
            }
            let (mut newest, mut sum, mut speed) = (first, self.motions[first][axis], self.speed[axis]);
            for _ in 0..steps {
                newest = if newest + 1 == MEMORY { 0 } else { newest + 1 };
                for servo in 0..SERVOS.len() {
                    sum[servo] += speed[servo] * behind[servo] + by_aim[servo];
                    speed[servo] = speed[servo] * left[servo] + gained[servo];
                }
                self.motions[newest][axis] = sum;
            }
            self.speed[axis] = speed;
        }
        self.newest = (first + steps) % MEMORY;
        self.known = (self.known + self.steps).min(MEMORY);
    }

    /// Compares the expected motions of this tick with the measured `pose`, which may be unknown. Returns the expected
    /// motion and the measured one beyond it, if both are known.
    pub(super) fn compare(&mut self, pose: Pose) -> Option<[Motion; 2]> {
        let before = std::mem::replace(&mut self.pose, pose);
        if !(before.is_finite() && pose.is_finite()) || self.known < MEMORY {
            return None;
        }
        let turn = turn_between(before.heading, pose.heading);
        let measured = (pose.position - before.position).push(turn);
        for (delay, costs) in self.costs.iter_mut().enumerate() {
            let back = delay * DELAY_STEPS;
            let end = &self.motions[earlier(self.newest, back)];
            let start = &self.motions[earlier(self.newest, back + self.steps)];
            let missing = |axis: usize, servo: usize| measured[axis] - (end[axis][servo] - start[axis][servo]);
            for (servo, cost) in costs.iter_mut().enumerate() {
                let (x, y) = (missing(0, servo), missing(1, servo));
                let squared = (x * x + y * y) + math::square(ARM * missing(2, servo));
                *cost = *cost * REMEMBERED + squared;
            }
        }
        self.estimate();
        let expected = self.between(self.delay + self.period, self.delay);
        Some([expected, measured - expected])
    }

    /// Follows the servo and the delay with the smallest differences, if they are significant.
    fn estimate(&mut self) {
        let stated = self.costs[0][STATED];
        let least = self.costs.iter().flatten().copied().fold(stated, math::min);
        if stated < LEAST_COST || least > MOST_LEFT * stated {
            self.is_settled = false;
            return;
        }
        let (mut best, mut at) = (stated, (STATED, 0));
        for servo in 0..SERVOS.len() {
            for (delay, costs) in self.costs.iter().enumerate() {
                if costs[servo] < best {
                    (best, at) = (costs[servo], (servo, delay));
                }
            }
        }
        let by_delay = |delay: usize| self.costs[delay][at.0];
        let by_servo = |servo: usize| self.costs[at.1][servo];
        let delay = (at.1 as f64 + vertex(at.1, DELAYS, by_delay)) * (DELAY_STEPS as f64 * self.step);
        // The grid is logarithmic, with two servos for a factor of 2.
        let ratio = math::powf(2.0, (at.0 as f64 + vertex(at.0, SERVOS.len(), by_servo) - STATED as f64) / 2.0);
        let delay = if delay < LEAST_DELAY { 0.0 } else { delay };
        let ratio = if ratio < LEAST_RATIO && ratio * LEAST_RATIO > 1.0 { 1.0 } else { ratio };
        let servo = ratio * self.stated_servo;
        self.is_settled = (delay - self.delay).abs() < SETTLED.0 && (servo - self.servo).abs() < SETTLED.1 * servo;
        let share = math::min(self.period / FOLLOWING, 1.0);
        self.delay += (delay - self.delay) * share;
        self.servo += (servo - self.servo) * share;
    }

    /// True if delay and servo hardly change any more.
    pub(super) fn is_settled(&self) -> bool {
        self.is_settled
    }

    /// Speed (m/s, rad/s) in the newest tick, and its growth in a second since the tick before, of a platform with this
    /// `delay` (s).
    pub(super) fn speed(&self, delay: f64) -> [Motion; 2] {
        let [now, before] =
            [0.0, self.period].map(|ago| self.between(delay + ago + self.period, delay + ago) / self.period);
        [now, (now - before) / self.period]
    }

    /// The expected motion from `from` to `to` (s) before the newest step.
    pub(super) fn between(&self, from: f64, to: f64) -> Motion {
        let nearest = self.times.iter().enumerate().min_by(|(_, a), (_, b)| {
            let distance = |time: f64| (time - self.servo).abs();
            distance(**a).total_cmp(&distance(**b))
        });
        nearest.map_or_else(Motion::zeros, |(servo, _)| self.motion(servo, to) - self.motion(servo, from))
    }

    /// The motion of a servo up to `ago` (s) before the newest step, interpolated between steps.
    fn motion(&self, servo: usize, ago: f64) -> Motion {
        let along = (ago / self.step).clamp(0.0, (MEMORY - 2) as f64);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the memory")]
        let whole = along as usize;
        let at = |step: usize| {
            let [x, y, turn] = &self.motions[earlier(self.newest, step)];
            Motion::new(x[servo], y[servo], turn[servo])
        };
        at(whole).lerp(&at(whole + 1), along - whole as f64)
    }
}

/// The index of the step so many steps before `newest`.
fn earlier(newest: usize, steps: usize) -> usize {
    (newest + MEMORY - steps) % MEMORY
}

/// The place of the vertex of the parabola through the value at `index` and its neighbours, relative to `index`. 0 at
/// the ends of `count` values.
pub(super) fn vertex(index: usize, count: usize, value: impl Fn(usize) -> f64) -> f64 {
    if index == 0 || index + 1 == count {
        return 0.0;
    }
    let (below, here, above) = (value(index - 1), value(index), value(index + 1));
    let bend = below - 2.0 * here + above;
    if bend > 0.0 { (0.5 * (below - above) / bend).clamp(-0.5, 0.5) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::geometry::{Point2, Vector2};

    /// A platform that is simulated in steps of 0.1 ms, with a delay (s) of commands or poses and with the time constants
    /// of its servos (s).
    fn measured(rig: &Rig, commands: &[(f64, f64)], delay: f64, servos: Motion) -> PlatformMotion {
        let mut platform = PlatformMotion::new(rig);
        let (step, per_tick) = (1e-4, 333);
        let period = step * f64::from(per_tick);
        let late = (delay / step).round();
        let at = |index: f64| {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index")]
            let tick = (math::max(index, 0.0) / f64::from(per_tick)) as usize;
            // Every command holds for ten ticks. The first one is given at the end of the first tick.
            let before = tick.checked_sub(1).and_then(|tick| commands.get(tick / 10));
            before
                .filter(|_| index >= 0.0)
                .map_or(Motion::zeros(), |&(speed, rate)| Motion::new(speed, -0.5 * speed, rate))
        };
        let (mut speed, mut pose) = (Motion::zeros(), Motion::zeros());
        for tick in 0..commands.len() * 10 {
            for substep in 0..per_tick {
                let index = f64::from(u32::try_from(tick).unwrap_or(0)) * f64::from(per_tick) + f64::from(substep);
                speed += (at(index - late) - speed).component_mul(&servos.map(|servo| step / servo));
                pose += speed * step;
            }
            platform.advance(period);
            platform.compare(Pose { position: Point2::new(pose.x, pose.y), heading: pose.z });
            let next = at(f64::from(u32::try_from(tick + 1).unwrap_or(0)) * f64::from(per_tick));
            platform.command(Command { velocity_world: Vector2::new(next.x, next.y), yaw_rate: next.z });
        }
        platform
    }

    fn commands() -> impl Strategy<Value = Vec<(f64, f64)>> {
        prop::collection::vec((-0.05..0.05_f64, -1.0..1.0_f64), 60)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        #[test]
        fn delay_and_servo_are_found(
            commands in commands(), delay in 0.02..0.12_f64, ratio in 1.0..4.5_f64, yaw_servo in prop::option::of(0.02..0.1_f64),
        ) {
            let mut rig = Rig::default();
            rig.platform.yaw_servo = yaw_servo;
            let servo = ratio * rig.platform.servo;
            let platform = measured(&rig, &commands, delay, ratio * rig.platform.servos());
            let found = platform.servo().unwrap_or(0.05);
            prop_assert!((platform.delay() - delay).abs() < 0.015, "{} s, {delay} s", platform.delay());
            prop_assert!((0.75..1.3).contains(&(found / servo)), "{found} s, {servo} s");
            prop_assert!((platform.delay() + found - delay - servo).abs() < 0.02);
        }

        #[test]
        fn a_platform_as_stated_is_left_as_it_is(commands in commands()) {
            let rig = Rig::default();
            let platform = measured(&rig, &commands, 0.0, rig.platform.servos());
            prop_assert_eq!(platform.delay().to_bits(), 0.0_f64.to_bits());
            prop_assert_eq!(platform.servo(), None);
        }
    }
}
