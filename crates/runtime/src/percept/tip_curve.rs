//! The contact position of a tip as a function of the base angle alone.

use std::borrow::Cow;
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use nalgebra::{Matrix2, Vector2};

use crate::calibration::{ContactCurve, ContactSet, DeflectionPolynomial};
use crate::geometry::{rotate, unit};
use crate::math;
use crate::mechanics::ShaftChain;
use crate::rig::{Hinge, Shaft, Whisker};

use super::newest::Newest;

/// The contact position of the tip as a function of the base angle alone.
///
/// The base angle alone does not determine the tip position, because the direction of the contact force also matters.
/// The curve assumes the direction during contour following along a surface parallel to the heading. It is exact there,
/// and in error by about 0.2 mm per degree between surface and heading. A bend to the other side is the mirror image.
///
/// The curve interpolates equilibria of the whisker's chain of links at equal steps of the base angle, with cubic
/// Hermite polynomials.
#[derive(Debug, Clone)]
pub struct TipCurve {
    /// Step of the base angle between knots (rad).
    step: f64,
    /// Smallest magnitude of a base angle (rad) with known contact.
    least: f64,
    /// Smallest and largest base angle (rad), if the curve ends before its last knot.
    limits: [f64; 2],
    /// Contact positions for the base angles 0, `step`, 2 `step`, …
    knots: Vec<Knot>,
}

/// A knot of the interpolation.
#[derive(Debug, Clone, Copy)]
struct Knot {
    /// Contact position (m, frame of the base).
    contact_base: Vector2<f64>,
    /// Change of the position per step of the base angle.
    slope: Vector2<f64>,
    /// Covariance of the position (m²) due to the unknown surface direction.
    unknown: Matrix2<f64>,
}

/// An error of computing a tip curve.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TipCurveError {
    /// The whisker is too nearly perpendicular to the heading.
    #[error(
        "whisker {whisker}: the force of a surface beside it is {:.0} deg from axial, so the shaft may buckle; \
         sweep it back or forward by {:.0} deg or more",
        sweep.to_degrees(), LEAST_SWEEP.to_degrees().ceil()
    )]
    HeadOn {
        /// The whisker.
        whisker: String,
        /// Angle (rad) by which it trails, including the friction angle.
        sweep: f64,
    },
    /// The chain has almost no equilibrium in the range of the curve.
    #[error(
        "whisker {whisker}: on surfaces with a friction of {friction} the shaft has no equilibrium beyond a base angle of {:.0} urad; \
         state a smaller `friction`, sweep the whisker back, or make its shaft softer or its hinge stiffer",
        base_angle * 1e6
    )]
    NoEquilibrium {
        /// The whisker.
        whisker: String,
        /// The base angle (rad).
        base_angle: f64,
        /// The coefficient of friction.
        friction: f64,
    },
}

/// Largest base moment of the curve, in units of `EI / L` with the reduced stiffness of a tapered shaft. The reference
/// target is 1.6 of them.
const MOMENT_RANGE: f64 = 6.0;
/// Number of steps of the base angle.
const STEPS: usize = 120;
/// Least number of steps. With friction, a shaft may have no equilibrium at large base angles, so that its curve is shorter.
const LEAST_STEPS: usize = 12;
/// Smallest angle (rad) between the undeflected shaft and the surface normal. A shaft that meets a surface head-on may
/// buckle to either side, so that its contact is undetermined.
const LEAST_SWEEP: f64 = 0.087;

/// Small rotation of the surface (rad), away from head-on, for the derivative by the surface direction.
const TURN: f64 = 0.01;
/// Standard deviation (rad) of the surface direction from the assumed one. Contour following keeps the heading within
/// about this angle of a curved surface. At the first contact the direction is unknown.
const SURFACE_DEVIATION: f64 = 10.0 * PI / 180.0;

/// A curve without limits.
const UNLIMITED: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

impl TipCurve {
    /// Computes the curve of `whisker` on frictionless surfaces.
    ///
    /// # Errors
    /// As [`with_friction`](Self::with_friction).
    pub fn new(whisker: &Whisker) -> Result<Self, TipCurveError> {
        Self::with_friction(whisker, 0.0)
    }

    /// Returns the curve of [`with_friction`](Self::with_friction) from a cache of the newest curves. Whiskers that are mirror
    /// images of each other share a curve.
    ///
    /// # Errors
    /// As [`with_friction`](Self::with_friction).
    pub fn shared(whisker: &Whisker, friction: f64) -> Result<Arc<Self>, TipCurveError> {
        static NEWEST: Newest<(Shaft, Hinge, [f64; 2]), TipCurve> = Newest::new();
        let shaft = Self::bent_to_the_left(whisker).shaft.clone();
        let key = (shaft, whisker.hinge.clone(), [whisker.direction_body.abs(), friction]);
        NEWEST.get_or(key, || Self::with_friction(whisker, friction))
    }

