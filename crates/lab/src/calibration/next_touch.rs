//! The next touch of a pin by an array that somebody else moves.

use vibrissa_runtime::calibration::{PlannedTouch, TouchFit, TouchNoise, TouchPlan, TouchReading};
use vibrissa_runtime::mechanics::Obstacle;
use vibrissa_runtime::rig::Whisker;

use super::touch_procedure::{CLEARANCE, EXPECTED_DEVIATION, Pin, TouchLimits};
use vibrissa_world::geometry::{Point2, Pose, rotate};

/// The next touch of a pin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NextTouch {
    /// The touch in the frame of the base that the rig assumes.
    pub planned: PlannedTouch,
    /// Pose of the platform (world frame) with the pin beside the straight whisker, where it is read in the air.
    pub in_air: Pose,
    /// Pose of the platform (world frame) in the touch.
    pub touch: Pose,
    /// Standard deviation of tips (m) before the touch.
    pub tip_deviation: f64,
    pin: Pin,
}

impl NextTouch {
    /// The next touch of a whisker of a rig after these `readings`, on a platform with a constant heading (rad, world frame). Touches
    /// like the `missed` ones, in which the whisker slipped off, are left out. `None` if the readings suffice for the limits, or if no
    /// touch is possible.
    #[must_use]
    pub fn of(
        whisker: &Whisker,
        readings: &[TouchReading],
        missed: &[PlannedTouch],
        noise: &TouchNoise,
        (pin, heading): (Pin, f64),
        limits: &TouchLimits,
    ) -> Option<Self> {
        let plan = TouchPlan::new(whisker, pin.radius, EXPECTED_DEVIATION, noise);
        let fit = TouchFit::new(whisker, readings, noise).unwrap_or_else(|| TouchFit::untouched(whisker));
        let tip_deviation = plan.tip_deviation(&fit);
        if readings.len() + missed.len() >= limits.touches || tip_deviation < limits.deviation {
            return None;
        }
        let planned = plan.next(&fit, missed)?;
        let body = |pin_base: Point2| {
            let pin_body = whisker.base_pose().point_to_world(pin_base);
            Pose { position: pin.centre - rotate(pin_body.coords, heading), heading }
        };
        let beside = Point2::new(planned.pin_base.x, -planned.side * (pin.radius + CLEARANCE));
        Some(Self { planned, in_air: body(beside), touch: body(planned.pin_base), tip_deviation, pin })
    }

    /// The reading (rad) of the touch, with that in the air and the standard deviation of the difference of both.
    #[must_use]
    pub fn reading(&self, base_angle: f64, in_air: f64, deviation: f64) -> TouchReading {
        TouchReading {
            body: self.touch,
            obstacle: Obstacle::Pin { centre: self.pin.centre, radius: self.pin.radius },
            is_known: true,
            side: self.planned.side,
            base_angle,
            in_air,
            deviation,
        }
    }

    /// The touch as one in which the whisker met nothing, or slipped off.
    #[must_use]
    pub fn missed(&self) -> MissedTouch {
        MissedTouch { body: self.touch, pin: self.pin, side: self.planned.side }
    }
}

/// A touch in which the whisker met nothing, or slipped off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MissedTouch {
    /// Pose of the platform (world frame).
    pub body: Pose,
    /// The pin (world frame).
    pub pin: Pin,
    /// +1 if the pin should have bent the whisker to the left, −1 if to the right.
    pub side: f64,
}

impl MissedTouch {
    /// The touch in the frame of the base of this whisker. Nothing bent it.
    #[must_use]
    pub fn planned(&self, whisker: &Whisker) -> PlannedTouch {
        let pin_body = Point2::from(rotate(self.pin.centre - self.body.position, -self.body.heading));
        PlannedTouch { pin_base: whisker.base_pose().point_from_world(pin_body), side: self.side, base_angle: 0.0 }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use vibrissa_runtime::calibration::Parameter;
    use vibrissa_runtime::mechanics::TouchMechanics;
    use vibrissa_runtime::rig::Rig;

    use super::*;

    /// The fit after the planned touches, and their number. The readings are those of the mechanics of a whisker that differs from the
    /// rig, on a platform that takes the planned poses exactly.
    fn touched(rig: &Rig, truth: &Whisker, noise: TouchNoise) -> (TouchFit, usize) {
        let (pin, heading) = (Pin { centre: Point2::new(0.2, -0.1), radius: 10e-3 }, 0.7);
        let limits = TouchLimits::default();
        let (mut readings, mut missed) = (Vec::new(), Vec::new());
        while let Some(next) = NextTouch::of(&rig.whiskers[0], &readings, &missed, &noise, (pin, heading), &limits) {
            let pin_of = |pose: Pose| {
                let pin_body = rotate(pin.centre - pose.position, -pose.heading);
                Point2::from(rotate(pin_body - truth.base_body.coords, -truth.direction_body))
            };
            let in_air = pin_of(next.in_air);
            assert!(next.planned.side * in_air.y < -pin.radius, "the pin is beside the whisker: {in_air}");
            let obstacle = Obstacle::Pin { centre: pin_of(next.touch), radius: pin.radius };
            match TouchMechanics::new(truth, 0.0).press(&obstacle, next.planned.side) {
                Some(touch) => readings.push(next.reading(touch.base_angle + 2e-6, 2e-6, 1e-7)),
                None => missed.push(next.planned),
            }
        }
        (TouchFit::new(&rig.whiskers[0], &readings, &noise).unwrap(), readings.len() + missed.len())
    }

    #[test]
    fn a_whisker_that_somebody_else_moves_is_known_after_the_planned_touches() {
        let rig = Rig::default();
        let mut truth = rig.whiskers[0].clone();
        truth.shaft.length += 0.4e-3;
        truth.direction_body += 0.8_f64.to_radians();
        truth.base_body.x += 0.3e-3;
        let limits = TouchLimits::default();
        // The errors of a ruler and of a stage. Only a stage knows its poses well enough for the limit.
        let [ruler, stage] = [TouchNoise::default(), TouchNoise { position: 2e-5, heading: 1.4e-4 }];
        for (noise, suffices) in [(ruler, false), (stage, true)] {
            let (fit, count) = touched(&rig, &truth, noise);
            assert!((5..=limits.touches).contains(&count), "{count} touches");
            let deviation = fit.tip_deviation();
            assert_eq!(deviation < 1.05 * limits.deviation, suffices, "{deviation} m after {count} touches");
            assert_eq!(count < limits.touches, suffices, "{deviation} m after {count} touches");
            let wanted = [(Parameter::Length, 0.4e-3), (Parameter::Direction, 0.8_f64.to_radians())];
            for (parameter, wanted) in wanted {
                let index = parameter.index();
                let (found, deviation) = (fit.parameters[index], fit.covariance[(index, index)].sqrt());
                assert!(
                    (found - wanted).abs() < 4.0 * deviation,
                    "{parameter:?}: {found} for {wanted}, within {deviation}"
                );
            }
        }
    }
}
