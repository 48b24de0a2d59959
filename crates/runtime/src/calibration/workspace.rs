//! The error of tips due to the errors of a whisker's parameters.

use std::f64::consts::PI;

use crate::geometry::{Point2, Vector2, unit};
use crate::mechanics::{Elastica, Obstacle, Touch, TouchMechanics};
use crate::rig::Whisker;

use super::parameters::{self, Parameter, ParameterCovariance, Parameters};
use super::touch_fit::{Predicted, TouchNoise};

/// Tip contacts that a whisker has during contour following, and their dependence on its parameters.
#[derive(Debug, Clone)]
pub(super) struct Workspace {
    /// Derivatives of the position of the surface (m, along its normal), as perception estimates it from a reading, by
    /// the parameters.
    slopes: Vec<Parameters>,
}

/// Base angles of the contacts, in the unit of the mechanics. The usual target is 1.6.
const LEVELS: [f64; 4] = [0.5, 1.0, 1.6, 2.2];
/// Directions (rad) of the normals, from that of the surface which a policy follows.
const TURNS: [f64; 4] = [-50.0 * PI / 180.0, -30.0 * PI / 180.0, -15.0 * PI / 180.0, 0.0];

impl Workspace {
    /// Creates the contacts of a whisker of the rig that has these parameters.
    pub(super) fn new(whisker: &Whisker, at: &Parameters) -> Self {
        let (side, base, tip_radius) = (whisker.side(), whisker.base_pose(), whisker.shaft.radius_at(1.0));
        let elastica = Elastica::new(whisker);
        let level = TouchMechanics::new(whisker, 0.0).angle_unit();
        let contact = |normal: f64, base_angle: f64| {
            let tip = elastica.solve_tip(base_angle, normal, &elastica.straight())?.tip_base;
            let on_face = tip - tip_radius * unit(normal);
            let point = base.point_to_world(Point2::new(on_face.x, side * on_face.y));
            let face = Obstacle::Face { point, normal: base.heading + side * normal };
            let (mechanics, seen) = parameters::mechanics(whisker, at, &face);
            let touch = mechanics.press(&seen, side)?;
            let predicted = Predicted::of(whisker, at, &face, &touch, side, &TouchNoise::default())?;
            let by_advance = by_advance(whisker, at, &face, &touch)?;
            Some(predicted.slope * -by_advance.recip())
        };
        let normals = TURNS.map(|turn| whisker.usual_normal() + turn);
        let slopes = normals.iter().flat_map(|&normal| LEVELS.map(|share| contact(normal, share * level)));
        Self { slopes: slopes.flatten().collect() }
    }

    /// Root mean square of the standard deviations of the tips (m, along the normal) for a covariance of the
    /// parameters. Infinite without a contact.
    pub(super) fn deviation(&self, covariance: &ParameterCovariance) -> f64 {
        let variances = self.slopes.iter().map(|slope| {
            let known = of_whisker(slope);
            known.dot(&(covariance * known))
        });
        if self.slopes.is_empty() {
            return f64::INFINITY;
        }
        (variances.sum::<f64>() / self.slopes.len() as f64).sqrt()
    }

    /// Root mean square of the errors of the tips (m, along the normal) that a difference of the parameters causes.
    #[cfg(test)]
    pub(super) fn error(&self, difference: &Parameters) -> f64 {
        let squares = self.slopes.iter().map(|slope| {
            let error = of_whisker(slope).dot(difference);
            error * error
        });
        (squares.sum::<f64>() / self.slopes.len().max(1) as f64).sqrt()
    }
}

/// Derivatives by the whisker's own parameters alone. Friction belongs to the known object, and a firm hinge has no play.
fn of_whisker(slope: &Parameters) -> Parameters {
    let mut known = Parameters::zeros();
    for index in 0..Parameter::WHISKER {
        known[index] = slope[index];
    }
    known
}

/// Derivative of the base angle (rad/m) by an advance of a face along its normal.
fn by_advance(whisker: &Whisker, at: &Parameters, face: &Obstacle, touch: &Touch) -> Option<f64> {
    const ADVANCE: f64 = 1e-6;
    let Obstacle::Face { point, normal } = *face else { return None };
    let moved = |by: f64| Obstacle::Face { point: point + by * Vector2::from(unit(normal)), normal };
    let [(low, seen), (high, also_seen)] = [-ADVANCE, ADVANCE].map(|by| parameters::mechanics(whisker, at, &moved(by)));
    Some(TouchMechanics::change(touch, [(&low, &seen), (&high, &also_seen)])? / (2.0 * ADVANCE))
}