    /// The whisker, or its mirror image, whose usual bend is counter-clockwise.
    fn bent_to_the_left(whisker: &Whisker) -> Cow<'_, Whisker> {
        if whisker.side() < 0.0 { Cow::Owned(whisker.mirrored()) } else { Cow::Borrowed(whisker) }
    }

    /// Computes the curve of `whisker` on surfaces along which it slides forward with this coefficient of friction. It ends at
    /// the largest base angle at which the chain has an equilibrium.
    ///
    /// # Errors
    /// [`TipCurveError`] if the whisker sticks instead of sliding, or its chain has an equilibrium in less than a tenth of the
    /// range.
    pub fn with_friction(whisker: &Whisker, friction: f64) -> Result<Self, TipCurveError> {
        let chain = ShaftChain::new(&Self::bent_to_the_left(whisker));
        let (force_direction, normal_direction) = Self::directions(whisker, friction)?;
        let shaft = &whisker.shaft;
        let step = MOMENT_RANGE * shaft.tip_stiffness() / shaft.length / whisker.hinge.stiffness / STEPS as f64;
        let normal = unit(normal_direction);
        let tip_radius = shaft.radius_at(1.0);

        let (mut contacts, mut unknowns) = (Vec::with_capacity(STEPS + 1), Vec::with_capacity(STEPS + 1));
        let mut solution = chain.at_rest();
        let mut before = solution;
        for index in 0..=STEPS {
            let base_angle = step * index as f64;
            let mut guess = solution;
            // Linear extrapolation from the last two solutions. The first step is that of a cantilever under a small
            // force.
            if index == 1 {
                guess.force = base_angle * whisker.hinge.stiffness / (shaft.length * math::sin(force_direction));
                guess.tip_angle = guess.force * math::sin(force_direction) * math::square(shaft.length)
                    / (2.0 * shaft.tip_stiffness());
            } else if index > 1 {
                guess.force += solution.force - before.force;
                guess.tip_angle += solution.tip_angle - before.tip_angle;
            }
            let found = if index > 0 { chain.solve(base_angle, force_direction, &guess) } else { Some(solution) };
            let found = found.and_then(|found| Some((found, chain.solve(base_angle, force_direction - TURN, &found)?)));
            let Some((found, turned)) = found else {
                if index > LEAST_STEPS {
                    break;
                }
                return Err(TipCurveError::NoEquilibrium { whisker: whisker.name.clone(), base_angle, friction });
            };
            if index > 0 {
                (before, solution) = (solution, found);
            }
            // The tip is a hemisphere with the radius of the shaft. It touches on the side from which the force comes.
            let contact = solution.tip_base - tip_radius * normal;
            let turned_contact = turned.tip_base - tip_radius * rotate(normal, -TURN);
            contacts.push(contact);
            let off = (turned_contact - contact) * (SURFACE_DEVIATION / TURN);
            unknowns.push(off * off.transpose());
        }
        Ok(Self { step, least: 0.0, limits: UNLIMITED, knots: knots(&contacts, &unknowns) })
    }

    /// Creates the curve of a measured whisker.
    #[must_use]
    pub fn calibrated(measured: &ContactCurve) -> Self {
        let [least, range] = measured.range;
        let step = range / STEPS as f64;
        // Below the measured range the curve only serves steering. There is no contact estimate.
        let contacts: Vec<_> = (0..=STEPS).map(|index| measured.at(math::max(step * index as f64, least))).collect();
        let [xx, xy, yy] = measured.covariance;
        let unknowns = vec![Matrix2::new(xx, xy, xy, yy); STEPS + 1];
        Self { step, least, limits: UNLIMITED, knots: knots(&contacts, &unknowns) }
    }

    /// Creates the curve of a measured polynomial. `bend_sign` is the sign of the base angle at a surface beside the
    /// platform. The curve ends at the [limits](DeflectionPolynomial::LIMITS) of the two sides.
    #[must_use]
    pub fn by_polynomial(polynomial: &DeflectionPolynomial, bend_sign: f64) -> Self {
        let step = polynomial.range / STEPS as f64;
        let contacts: Vec<_> = (0..=STEPS).map(|index| polynomial.at(step * index as f64)).collect();
        let [xx, xy, yy] = polynomial.covariance;
        let unknowns = vec![Matrix2::new(xx, xy, xy, yy); STEPS + 1];
        let (_, opposite) = DeflectionPolynomial::LIMITS;
        let limits = if bend_sign < 0.0 { [f64::NEG_INFINITY, opposite] } else { [-opposite, f64::INFINITY] };
        Self { step, least: 0.0, limits, knots: knots(&contacts, &unknowns) }
    }

    /// Replaces the positions of a curve of the mechanics by a polynomial that is fitted to them, for an uncalibrated
    /// whisker of `length` (m). `None` if they do not determine it.
    #[must_use]
    pub fn to_polynomial(&self, length: f64, bend_sign: f64) -> Option<Self> {
        let range = math::min(DeflectionPolynomial::LIMITS.0, self.range());
        let base_angles = || (0..=STEPS).map(|index| range * (index as f64 / STEPS as f64));
        let set = |base_angle| {
            let contact_base = self.contact_base(base_angle);
            (ContactSet { contact_base, base_angle, normal: None, on_shaft: false }, 1.0)
        };
        let polynomial = DeflectionPolynomial::fit(&base_angles().map(set).collect::<Vec<_>>(), length)?;
        let mut curve = Self::by_polynomial(&polynomial, bend_sign);
        // The error of the fit is in the knots already. The direction of the surface is unknown as before.
        for (knot, base_angle) in curve.knots.iter_mut().zip(base_angles()) {
            let (a, b, u) = self.between(base_angle);
            knot.unknown += a.unknown + u * (b.unknown - a.unknown);
        }
        Some(curve)
    }

    /// Directions (rad, frame of the base) of the contact force that bends `whisker` counter-clockwise, and of the
    /// surface normal, along a surface with the [usual normal](Whisker::usual_normal). Friction rotates the force to the
    /// back, like a larger sweep back.
    fn directions(whisker: &Whisker, friction: f64) -> Result<(f64, f64), TipCurveError> {
        let turn = math::atan(friction);
        let sweep = (whisker.direction_body.abs() - FRAC_PI_2).abs() + turn;
        if sweep < LEAST_SWEEP {
            return Err(TipCurveError::HeadOn { whisker: whisker.name.clone(), sweep });
        }
        Ok((PI - sweep, PI - sweep + turn))
    }

    /// The contact position (m, frame of the base) at `base_angle` (rad). Beyond the range it is the position at the
    /// end of the range. It is NaN for a NaN.
    #[must_use]
    pub fn contact_base(&self, base_angle: f64) -> Vector2<f64> {
        if base_angle.is_nan() {
            return Vector2::repeat(f64::NAN);
        }
        let base_angle = math::min(math::max(base_angle, self.limits[0]), self.limits[1]);
        let (a, b, u) = self.between(base_angle);
        let v = 1.0 - u;
        let position =
            (1.0 + 2.0 * u) * v * v * a.contact_base + u * v * v * a.slope + (1.0 + 2.0 * v) * u * u * b.contact_base
                - v * u * u * b.slope;
        Vector2::new(position.x, position.y * base_angle.signum())
    }

    /// Standard deviation (m) of [`contact_base`](Self::contact_base): the square root of the trace of
    /// [`covariance`](Self::covariance). `angle_deviation` (rad) is that of the base angle. The result is infinite
    /// beyond the range and NaN for a NaN.
    ///
    /// It assumes a tip contact. If the shaft touches a corner instead, the error is larger.
    #[must_use]
    pub fn deviation(&self, base_angle: f64, angle_deviation: f64) -> f64 {
        if base_angle.is_nan() {
            return f64::NAN;
        }
        self.covariance(base_angle, angle_deviation).map_or(f64::INFINITY, |covariance| covariance.trace().sqrt())
    }

    /// Covariance of [`contact_base`](Self::contact_base) (m², frame of the base). It is due to the base angle, with
    /// the standard deviation `angle_deviation` (rad), and to the surface direction, with one of 10 deg. `None` beyond
    /// the range.
    #[must_use]
    pub fn covariance(&self, base_angle: f64, angle_deviation: f64) -> Option<Matrix2<f64>> {
        let is_within = (self.limits[0]..=self.limits[1]).contains(&base_angle);
        if !is_within || !(self.least..=self.range()).contains(&base_angle.abs()) {
            return None;
        }
        let (a, b, u) = self.between(base_angle);
        let off = a.slope.lerp(&b.slope, u) * (angle_deviation / self.step);
        let mut covariance = off * off.transpose() + a.unknown + u * (b.unknown - a.unknown);
        covariance.m12 *= base_angle.signum();
        covariance.m21 = covariance.m12;
        Some(covariance)
    }

    /// Largest base angle of the curve (rad), to its usual side if it has one.
    #[must_use]
    pub fn range(&self) -> f64 {
        self.step * (self.knots.len() - 1) as f64
    }

    /// The knots on both sides of a base angle, and its relative position between them (0 to 1).
    fn between(&self, base_angle: f64) -> (&Knot, &Knot, f64) {
        let last = self.knots.len() - 1;
        let along = math::min(base_angle.abs() / self.step, last as f64);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and the last knot")]
        let index = (along as usize).min(last - 1);
        (&self.knots[index], &self.knots[index + 1], along - index as f64)
    }
}

/// Creates knots with slopes by finite differences: central ones of fourth order inside, of lower order at the ends.
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
