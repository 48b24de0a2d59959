//! The planar elastica.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{Matrix2, Vector2};

use crate::geometry::{perpendicular, unit, wrap};
use crate::math;
use crate::rig::Whisker;

use super::continuation::continuation;
use super::newton::{self, Residual};
use super::shaft_shape::ShaftShape;
use super::shot::{Load, Shot};

/// A whisker's shaft as a planar elastica on its base hinge. It is inextensible and massless, and bends by `M = EI θ'`
/// at any deflection.
///
/// One force acts at the tip or on the shaft. Beyond it the shaft is straight. Solutions are exact to 1e-9 of the
/// length. If one force has several equilibria, only those that bend to one side everywhere are found.
///
/// The equations and their closed solutions for a uniform shaft: Love, A Treatise on the Mathematical Theory of
/// Elasticity (1927), chapter XIX; Bisshopp and Drucker, Quarterly of Applied Mathematics 3 (1945), 272.
#[derive(Debug, Clone)]
pub struct Elastica {
    /// Length (m).
    pub(super) length: f64,
    /// Unit of force (N): `EI / L²`.
    pub(super) force_unit: f64,
    /// Base angle (rad) under a base moment of `EI / L`.
    pub(super) hinge_compliance: f64,
    /// Ratio of the radii at the tip and at the base.
    pub(super) taper: f64,
}

/// The conditions of a solution, in the units of [`Load`].
#[derive(Debug, Clone, Copy)]
struct Aim {
    /// Length of the shaft from the base to the force.
    contact: f64,
    /// Bending moment at the base.
    moment: f64,
    /// Direction of the force in the frame of the base (rad).
    direction: f64,
}

/// Largest Newton step of an angle (rad) or of the force.
const REACH: f64 = 0.5;
/// A direction of the force (rad) that bends a straight shaft to the left in any case.
const SIDEWAYS: f64 = 2.0;

impl Elastica {
    /// Creates the elastica of `whisker`.
    #[must_use]
    pub fn new(whisker: &Whisker) -> Self {
        let (length, stiffness) = (whisker.shaft.length, whisker.shaft.bending_stiffness());
        Self {
            length,
            force_unit: stiffness / math::square(length),
            hinge_compliance: stiffness / length / whisker.hinge.stiffness,
            taper: whisker.shaft.taper(),
        }
    }

    /// The straight shaft.
    #[must_use]
    pub fn straight(&self) -> ShaftShape {
        self.unbent(self.length, FRAC_PI_2)
    }

    /// The straight shaft without force, for a contact at a length (m) and a force direction (rad).
    fn unbent(&self, contact_length: f64, force_direction: f64) -> ShaftShape {
        ShaftShape {
            base_angle: 0.0,
            shear: 0.0,
            axial: 0.0,
            contact_length,
            contact_base: Vector2::new(contact_length, 0.0),
            force: 0.0,
            force_direction,
            tip_base: Vector2::new(self.length, 0.0),
            tip_angle: 0.0,
        }
    }

    /// The shape under a force of magnitude `force` (N) at the length `contact_length` (m). Its direction `force_angle`
    /// (rad) is counted from that of the shaft at the force. A force at π/2 is perpendicular to the shaft and bends it
    /// to the left. `None` if the force does not bend the shaft to one side everywhere.
    ///
    /// This needs no iteration, because the shape follows from the force.
    #[must_use]
    pub fn under(&self, contact_length: f64, force_angle: f64, force: f64) -> Option<ShaftShape> {
        let load = Load { contact: contact_length / self.length, angle: force_angle, force: force / self.force_unit };
        if load.angle < 0.0 {
            return self.under(contact_length, -force_angle, force).map(|shape| shape.mirrored());
        }
        self.shape(&load, &Shot::of(&load, self.taper)?)
    }

    /// The equilibrium with the base angle `base_angle` (rad) under a force at the tip in the direction
    /// `force_direction` (rad, frame of the base). See [`solve_at`](Self::solve_at).
    #[must_use]
    pub fn solve_tip(&self, base_angle: f64, force_direction: f64, guess: &ShaftShape) -> Option<ShaftShape> {
        self.solve_at(self.length, base_angle, force_direction, guess)
    }

