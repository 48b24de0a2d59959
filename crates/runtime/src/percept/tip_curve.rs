//! Where a whisker's tip touches, from its base angle alone.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Matrix2, Vector2};

use crate::calibration::ContactCurve;
use crate::geometry::rotate;
use crate::mechanics::ShaftChain;
use crate::rig::Whisker;

/// The curve on which the tip touches: from the base angle alone to a place.
///
/// The base angle alone does not fix the tip; the direction of the contact force matters too. The curve takes the direction
/// that it has while the platform swipes along a surface parallel to its heading, and is exact there; it is about 0.2 mm
/// off for every degree between the surface and the heading. A bend the other way is taken to be the mirror image.
///
/// The curve is fitted to the mechanics of the whisker's own chain: solutions at equal steps of the base angle, joined by
/// cubics that match them and their slopes.
#[derive(Debug, Clone)]
pub struct TipCurve {
    step: f64,
    /// The least base angle of which something is known (rad).
    least: f64,
    /// Places of contact for base angles 0, `step`, 2 `step`, …
    knots: Vec<Knot>,
}

#[derive(Debug, Clone, Copy)]
struct Knot {
    contact_base: Vector2<f64>,
    /// Change of the place for one step of the base angle.
    slope: Vector2<f64>,
    /// Covariance of the place (m²) by what the base angle does not tell.
    unknown: Matrix2<f64>,
}

/// Why a whisker has no tip model.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TipCurveError {
    /// The whisker stands too nearly across the heading.
    #[error(
        "whisker {whisker} meets the force of a surface beside it {:.0} deg from head-on, and might buckle either way; sweep it by \
         {:.0} deg or more, and back if there is friction",
        sweep.to_degrees(), LEAST_SWEEP.to_degrees().ceil()
    )]
    HeadOn {
        /// The whisker.
        whisker: String,
        /// Its sweep back, or forward if negative (rad), with the angle by which friction turns the force.
        sweep: f64,
    },
    /// The chain has no equilibrium where the model needs one.
    #[error(
        "whisker {whisker}: the shaft has no equilibrium beyond a base angle of {:.0} urad; make the shaft softer or the hinge stiffer",
        base_angle * 1e6
    )]
    NoEquilibrium {
        /// The whisker.
        whisker: String,
        /// The base angle (rad).
        base_angle: f64,
    },
}

/// Greatest base moment of the model, in units of `EI / L`, of as much less as the shaft tapers; the reference target is 1.6
/// of them.
const MOMENT_RANGE: f64 = 6.0;
/// Steps of the base angle.
const STEPS: usize = 120;
/// The least angle (rad) between the undeflected shaft and the normal of the surface: a shaft that meets a surface head-on
/// may buckle to either side, so that no model can know.
const LEAST_SWEEP: f64 = 0.087;

/// The small turn of the surface (rad), away from head-on, by which the model finds what a turn does.
const TURN: f64 = 0.01;
/// How far off a surface is from the direction that the model takes it to have (rad): a standard deviation. Swiping keeps the
/// heading within about this of a surface that bends, and knows nothing of it at the first touch.
const SURFACE_DEVIATION: f64 = 10.0 * PI / 180.0;

impl TipCurve {
    /// The curve of `whisker` on surfaces without friction.
    ///
    /// # Errors
    /// As [`with_friction`](Self::with_friction).
    pub fn new(whisker: &Whisker) -> Result<Self, TipCurveError> {
        Self::with_friction(whisker, 0.0)
    }

    /// The curve of `whisker` on surfaces on which it slides forward with a coefficient of friction.
    ///
    /// # Errors
    /// [`TipCurveError`] when the whisker sticks rather than slides, or its chain has no equilibrium somewhere in the model's
    /// range.
    pub fn with_friction(whisker: &Whisker, friction: f64) -> Result<Self, TipCurveError> {
        let chain = ShaftChain::new(whisker);
        let (force_direction, normal_direction) = Self::directions(whisker, friction)?;
        let shaft = &whisker.shaft;
        let step = MOMENT_RANGE * shaft.tip_stiffness() / shaft.length / whisker.hinge.stiffness / STEPS as f64;
        let normal = Vector2::new(normal_direction.cos(), normal_direction.sin());
        let tip_radius = shaft.radius_at(1.0);

        let (mut contacts, mut unknowns) = (Vec::with_capacity(STEPS + 1), Vec::with_capacity(STEPS + 1));
        let mut solution = chain.straight();
        let mut before = solution;
        for index in 0..=STEPS {
            let base_angle = step * index as f64;
            let mut guess = solution;
            // Straight on from the last two solutions; the first step is that of a cantilever under a small force.
            if index == 1 {
                guess.force = base_angle * whisker.hinge.stiffness / (shaft.length * force_direction.sin());
                guess.tip_angle =
                    guess.force * force_direction.sin() * shaft.length.powi(2) / (2.0 * shaft.tip_stiffness());
            } else if index > 1 {
                guess.force += solution.force - before.force;
                guess.tip_angle += solution.tip_angle - before.tip_angle;
            }
            if index > 0 {
                before = solution;
                solution = chain
                    .solve(base_angle, force_direction, &guess)
                    .ok_or_else(|| TipCurveError::NoEquilibrium { whisker: whisker.name.clone(), base_angle })?;
            }
            // The tip is a half sphere of the wire's radius; it touches on the side that the force comes from.
            let contact = solution.tip_base - tip_radius * normal;
            let turned = chain
                .solve(base_angle, force_direction - TURN, &solution)
                .ok_or_else(|| TipCurveError::NoEquilibrium { whisker: whisker.name.clone(), base_angle })?;
            let turned_contact = turned.tip_base - tip_radius * rotate(normal, -TURN);
            contacts.push(contact);
            let off = (turned_contact - contact) * (SURFACE_DEVIATION / TURN);
            unknowns.push(off * off.transpose());
        }
        Ok(Self { step, least: 0.0, knots: knots(&contacts, &unknowns) })
    }

