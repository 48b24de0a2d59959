//! Commands for a platform whose servos are slower or faster than policies expect.

use nalgebra::Vector3;

use crate::math;
use crate::rig::Rig;
use crate::signal::Command;

/// Changes commands so that the platform moves as one with the expected servos would. Those are the stated ones, but at most
/// 50 ms.
///
/// A servo with the time constant `T` follows a command `u` by `T v' = u - v`. For a slower servo, the command therefore
/// goes beyond the wanted speed while this changes.
#[derive(Debug, Clone)]
pub struct ServoLead {
    /// Expected time constants of the servos (s): x, y, yaw. And the control period (s).
    expected: Vector3<f64>,
    period: f64,
    /// Speed (m/s) and yaw rate (rad/s) that the platform cannot exceed.
    limits: (f64, f64),
    /// Speed of the expected platform and of the actual one: x, y (m/s), yaw rate (rad/s).
    wanted: Vector3<f64>,
    actual: Vector3<f64>,
}

/// Largest time constant (s) that policies expect. It is that of the reference platform, on which their gains were chosen. A
/// policy for a slower platform would need other gains, and this lead makes them unnecessary as far as the limits of speed
/// allow.
const EXPECTED: f64 = 0.05;

impl ServoLead {
    /// Creates it for the platform of `rig`, at rest.
    #[must_use]
    pub fn new(rig: &Rig) -> Self {
        Self {
            expected: rig.platform.servos().map(|stated| math::min(stated, EXPECTED)),
            period: rig.sensing.control_rate.recip(),
            limits: (rig.platform.speed_limit, rig.platform.yaw_rate_limit),
            wanted: Vector3::zeros(),
            actual: Vector3::zeros(),
        }
    }

    /// Returns the command for `servos`, the time constants (s) of x, y and yaw. With the expected ones it is `command` itself.
    pub fn next(&mut self, command: Command, servos: Vector3<f64>) -> Command {
        let aim = command.velocity_world.push(command.yaw_rate);
        let [expected_left, left] =
            [self.expected, servos].map(|times| times.map(|time| math::exp(-self.period / time)));
        let [expected_gone, gone] = [expected_left, left].map(|left| left.map(|left| 1.0 - left));
        self.wanted = self.wanted.component_mul(&expected_left) + aim.component_mul(&expected_gone);
        let is_expected = (servos - self.expected).amax() < f64::EPSILON;
        let changed =
            if is_expected { aim } else { (self.wanted - self.actual.component_mul(&left)).component_div(&gone) };
        let (speed, yaw_rate) = (changed.xy().norm(), changed.z);
        let slower = if speed > self.limits.0 { self.limits.0 / speed } else { 1.0 };
        let lead =
            Command { velocity_world: changed.xy() * slower, yaw_rate: yaw_rate.clamp(-self.limits.1, self.limits.1) };
        let lead = if is_expected { command } else { lead };
        let given = lead.velocity_world.push(lead.yaw_rate);
        self.actual = self.actual.component_mul(&left) + given.component_mul(&gone);
        lead
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_platform_with_other_servos_moves_as_the_expected_one(
            commands in prop::collection::vec((-0.05..0.05_f64, -0.5..0.5_f64), 1..60), stated in 0.02..0.3_f64,
            yaw_stated in prop::option::of(0.02..0.3_f64), ratio in 0.3..4.0_f64, yaw_ratio in 0.3..4.0_f64,
        ) {
            let mut rig = Rig::default();
            (rig.platform.servo, rig.platform.yaw_servo) = (stated, yaw_stated);
            // Within these limits, no command is too large for the slowest platform.
            (rig.platform.speed_limit, rig.platform.yaw_rate_limit) = (10.0, 100.0);
            let expected = rig.platform.servos().map(|stated| math::min(stated, 0.05));
            let servos = expected.component_mul(&Vector3::new(ratio, ratio, yaw_ratio));
            let period = rig.sensing.control_rate.recip();
            let mut lead = ServoLead::new(&rig);
            let (mut actual, mut wanted) = ([0.0; 2], [0.0; 2]);
            for (speed, yaw_rate) in commands {
                let command = Command { velocity_world: nalgebra::Vector2::new(speed, -speed), yaw_rate };
                let given = lead.next(command, servos);
                for _ in 0..1000 {
                    let step = period / 1000.0;
                    actual[0] += (given.velocity_world.x - actual[0]) * step / servos.x;
                    actual[1] += (given.yaw_rate - actual[1]) * step / servos.z;
                    wanted[0] += (speed - wanted[0]) * step / expected.x;
                    wanted[1] += (yaw_rate - wanted[1]) * step / expected.z;
                }
                prop_assert!((actual[0] - wanted[0]).abs() < 1e-3 && (actual[1] - wanted[1]).abs() < 1e-2);
            }
        }

        #[test]
        fn commands_are_within_the_limits_and_those_for_expected_servos_are_the_same(
            commands in prop::collection::vec((-1.0..1.0_f64, -3.0..3.0_f64), 1..30), ratio in 0.1..20.0_f64,
            yaw_ratio in 0.1..20.0_f64, stated in 0.01..0.05_f64,
        ) {
            let mut rig = Rig::default();
            rig.platform.servo = stated;
            let expected = rig.platform.servos();
            let servos = expected.component_mul(&Vector3::new(ratio, ratio, yaw_ratio));
            let (mut lead, mut same) = (ServoLead::new(&rig), ServoLead::new(&rig));
            for (speed, yaw_rate) in commands {
                let command = Command { velocity_world: nalgebra::Vector2::new(speed, 0.0), yaw_rate };
                let given = lead.next(command, servos);
                prop_assert!(given.velocity_world.norm() <= rig.platform.speed_limit + 1e-12);
                prop_assert!(given.yaw_rate.abs() <= rig.platform.yaw_rate_limit);
                prop_assert_eq!(same.next(command, expected), command);
            }
        }
    }
}
