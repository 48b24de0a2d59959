//! The motion of the platform by its commands: its measured delay and servos.

use nalgebra::Vector3;

use crate::geometry::{Pose, turn_between};
use crate::math;
use crate::rig::Rig;
use crate::signal::Command;

/// A motion of the body: x and y of the centre of mass (m, world frame) and the rotation (rad).
pub(super) type Motion = Vector3<f64>;

/// Measures how the platform follows its commands.
///
/// A platform follows a command after a delay, with the time constants of its servos. Expected motions for a grid of delays
/// and time constants are compared with measured poses. The expected motions of a servo are the same for all delays, but
/// later. So they are computed once for each servo and remembered. The servos of translation and rotation differ, and the
/// delay is common to both.
#[derive(Debug, Clone)]
pub(super) struct PlatformMotion {
    /// Time between ticks and between steps (s), and the number of steps in a tick.
    period: f64,
    step: f64,
    steps: usize,
    /// Share of the speed difference that is left after a step, the equivalent time (s) at that difference, and the speed, by
    /// coordinate.
    left: [EachServo; 3],
    behind: [EachServo; 3],
    speed: [EachServo; 3],
    /// Motion since the start of the run at the newest steps, by coordinate.
    motions: Vec<[EachServo; 3]>,
    /// Index of the newest step in the memory of motions, and the number of steps since the last gap.
    newest: usize,
    known: usize,
    /// Averages of squared differences (m²), by delay, of translation and rotation.
    costs: [[EachServo; 2]; DELAYS],
    /// The same averages of the squared measured motions (m²).
    moved: [f64; 2],
    /// Pose of the last tick, or unknown.
    pose: Pose,
    /// The current command.
    command: Command,
    /// Time constants (s) of the servos of translation and rotation according to the rig, and as measured. And the index of the
    /// nearest one of the grid.
    stated: [f64; 2],
    servos: [f64; 2],
    nearest: [usize; 2],
    /// Measured delay (s) of a pose behind its command.
    delay: f64,
    /// True if delay and servos hardly change any more.
    is_settled: bool,
}

/// A value for each servo of the grid, fastest first. Neighbouring values let one instruction compute several of them.
type EachServo = [f64; SERVOS.len()];

