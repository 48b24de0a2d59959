//! The error of a tip that the errors of a calibration cause.

use std::sync::Arc;

use nalgebra::{SMatrix, SVector};

use crate::calibration::Parameter;
use crate::geometry::{Vector2, perpendicular, unit};
use crate::math;
use crate::rig::{Sensing, Whisker};

use super::tip_table::{TipPosition, TipTable};

/// The error of a tip that the errors of a whisker's measured parameters cause, to first order.
#[derive(Debug, Clone)]
pub(super) struct TipBias {
    covariance: SMatrix<f64, { Parameter::KEPT }, { Parameter::KEPT }>,
    /// Variance (rad²) of the offset that is estimated during the run, beyond that in the covariance.
    offset_variance: f64,
    length: f64,
    direction_body: f64,
    /// The tips of the whisker, of one that is more curved, and of one that is more tapered, for bends to the left.
    table: Arc<TipTable>,
    curved: Arc<TipTable>,
    tapered: Arc<TipTable>,
}

/// Differences of curvature (1/m) and taper for derivatives.
const CURVATURE: f64 = 0.02;
const TAPER: f64 = -0.005;
/// Least standard deviation (rad) of an offset that is estimated during the run.
const ESTIMATED_OFFSET: f64 = 5e-7;

impl TipBias {
    /// Creates the errors of a whisker as perception models it. `None` if its parameters were not measured.
    pub(super) fn new(whisker: &Whisker, sensing: &Sensing) -> Option<Self> {
        let measured = whisker.calibration.as_ref()?.measured.as_ref()?;
        let mut curved = whisker.clone();
        curved.shaft.curvature += CURVATURE;
        let mut tapered = whisker.clone();
        tapered.shaft.tip_radius = Some(whisker.shaft.radius * (whisker.shaft.taper() + TAPER));
        let mut covariance = SMatrix::<f64, { Parameter::KEPT }, { Parameter::KEPT }>::from_fn(|row, column| {
            measured.covariance[row][column]
        });
        let offset = Parameter::Offset.index();
        if sensing.estimation.offset && covariance[(offset, offset)] > math::square(ESTIMATED_OFFSET) {
            let share = ESTIMATED_OFFSET / covariance[(offset, offset)].sqrt();
            covariance.row_mut(offset).scale_mut(share);
            covariance.column_mut(offset).scale_mut(share);
        }
        Some(Self {
            covariance,
            offset_variance: 0.0,
            length: whisker.shaft.length,
            direction_body: whisker.direction_body,
            table: TipTable::shared(whisker),
            curved: TipTable::shared(&curved),
            tapered: TipTable::shared(&tapered),
        })
    }

    /// Sets the standard deviation (rad) of the offset that is estimated during the run.
    pub(super) fn set_offset_deviation(&mut self, deviation: f64) {
        self.offset_variance = math::max(math::square(deviation) - math::square(ESTIMATED_OFFSET), 0.0);
    }