    /// The equilibrium with the base angle `base_angle` (rad) under a force in the direction `force_direction` (rad,
    /// frame of the base). It acts at the length `contact_length` (m), above 0 and up to the tip.
    ///
    /// The solution is traced from `guess` by continuation. The [`straight`](Self::straight) shaft is a valid guess for
    /// all directions up to π and for some beyond. `None` if no solution is found.
    #[must_use]
    pub fn solve_at(
        &self,
        contact_length: f64,
        base_angle: f64,
        force_direction: f64,
        guess: &ShaftShape,
    ) -> Option<ShaftShape> {
        if base_angle < 0.0 {
            return self
                .solve_at(contact_length, -base_angle, -force_direction, &guess.mirrored())
                .map(|shape| shape.mirrored());
        }
        if base_angle == 0.0 {
            return Some(self.unbent(contact_length, force_direction));
        }
        let aim = Aim {
            contact: contact_length / self.length,
            moment: base_angle / self.hinge_compliance,
            direction: force_direction,
        };
        // A straight guess, or one that bends to the other side, has no information.
        let start = if guess.base_angle > 0.0 {
            ShaftShape { force_direction: force_direction + wrap(guess.force_direction - force_direction), ..*guess }
        } else {
            // A small force towards the base does not bend the straight shaft. The direction is rotated there once the
            // shaft is bent.
            self.unbent(contact_length, math::min(force_direction, SIDEWAYS))
        };
        let from = Aim {
            contact: start.contact_length / self.length,
            moment: start.base_angle / self.hinge_compliance,
            direction: start.force_direction,
        };
        continuation(start, |share, near| self.balance(&from.towards(&aim, share), near)).ok()
    }

    /// The equilibrium for the conditions `aim`, by Newton's method from a neighbouring one.
    fn balance(&self, aim: &Aim, near: &ShaftShape) -> Option<ShaftShape> {
        let guess = Vector2::new(near.force_direction - near.tip_angle, near.force / self.force_unit);
        let load = |unknowns: Vector2<f64>| Load { contact: aim.contact, angle: unknowns.x, force: unknowns.y };
        let solution = newton::solve(guess, REACH, |unknowns| {
            let load = load(unknowns);
            let Shot { root, moment, .. } = Shot::of(&load, self.taper)?;
            let direction = self.hinge_compliance * aim.moment - root.value + load.angle;
            Some(Residual {
                value: Vector2::new(direction - aim.direction, moment.value - aim.moment),
                slope: Matrix2::new(1.0 - root.by_angle, -root.by_force, moment.by_angle, moment.by_force),
            })
        })?;
        let load = load(solution);
        self.shape(&load, &Shot::of(&load, self.taper)?)
    }

    /// The shape under a load. `None` if it does not bend to the left everywhere.
    pub(super) fn shape(&self, load: &Load, shot: &Shot) -> Option<ShaftShape> {
        if !shot.bends_left || load.force <= 0.0 {
            return None;
        }
        let base_angle = self.hinge_compliance * shot.moment.value;
        let tip_angle = base_angle - shot.root.value;
        let force = load.force * self.force_unit;
        let (across, along) = math::sin_cos(load.angle - shot.root.value);
        let force_direction = load.angle + tip_angle;
        let (forward, left) = (unit(force_direction), perpendicular(unit(force_direction)));
        let contact_base = self.length * (shot.along.value * forward - shot.lever.value * left);
        let beyond = self.length * (1.0 - load.contact);
        Some(ShaftShape {
            base_angle,
            shear: force * across,
            axial: force * along,
            contact_length: load.contact * self.length,
            contact_base,
            force,
            force_direction,
            tip_base: contact_base + beyond * unit(tip_angle),
            tip_angle,
        })
    }
}

impl Aim {
    /// Linear interpolation to other conditions.
    fn towards(&self, other: &Self, share: f64) -> Self {
        // This form is exact at the end, where the force may be exactly at the tip.
        let between = |from: f64, to: f64| (1.0 - share) * from + share * to;
        Self {
            contact: between(self.contact, other.contact),
            moment: between(self.moment, other.moment),
            direction: between(self.direction, other.direction),
        }
    }
}