    /// The curve that was measured.
    #[must_use]
    pub fn calibrated(measured: &ContactCurve) -> Self {
        let [least, range] = measured.range;
        let step = range / STEPS as f64;
        // Below what was measured there is only somewhere to steer by, and nothing that is told.
        let contacts: Vec<_> = (0..=STEPS).map(|index| measured.at((step * index as f64).max(least))).collect();
        let [xx, xy, yy] = measured.covariance;
        Self { step, least, knots: knots(&contacts, &vec![Matrix2::new(xx, xy, xy, yy); STEPS + 1]) }
    }

    /// Directions (rad, frame of the base) of the contact force that bends `whisker` counter-clockwise while the platform
    /// swipes along a surface parallel to its heading, and of that surface's normal. A whisker swept forward is bent forward by
    /// it, one swept back to the back; in the frame of the base the one is the mirror image of the other. Friction turns the
    /// force to the back, as if the whisker were swept back by so much more.
    fn directions(whisker: &Whisker, friction: f64) -> Result<(f64, f64), TipCurveError> {
        let turn = friction.atan();
        let sweep = whisker.direction_body.abs() - FRAC_PI_2 + turn;
        if sweep.abs() < LEAST_SWEEP {
            return Err(TipCurveError::HeadOn { whisker: whisker.name.clone(), sweep });
        }
        Ok((PI - sweep.abs(), PI - sweep.abs() + turn * sweep.signum()))
    }

    /// Where the tip touches, in the frame of the whisker's base (m), at `base_angle` (rad). Beyond the range the
    /// place at its end; not a number for a base angle that is none.
    #[must_use]
    pub fn contact_base(&self, base_angle: f64) -> Vector2<f64> {
        if base_angle.is_nan() {
            return Vector2::repeat(f64::NAN);
        }
        let (a, b, u) = self.between(base_angle);
        let v = 1.0 - u;
        let position =
            (1.0 + 2.0 * u) * v * v * a.contact_base + u * v * v * a.slope + (1.0 + 2.0 * v) * u * u * b.contact_base
                - v * u * u * b.slope;
        Vector2::new(position.x, position.y * base_angle.signum())
    }

    /// How far off [`contact_base`](Self::contact_base) may be (m), as a standard deviation, when the base angle may be
    /// off by `angle_deviation` (rad): the root of the sum of both variances of [`covariance`](Self::covariance). Infinite beyond the
    /// range; not a number for a base angle that is none.
    ///
    /// It takes the tip to be what touches: when the shaft touches instead, at a corner, the place is farther off.
    #[must_use]
    pub fn deviation(&self, base_angle: f64, angle_deviation: f64) -> f64 {
        if base_angle.is_nan() {
            return f64::NAN;
        }
        self.covariance(base_angle, angle_deviation).map_or(f64::INFINITY, |covariance| covariance.trace().sqrt())
    }

    /// Covariance of [`contact_base`](Self::contact_base) (m², frame of the base) when the base angle may be off by
    /// `angle_deviation` (rad): what that moves the place by, and what a surface does that is not parallel to the heading but 10 deg
    /// off. `None` beyond the range.
    #[must_use]
    pub fn covariance(&self, base_angle: f64, angle_deviation: f64) -> Option<Matrix2<f64>> {
        if !(self.least..=self.range()).contains(&base_angle.abs()) {
            return None;
        }
        let (a, b, u) = self.between(base_angle);
        let off = a.slope.lerp(&b.slope, u) * (angle_deviation / self.step);
        let mut covariance = off * off.transpose() + a.unknown + u * (b.unknown - a.unknown);
        covariance.m12 *= base_angle.signum();
        covariance.m21 = covariance.m12;
        Some(covariance)
    }

    /// The greatest base angle of the curve (rad).
    #[must_use]
    pub fn range(&self) -> f64 {
        self.step * (self.knots.len() - 1) as f64
    }

    /// The knots on both sides of a base angle, and how far it is on its way from the first to the second (0 to 1).
    fn between(&self, base_angle: f64) -> (&Knot, &Knot, f64) {
        let last = self.knots.len() - 1;
        let along = (base_angle.abs() / self.step).min(last as f64);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and the last knot")]
        let index = (along as usize).min(last - 1);
        (&self.knots[index], &self.knots[index + 1], along - index as f64)
    }
}

/// Knots with slopes from their neighbours: central differences of fourth order inside, of lower order at the ends.
fn knots(contacts: &[Vector2<f64>], unknowns: &[Matrix2<f64>]) -> Vec<Knot> {
    let at = |index: usize| contacts[index];
    let last = contacts.len() - 1;
    (0..=last)
        .map(|index| {
            let slope = match (index, last - index) {
                (0, _) => 2.0 * at(1) - 1.5 * at(0) - 0.5 * at(2),
                (_, 0) => 1.5 * at(last) - 2.0 * at(last - 1) + 0.5 * at(last - 2),
                (1, _) | (_, 1) => (at(index + 1) - at(index - 1)) / 2.0,
                _ => (8.0 * (at(index + 1) - at(index - 1)) - (at(index + 2) - at(index - 2))) / 12.0,
            };
            Knot { contact_base: at(index), slope, unknown: unknowns[index] }
        })
        .collect()
}
