//! Where something touches a whisker, from the moment and the shear at its base.

use nalgebra::{Matrix2, Matrix3x2, Vector2};

use super::continuation::continuation;
use super::elastica::Elastica;
use super::frictionless_contact::{FrictionlessContact, LoadedContact};
use super::newton::{self, Residual};
use super::shaft_shape::ShaftShape;

/// Why nothing can be said of where a whisker is touched.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum LocateError {
    /// A reading is not a number.
    #[error("the base angle or the shear is not a finite number; leave the reading out")]
    NotFinite,
    /// Neither moment nor shear: nothing touches.
    #[error("neither a base angle nor a shear: nothing touches the whisker")]
    NoContact,
    /// No place on the whisker fits the readings.
    #[error(
        "no touch without friction by something that stays has this shear with this base angle: the shaft would spring over; leave \
         the readings out"
    )]
    NoSolution,
}

/// How far a step of Newton's method may change the place, the angle (rad) or the force, as powers of e.
const REACH: f64 = 0.5;
/// A touch that stays has a shear, in units of `EI / L²`, above minus this, or, on the shaft, above minus the second times the square of
/// the base moment in those of `EI / L`. At the tip no touch has less, for then the shaft would bend to the other side where it is held:
/// for a uniform shaft the first is `4 K(1/√2)²`. One that tapers is softer.
const LEAST_SHEAR: (f64, f64) = (13.76, 4.0);
/// How many times the length of the shaft, or its inverse, moment over shear and their like may be.
const ABSURD: f64 = 1e6;

/// What a touch is to have: the logarithm of the moment at the base, in units of `EI / L`, and shear over moment, in units of `1 / L`.
/// All touches that bend a shaft to one side fill the plane of the two, once.
#[derive(Debug, Clone, Copy)]
struct Aim {
    moment: f64,
    ratio: f64,
}

impl Elastica {
    /// The bend that has the base angle `base_angle` (rad) and the shear `shear` (N, across the shaft at the base, positive to
    /// its left), if what touches does so at one point and without friction.
    ///
    /// Such a touch is one of two kinds. On the shaft the force is square to the shaft, and its place is unknown
    /// (`contact_length` below the length). At the tip, which is a half sphere, the place is known
    /// (`contact_length` is the length), and the direction unknown, from square to the shaft to straight against it. Both have two
    /// unknowns for two readings, and they meet where a force is at the tip and square. In small bends a touch
    /// is on the shaft where moment over shear is less than the length, and at the tip where it is more, the force along the
    /// shaft adding to the moment. No two touches have the same readings.
    ///
    /// Taken for a touch is only what stays if what touches stays where it is: at the tip a straight surface, along which it may slide,
    /// and a point on the shaft. A bent whisker is held by a surface that would push an unbent one to the other side, so that the shear
    /// changes its sign, down to a limit; then it springs over, and there is no solution.
    ///
    /// A neighbouring touch as `guess` makes it several times as fast; any other, such as the [`straight`](Self::straight) shaft,
    /// does no harm.
    ///
    /// # Errors
    /// [`LocateError`].
    pub fn locate(&self, base_angle: f64, shear: f64, guess: &ShaftShape) -> Result<ShaftShape, LocateError> {
        if !(base_angle.is_finite() && shear.is_finite()) {
            return Err(LocateError::NotFinite);
        }
        if base_angle == 0.0 {
            return Err(if shear == 0.0 { LocateError::NoContact } else { LocateError::NoSolution });
        }
        let side = |shape: ShaftShape| if base_angle < 0.0 { shape.mirrored() } else { shape };
        let (moment, shear) = (base_angle.abs() / self.hinge_compliance, base_angle.signum() * shear / self.force_unit);
        self.find(moment, shear, &side(*guess)).map(side).ok_or(LocateError::NoSolution)
    }

    /// How the place of a touch (m) and the direction of its force (rad), both in the frame of the base, change with the base angle (rad)
    /// and the shear (N): a row each of x, y and the direction. `None` of a straight shaft, and of what is no touch.
    #[must_use]
    pub fn changes(&self, shape: &ShaftShape) -> Option<Matrix3x2<f64>> {
        let is_left = shape.base_angle > 0.0;
        let left = if is_left { *shape } else { shape.mirrored() };
        let mut changes = self.loaded(FrictionlessContact::of(&left, self))?.by_readings(self, &left)?;
        if !is_left {
            // x is the same function of both readings with the other sign; all else changes its sign with them.
            changes.row_mut(0).neg_mut();
        }
        Some(changes)
    }

    /// The bend to the left with a moment and a shear at its base, in the units of [`Load`](super::shot::Load).
    fn find(&self, moment: f64, shear: f64, guess: &ShaftShape) -> Option<ShaftShape> {
        let aim = Aim { moment: moment.ln(), ratio: shear / moment };
        let is_absurd = moment.max(moment.recip()).max(aim.ratio.abs()) > ABSURD;
        if is_absurd || shear < -(LEAST_SHEAR.0 + LEAST_SHEAR.1 * moment * moment) {
            return None;
        }
        let near = (guess.base_angle > 0.0).then(|| self.contact(aim, FrictionlessContact::of(guess, self))).flatten();
        let contact = near.or_else(|| {
            let start = self.loaded(FrictionlessContact::about(moment, aim.ratio, self.taper))?;
            self.contact(aim, start.contact).or_else(|| {
                let from = Aim { moment: start.moment.value.ln(), ratio: start.shear.value / start.moment.value };
                let between = |from: f64, to: f64, share: f64| (1.0 - share) * from + share * to;
                let between_loads = |share: f64, near: &LoadedContact| {
                    let moment = between(from.moment, aim.moment, share);
                    self.contact(Aim { moment, ratio: between(from.ratio, aim.ratio, share) }, near.contact)
                };
                continuation(start, between_loads).ok()
            })
        })?;
        if contact.is_stable() { self.shape(&contact.contact.load(), &contact.shot) } else { None }
    }

    /// The touch with a moment and a shear, from a neighbouring one on.
    fn contact(&self, aim: Aim, near: FrictionlessContact) -> Option<LoadedContact> {
        let at = |unknowns: Vector2<f64>| self.loaded(FrictionlessContact { position: unknowns.x, force: unknowns.y });
        let solution = newton::solve(Vector2::new(near.position, near.force), REACH, |unknowns| {
            let LoadedContact { moment, shear, .. } = at(unknowns)?;
            let ratio = shear.value / moment.value;
            Some(Residual {
                value: Vector2::new(moment.value.ln() - aim.moment, ratio - aim.ratio),
                slope: Matrix2::new(
                    moment.by_position / moment.value,
                    moment.by_force / moment.value,
                    (shear.by_position - ratio * moment.by_position) / moment.value,
                    (shear.by_force - ratio * moment.by_force) / moment.value,
                ),
            })
        })?;
        at(solution)
    }
}
