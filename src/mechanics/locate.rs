//! Where something touches a whisker, from the moment and the shear at its base.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Matrix2, Vector2};

use super::bend::Bend;
use super::elastica::Elastica;
use super::follow::follow;
use super::newton::{self, Residual};
use super::shot::{Load, Shot};

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
        "no touch without friction has this shear with this base angle; the nearest that has its base angle has a shear of {:.3e} N",
        nearest.shear
    )]
    NoSolution {
        /// The bend with the same base angle whose shear comes nearest, to some thousandths of `EI / L²`. The straight shaft
        /// where there is none with that base angle.
        nearest: Bend,
    },
}

/// The greatest turn (rad), in small bends, of the shaft from which the search begins.
const SMALL_TURN: f64 = 0.1;
/// How far a step of Newton's method may change the place, the angle (rad) or the force, as powers of e.
const REACH: f64 = 0.5;

/// A touch without friction as two numbers, so that all touches are one plane without a gap.
#[derive(Debug, Clone, Copy)]
struct Touch {
    /// Below 0 the logarithm of the length to the touch, over that of the shaft; from 0 on the tip is touched, and this is
    /// how far (rad) the force is from square to the shaft, towards its head.
    place: f64,
    /// Logarithm of the force, in the unit of [`Load`].
    force: f64,
}

impl Touch {
    fn of(bend: &Bend, elastica: &Elastica) -> Self {
        let length = bend.contact_length / elastica.length;
        let place = if length < 1.0 { length.ln() } else { bend.force_direction - bend.tip_angle - FRAC_PI_2 };
        Self { place, force: (bend.force / elastica.force_unit).ln() }
    }

    fn load(self) -> Load {
        let contact = self.place.min(0.0).exp();
        Load { contact, angle: FRAC_PI_2 + self.place.max(0.0), force: self.force.exp() }
    }
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
    /// Taken for a touch is only what would stay under a force that stays: a shaft that a force at its tip bends, though it
    /// pushes to the other side, does so down to a limit, and then springs over. Below that shear there is no solution.
    ///
    /// A neighbouring touch as `guess` makes it several times as fast; any other, such as the [`straight`](Self::straight) shaft,
    /// does no harm.
    ///
    /// # Errors
    /// [`LocateError`]; without a solution it has the nearest.
    pub fn locate(&self, base_angle: f64, shear: f64, guess: &Bend) -> Result<Bend, LocateError> {
        if !(base_angle.is_finite() && shear.is_finite()) {
            return Err(LocateError::NotFinite);
        }
        if base_angle == 0.0 {
            let nearest = self.straight();
            return Err(if shear == 0.0 { LocateError::NoContact } else { LocateError::NoSolution { nearest } });
        }
        let side = |bend: Bend| if base_angle < 0.0 { bend.mirrored() } else { bend };
        let (moment, shear) = (base_angle.abs() / self.hinge_compliance, base_angle.signum() * shear / self.force_unit);
        let found = self.find(moment, shear, &side(*guess));
        found.map(side).map_err(|nearest| LocateError::NoSolution { nearest: side(nearest) })
    }

    /// The bend to the left with a moment and a shear at its base, in the units of [`Load`]; else the last with that moment
    /// on the way to that shear.
    fn find(&self, moment: f64, shear: f64, guess: &Bend) -> Result<Bend, Bend> {
        if guess.base_angle > 0.0
            && let Some(found) = self.touch(moment, shear, Touch::of(guess, self))
        {
            return Ok(found);
        }
        let Some(small) = self.small(moment, shear) else { return Err(self.straight()) };
        let first = small.shear / self.force_unit;
        let Some(start) = self.touch(moment, first, Touch::of(&small, self)) else { return Err(self.straight()) };
        follow(start, |share, near| self.touch(moment, (1.0 - share) * first + share * shear, Touch::of(near, self)))
    }

    /// A touch with about a moment, and with about a shear if the shaft bends little under it; else nearer to the base, where
    /// it does. It is on the shaft, or square at the tip.
    fn small(&self, moment: f64, shear: f64) -> Option<Bend> {
        let mut contact = if shear > 0.0 { (moment / shear).min(1.0) } else { 1.0 };
        let turn = |contact: f64| {
            let taper = 1.0 + (self.taper - 1.0) * contact;
            moment * contact * (1.0 + 2.0 * taper) / (6.0 * taper * taper)
        };
        while turn(contact) > SMALL_TURN {
            contact *= 0.5;
        }
        let load = Load { contact, angle: FRAC_PI_2, force: moment / contact };
        self.bend(&load, &Shot::of(&load, self.taper)?)
    }

    /// The touch with a moment and a shear, from a neighbouring one on.
    fn touch(&self, moment: f64, shear: f64, near: Touch) -> Option<Bend> {
        let at = |unknowns: Vector2<f64>| Touch { place: unknowns.x, force: unknowns.y }.load();
        let solution = newton::solve(Vector2::new(near.place, near.force), REACH, |unknowns| {
            let load = at(unknowns);
            let Shot { root, moment: held, .. } = Shot::of(&load, self.taper)?;
            let (across, along) = (load.angle - root.value).sin_cos();
            // The derivatives of the angle of the force to the shaft at the base, and of the moment, by the place.
            let (turn, moment_by_place) = if unknowns.x < 0.0 {
                (-load.contact * root.by_contact, load.contact * held.by_contact)
            } else {
                (1.0 - root.by_angle, held.by_angle)
            };
            Some(Residual {
                value: Vector2::new(held.value - moment, load.force * across - shear),
                slope: Matrix2::new(
                    moment_by_place,
                    load.force * held.by_force,
                    load.force * along * turn,
                    load.force * (across - load.force * along * root.by_force),
                ),
            })
        })?;
        let load = at(solution);
        let shot = Shot::of(&load, self.taper)?;
        let stays = 1.0 - shot.root.by_angle + self.hinge_compliance * shot.moment.by_angle > 0.0;
        if stays && load.angle < PI { self.bend(&load, &shot) } else { None }
    }
}