    /// Standard deviation of the surface at the tip (m, along its normal). The directions `force` and `normal` (rad) are
    /// those in the frame of the base for a bend to the left, as `tip` is. `bend_sign` is −1 for a mirrored contact.
    pub(super) fn deviation(
        &self,
        base_angle: f64,
        bend_sign: f64,
        [force, normal]: [f64; 2],
        tip: &TipPosition,
    ) -> f64 {
        let across: Vector2 = unit(normal);
        // Another shaft at the same reading.
        let other = |table: &TipTable, difference: f64| {
            let tips = [table, &self.table].map(|table| table.at(base_angle, force));
            let [Some(other), Some(own)] = tips else { return 0.0 };
            across.dot(&(other.tip_base - own.tip_base)) / difference
        };
        let by_angle = across.dot(&tip.by_angle);
        let base = unit(self.direction_body + bend_sign * normal);
        let mut slope = SVector::<f64, { Parameter::KEPT }>::zeros();
        let mut set = |parameter: Parameter, value: f64| slope[parameter.index()] = value;
        // The moment is the base angle times the stiffness. A longer shaft is a magnified one under a larger moment.
        set(Parameter::Stiffness, by_angle * base_angle);
        set(Parameter::Length, (across.dot(&tip.tip_base) + by_angle * base_angle) / self.length);
        set(Parameter::Direction, bend_sign * across.dot(&(perpendicular(tip.tip_base) - tip.by_direction)));
        set(Parameter::BaseX, base.x);
        set(Parameter::BaseY, base.y);
        set(Parameter::Curvature, bend_sign * other(&self.curved, CURVATURE));
        set(Parameter::Taper, other(&self.tapered, TAPER));
        set(Parameter::Offset, -bend_sign * by_angle);
        // Friction turns the force by its angle.
        set(Parameter::Friction, -across.dot(&tip.by_direction) / (1.0 + math::square(math::tan(normal - force))));
        let offset = slope[Parameter::Offset.index()];
        math::max(slope.dot(&(self.covariance * slope)) + math::square(offset) * self.offset_variance, 0.0).sqrt()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use std::f64::consts::PI;

    use super::*;
    use crate::calibration::{Calibration, MeasuredWhisker};
    use crate::geometry::rotate;
    use crate::rig::Rig;

    /// A whisker with the parameters of the rig and the variance of one of them.
    fn measured(whisker: &Whisker, only: usize, deviation: f64) -> Whisker {
        let mut covariance = [[0.0; Parameter::KEPT]; Parameter::KEPT];
        covariance[only][only] = deviation * deviation;
        let measured = MeasuredWhisker {
            hinge_stiffness: whisker.hinge.stiffness,
            length: whisker.shaft.length,
            direction: whisker.direction_body,
            base: whisker.base_body.into(),
            curvature: whisker.shaft.curvature,
            taper: whisker.shaft.taper(),
            offset: 0.0,
            friction: 0.0,
            covariance,
        };
        let calibration = Calibration { measured: Some(measured), ..Calibration::new(String::new()) };
        Whisker { calibration: Some(calibration), ..whisker.clone() }
    }

    /// The tip (m, body frame) of a whisker at a reading, on a surface with this normal (rad, body frame).
    fn tip_body(whisker: &Whisker, [offset, friction]: [f64; 2], reading: f64, normal: f64) -> Vector2 {
        let (base_angle, side) = (reading - offset, reading.signum());
        let seen = if side < 0.0 { whisker.mirrored() } else { whisker.clone() };
        let force = (side * (normal - whisker.direction_body)).rem_euclid(2.0 * PI) - math::atan(friction);
        let tip = TipTable::new(&seen).at(base_angle.abs(), force).unwrap().tip_base;
        whisker.base_body.coords + rotate(Vector2::new(tip.x, side * tip.y), whisker.direction_body)
    }

    #[test]
    fn the_bias_of_each_parameter_is_the_motion_of_the_tip_that_it_causes() {
        let steps = [1e-3, 5e-5, 1e-3, 1e-4, 1e-4, 0.02, -1e-3, 1e-7, 1e-3];
        for (whisker, reading) in
            Rig::default().whiskers.iter().flat_map(|whisker| [(whisker, 3e-4_f64), (whisker, -2e-4)])
        {
            let side = reading.signum();
            let normal = 2.4;
            let normal_body = whisker.direction_body + side * normal;
            let tip = TipTable::new(whisker).at(reading.abs(), normal).unwrap();
            for (index, step) in steps.into_iter().enumerate() {
                let mut other = whisker.clone();
                let (mut offset, mut friction) = (0.0, 0.0);
                match Parameter::ALL[index] {
                    Parameter::Stiffness => other.hinge.stiffness *= 1.0 + step,
                    Parameter::Length => other.shaft.length += step,
                    Parameter::Direction => other.direction_body += step,
                    Parameter::BaseX => other.base_body.x += step,
                    Parameter::BaseY => other.base_body.y += step,
                    Parameter::Curvature => other.shaft.curvature += step,
                    Parameter::Taper => other.shaft.tip_radius = Some(other.shaft.radius * (1.0 + step)),
                    Parameter::Offset => offset = step,
                    _ => friction = step,
                }
                let moved = tip_body(&other, [offset, friction], reading, normal_body)
                    - tip_body(whisker, [0.0; 2], reading, normal_body);
                let expected = moved.dot(&unit(normal_body)).abs();
                let bias = TipBias::new(&measured(whisker, index, step.abs()), &Rig::default().sensing).unwrap();
                let found = bias.deviation(reading.abs(), side, [normal, normal], &tip);
                let name = Parameter::ALL[index].name();
                assert!((found - expected).abs() < 0.03 * expected + 1e-9, "{name} {reading}: {found} {expected}");
            }
        }
    }

    #[test]
    fn an_offset_that_is_less_and_less_known_moves_the_tip_by_as_much() {
        let rig = Rig::default();
        let whisker = &rig.whiskers[0];
        let tip = TipTable::new(whisker).at(3e-4, 2.4).unwrap();
        let mut bias = TipBias::new(&measured(whisker, Parameter::Offset.index(), 0.0), &rig.sensing).unwrap();
        let deviation = |bias: &TipBias| bias.deviation(3e-4, 1.0, [2.4; 2], &tip);
        // What the covariance of the calibration has is not counted twice.
        bias.set_offset_deviation(ESTIMATED_OFFSET);
        assert!(deviation(&bias) < 1e-12);
        let unknown = 4e-6;
        bias.set_offset_deviation(math::hypot(unknown, ESTIMATED_OFFSET));
        let moved = tip_body(whisker, [unknown, 0.0], 3e-4, whisker.direction_body + 2.4)
            - tip_body(whisker, [0.0; 2], 3e-4, whisker.direction_body + 2.4);
        let expected = moved.dot(&unit(whisker.direction_body + 2.4)).abs();
        assert!((deviation(&bias) - expected).abs() < 0.03 * expected, "{} {expected}", deviation(&bias));
    }
}
