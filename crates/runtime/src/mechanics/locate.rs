//! The contact position from the moment and the shear at the base.

use nalgebra::{Matrix2, Matrix3x2, Vector2};

use crate::math;

use super::continuation::continuation;
use super::elastica::Elastica;
use super::frictionless_contact::{FrictionlessContact, LoadedContact};
use super::newton::{self, Residual};
use super::shaft_shape::ShaftShape;

/// An error of locating a contact.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum LocateError {
    /// A reading is not finite.
    #[error("the base angle or the shear is not a finite number; leave the reading out")]
    NotFinite,
    /// Moment and shear are zero: there is no contact.
    #[error("neither a base angle nor a shear: nothing touches the whisker; use readings of a contact")]
    NoContact,
    /// No contact fits the readings.
    #[error(
        "no stable frictionless contact has this shear with this base angle, because the shaft would snap through; leave the \
         readings out"
    )]
    NoSolution,
}

/// Largest Newton step of the position, of the angle (rad), and of the force as powers of e.
const REACH: f64 = 0.5;
/// Limits of the shear of a stable contact, in units of `EI / L²`.
///
/// At the tip the shear is above minus the first. For a smaller shear the shaft would bend to the other side at the
/// contact. For a uniform shaft the first is `4 K(1/√2)²`, and a tapered one is softer. On the shaft the shear is also
/// allowed down to minus the second times the square of the base moment, in units of `EI / L`.
const LEAST_SHEAR: (f64, f64) = (13.76, 4.0);
/// Largest ratio of moment over shear, and of similar quantities, to the length of the shaft, and of its inverse.
const ABSURD: f64 = 1e6;

/// The conditions of a contact: the logarithm of the base moment, in units of `EI / L`, and shear over moment, in units
/// of `1 / L`. Each point of their plane has exactly one contact that bends the shaft to one side.
#[derive(Debug, Clone, Copy)]
struct Aim {
    /// Logarithm of the base moment.
    moment: f64,
    /// Shear over moment.
    ratio: f64,
}

impl Elastica {
    /// Finds the shape with the base angle `base_angle` (rad) and the shear `shear` (N, perpendicular to the shaft at
    /// the base, positive to its left), assuming one frictionless contact.
    ///
    /// There are two kinds of contact. On the shaft the force is perpendicular to the shaft, and its position is
    /// unknown (`contact_length` below the length). The tip is a hemisphere, so there the position is known
    /// (`contact_length` is the length). Its unknown is the direction, from perpendicular to the shaft to straight
    /// against it. Both kinds have two unknowns for two readings. They meet at a perpendicular force at the tip. For a
    /// small bend, the contact is on the shaft if moment over shear is less than the length. If it is greater, the
    /// contact is at the tip, where the force along the shaft adds to the moment. No two contacts have the same
    /// readings.
    ///
    /// Only stable contacts with a fixed object are found. At the tip the object is a straight surface along which the
    /// tip may slide, and on the shaft it is a point. A bent whisker can be held by a surface that would push a
    /// straight one to the other side. Its shear then has the opposite sign, down to a limit. Beyond it the shaft snaps
    /// through, and there is no solution.
    ///
    /// A neighbouring contact as `guess` makes the search several times faster. Any other guess, such as the
    /// [`straight`](Self::straight) shaft, gives the same result.
    ///
    /// # Errors
    /// [`LocateError`] if a reading is not finite, or if no contact fits the readings.
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

    /// Derivatives of the contact position (m) and the force direction (rad), both in the frame of the base, by the
    /// base angle (rad) and the shear (N). The rows are x, y and the direction. `None` for a straight shaft and for a
    /// shape that is not a contact.
    #[must_use]
    pub fn changes(&self, shape: &ShaftShape) -> Option<Matrix3x2<f64>> {
        let is_left = shape.base_angle > 0.0;
        let left = if is_left { *shape } else { shape.mirrored() };
        let mut changes = self.loaded(FrictionlessContact::of(&left, self))?.by_readings(self, &left)?;
        if !is_left {
            // For mirrored readings x is equal, while all other quantities change their sign.
            changes.row_mut(0).neg_mut();
        }
        Some(changes)
    }

    /// The shape, bent to the left, with a moment and a shear at its base, in the units of [`Load`](super::shot::Load).
    fn find(&self, moment: f64, shear: f64, guess: &ShaftShape) -> Option<ShaftShape> {
        let aim = Aim { moment: math::ln(moment), ratio: shear / moment };
        let is_absurd = math::max(math::max(moment, moment.recip()), aim.ratio.abs()) > ABSURD;
        if is_absurd || shear < -(LEAST_SHEAR.0 + LEAST_SHEAR.1 * moment * moment) {
            return None;
        }
        let near = (guess.base_angle > 0.0).then(|| self.contact(aim, FrictionlessContact::of(guess, self))).flatten();
        let contact = near.or_else(|| {
            let start = self.loaded(FrictionlessContact::about(moment, aim.ratio, self.taper))?;
            self.contact(aim, start.contact).or_else(|| {
                let from = Aim { moment: math::ln(start.moment.value), ratio: start.shear.value / start.moment.value };
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

    /// The contact with a moment and a shear, by Newton's method from a neighbouring one.
    fn contact(&self, aim: Aim, near: FrictionlessContact) -> Option<LoadedContact> {
        let at = |unknowns: Vector2<f64>| self.loaded(FrictionlessContact { position: unknowns.x, force: unknowns.y });
        let solution = newton::solve(Vector2::new(near.position, near.force), REACH, |unknowns| {
            let LoadedContact { moment, shear, .. } = at(unknowns)?;
            let ratio = shear.value / moment.value;
            Some(Residual {
                value: Vector2::new(math::ln(moment.value) - aim.moment, ratio - aim.ratio),
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
