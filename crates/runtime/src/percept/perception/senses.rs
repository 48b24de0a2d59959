//! The values of perception that policies read.

use super::Perception;
use crate::geometry::Vector2;
use crate::machine::{BodyScalar, ContourVector, Mark, Senses, WhiskerScalar, WhiskerVector};
use crate::math;

/// A vector of a contour that has none.
const UNDEFINED: Vector2 = Vector2::new(f64::NAN, f64::NAN);

impl Senses for Perception {
    fn time(&self) -> f64 {
        self.time
    }

    fn body(&self, quantity: BodyScalar) -> f64 {
        match quantity {
            BodyScalar::Yaw => self.at_effect.heading,
            BodyScalar::Blocked => f64::from(u8::from(self.disturbance.is_blocked())),
            BodyScalar::Shortfall => self.disturbance.shortfall(),
            BodyScalar::Length => self.platform.length,
            BodyScalar::Width => math::max(self.platform.nose_width, self.platform.tail_width),
            BodyScalar::NoseWidth => self.platform.nose_width,
            BodyScalar::TailWidth => self.platform.tail_width,
            BodyScalar::NoseReach => self.platform.length - self.platform.centre_of_mass,
            BodyScalar::Flexibility => self.flexibility,
            BodyScalar::Decay => self.decay,
            BodyScalar::Sway => self.sway,
        }
    }

    fn body_position(&self) -> Vector2 {
        self.at_effect.position.coords
    }

    fn whisker(&self, index: usize, quantity: WhiskerScalar) -> f64 {
        let truth = |truth: bool| f64::from(u8::from(truth));
        let whisker = || &self.whiskers[index];
        match quantity {
            WhiskerScalar::BaseAngle => whisker().base_angle(),
            WhiskerScalar::Touching => truth(whisker().is_touching()),
            WhiskerScalar::Yaw => whisker().base_at_effect.heading,
            WhiskerScalar::Side => whisker().side,
            WhiskerScalar::Sense if whisker().is_touching() => whisker().base_angle().signum() * whisker().side,
            WhiskerScalar::Sense => 0.0,
            WhiskerScalar::Length => whisker().length,
            WhiskerScalar::ContourReady => truth(self.contour(index).is_current()),
            WhiskerScalar::ContourCurvature => self.contour(index).local().curvature().unwrap_or(f64::NAN),
            WhiskerScalar::TipDeviation => whisker().tip_deviation(),
            WhiskerScalar::Fitted => truth(self.in_sample[index].is_some()),
            WhiskerScalar::BaseAngleDeviation => whisker().base_angle_deviation(),
            WhiskerScalar::RecordedDeviation => whisker().recorded_deviation(),
        }
    }

    fn whisker_vector(&self, index: usize, quantity: WhiskerVector) -> Vector2 {
        let whisker = || &self.whiskers[index];
        match quantity {
            WhiskerVector::Tip => whisker().tip_world().coords,
            WhiskerVector::TipBase => whisker().tip_base(),
            WhiskerVector::Base => whisker().base_at_effect.position.coords,
            WhiskerVector::ContourTangent => self.contour(index).local().tangent().unwrap_or(UNDEFINED),
            WhiskerVector::ContourNormal => self.contour(index).at(0.0, ContourVector::Normal).unwrap_or(UNDEFINED),
            WhiskerVector::ContourEnd => self.contour(index).local().newest().map_or(UNDEFINED, |point| point.coords),
        }
    }

    fn tip_at(&self, whisker: usize, base_angle: f64) -> Vector2 {
        self.whiskers[whisker].tip_at(base_angle)
    }

    fn loop_closed(&self, whisker: usize, within: f64, after: f64) -> bool {
        self.loops[whisker].is_closed(within, after)
    }

    fn contour_at(&self, contour: usize, back: f64, quantity: ContourVector) -> Vector2 {
        self.contour(contour).at(back, quantity).unwrap_or(UNDEFINED)
    }

    fn record(&mut self, whisker: usize) {
        self.whiskers[whisker].record();
    }

    fn record_position(&mut self, contour: usize, position: Vector2) {
        self.contours[contour].record(Some(position.into()), None);
    }

    fn mark(&mut self, whisker: usize, mark: Mark) {
        self.whiskers[whisker].mark(mark);
    }
}