/// Time constants of the grid over that of the rig, and the index of the rig's one. Two of them are a factor of 2.
const SERVOS: [f64; 12] = [
    0.5 * std::f64::consts::FRAC_1_SQRT_2,
    0.5,
    std::f64::consts::FRAC_1_SQRT_2,
    1.0,
    std::f64::consts::SQRT_2,
    2.0,
    2.0 * std::f64::consts::SQRT_2,
    4.0,
    4.0 * std::f64::consts::SQRT_2,
    8.0,
    8.0 * std::f64::consts::SQRT_2,
    16.0,
];
const STATED: usize = 3;
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
        let servos = rig.platform.servos();
        let stated = [servos.x, servos.z];
        let times = <[f64; 3]>::from(servos).map(|stated| SERVOS.map(|factor| factor * stated));
        let left = times.map(|times| times.map(|time| math::exp(-step / time)));
        let behind = [0, 1, 2].map(|axis| std::array::from_fn(|servo| times[axis][servo] * (1.0 - left[axis][servo])));
        let none = [[0.0; SERVOS.len()]; 3];
        Self {
            period,
            step,
            steps,
            left,
            behind,
            speed: none,
            motions: vec![none; MEMORY],
            newest: 0,
            known: 0,
            costs: [[[0.0; SERVOS.len()]; 2]; DELAYS],
            moved: [0.0; 2],
            pose: Pose::UNKNOWN,
            command: Command::STOP,
            stated,
            servos: stated,
            nearest: [STATED; 2],
            delay: 0.0,
            is_settled: false,
        }
    }

    /// Sets the command that holds until the next tick.
    pub(super) fn command(&mut self, command: Command) {
        self.command = command;
    }

    /// Measured time constants of the servos (s): x, y, yaw. `None` if they are the stated ones.
    pub(super) fn servos(&self) -> Option<Vector3<f64>> {
        let [servo, yaw_servo] = self.servos;
        let differs = self.servos.iter().zip(self.stated).any(|(servo, stated)| (servo - stated).abs() > NEAR * stated);
        differs.then(|| Vector3::new(servo, servo, yaw_servo))
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
        let squares = [measured.xy().norm_squared(), math::square(ARM * measured.z)];
        for (moved, square) in self.moved.iter_mut().zip(squares) {
            *moved = *moved * REMEMBERED + square;
        }
        for (delay, costs) in self.costs.iter_mut().enumerate() {
            let back = delay * DELAY_STEPS;
            let end = &self.motions[earlier(self.newest, back)];
            let start = &self.motions[earlier(self.newest, back + self.steps)];
            let missing = |axis: usize, servo: usize| measured[axis] - (end[axis][servo] - start[axis][servo]);
            let [translation, rotation] = costs;
            for servo in 0..SERVOS.len() {
                let (x, y) = (missing(0, servo), missing(1, servo));
                translation[servo] = translation[servo] * REMEMBERED + (x * x + y * y);
                rotation[servo] = rotation[servo] * REMEMBERED + math::square(ARM * missing(2, servo));
            }
        }
        self.estimate();
        let expected = self.between(self.delay + self.period, self.delay);
        Some([expected, measured - expected])
    }

    /// Follows the servos and the delay with the smallest differences, if they are significant.
    fn estimate(&mut self) {
        let least = self.costs.map(|kinds| kinds.map(|costs| costs.into_iter().fold(costs[STATED], math::min)));
        let stated = self.costs[0].map(|costs| costs[STATED]);
        let (mut at, mut best) = (0, least[0][0] + least[0][1]);
        for (delay, [translation, rotation]) in least.into_iter().enumerate() {
            if translation + rotation < best {
                (at, best) = (delay, translation + rotation);
            }
        }
        if !is_shown(best, stated[0] + stated[1], self.moved[0] + self.moved[1]) {
            self.is_settled = false;
            return;
        }
        let by_delay = |delay: usize| least[delay][0] + least[delay][1];
        let delay = (at as f64 + vertex(at, DELAYS, by_delay)) * (DELAY_STEPS as f64 * self.step);
        let delay = if delay < LEAST_DELAY { 0.0 } else { delay };
        self.is_settled = (delay - self.delay).abs() < SETTLED.0;
        let share = math::min(self.period / FOLLOWING, 1.0);
        self.delay += (delay - self.delay) * share;
        for kind in [0, 1] {
            // A platform that only translates shows nothing of its other servo.
            if !is_shown(least[at][kind], stated[kind], self.moved[kind]) {
                continue;
            }
            let costs = &self.costs[at][kind];
            let servo =
                (0..SERVOS.len()).fold(STATED, |best, servo| if costs[servo] < costs[best] { servo } else { best });
            // The grid is logarithmic, with two servos for a factor of 2.
            let along = servo as f64 + vertex(servo, SERVOS.len(), |servo| costs[servo]) - STATED as f64;
            let ratio = math::powf(2.0, along / 2.0);
            let ratio = if ratio < LEAST_RATIO && ratio * LEAST_RATIO > 1.0 { 1.0 } else { ratio };
            let servo = ratio * self.stated[kind];
            self.is_settled &= (servo - self.servos[kind]).abs() < SETTLED.1 * servo;
            self.servos[kind] += (servo - self.servos[kind]) * share;
            let ratio = self.servos[kind] / self.stated[kind];
            let off = |index: usize| (SERVOS[index] - ratio).abs();
            self.nearest[kind] =
                (0..SERVOS.len()).fold(STATED, |best, servo| if off(servo) < off(best) { servo } else { best });
        }
    }

    /// True if delay and servos hardly change any more.
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
        self.motion(to) - self.motion(from)
    }

    /// The expected motion up to `ago` (s) before the newest step, interpolated between steps.
    fn motion(&self, ago: f64) -> Motion {
        let along = (ago / self.step).clamp(0.0, (MEMORY - 2) as f64);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the memory")]
        let whole = along as usize;
        let [servo, yaw_servo] = self.nearest;
        let at = |step: usize| {
            let [x, y, turn] = &self.motions[earlier(self.newest, step)];
            Motion::new(x[servo], y[servo], turn[yaw_servo])
        };
        at(whole).lerp(&at(whole + 1), along - whole as f64)
    }
}

/// True if the `least` sum of squared differences (m²) shows that the delay or a servo is not the stated one, which leaves
/// `stated`. It must also explain what the platform has `moved` (m²), because one that stands still at a wall from the start looks like
/// one that begins to move slowly.
fn is_shown(least: f64, stated: f64, moved: f64) -> bool {
    stated >= LEAST_COST && least <= MOST_LEFT * math::min(stated, moved)
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
        fn the_delay_and_both_servos_are_found(
            commands in commands(), delay in 0.02..0.12_f64, servo in 0.02..0.7_f64, yaw_servo in 0.02..0.7_f64,
        ) {
            let platform = measured(&Rig::default(), &commands, delay, Motion::new(servo, servo, yaw_servo));
            let found = platform.servos().unwrap_or(Rig::default().platform.servos());
            prop_assert!((platform.delay() - delay).abs() < 0.015, "{} s, {delay} s", platform.delay());
            for (found, servo) in [(found.x, servo), (found.z, yaw_servo)] {
                // A servo that is faster than a tick looks like a delay. The grid has two servos for a factor of 2.
                if servo > 0.034 {
                    prop_assert!((0.75..1.3).contains(&(found / servo)), "{found} s, {servo} s");
                }
                if servo < 0.225 {
                    prop_assert!((platform.delay() + found - delay - servo).abs() < 0.02, "{found} s, {servo} s");
                }
            }
        }

        #[test]
        fn a_platform_as_stated_is_left_as_it_is(commands in commands()) {
            let rig = Rig::default();
            let platform = measured(&rig, &commands, 0.0, rig.platform.servos());
            prop_assert_eq!(platform.delay().to_bits(), 0.0_f64.to_bits());
            prop_assert_eq!(platform.servos(), None);
        }
    }
}
