//! A frictionless contact in two coordinates.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Matrix2, Matrix3x2, Vector2};

use crate::geometry::{perpendicular, unit};
use crate::math;

use super::elastica::Elastica;
use super::shaft_shape::ShaftShape;
use super::shot::{Load, Shot, Varied};

/// A frictionless contact in two coordinates. In them, contacts of the shaft and of the tip form one continuous plane.
#[derive(Debug, Clone, Copy)]
pub(super) struct FrictionlessContact {
    /// Position of the contact, or direction of the force.
    ///
    /// Below 0 the contact is on the shaft. The coordinate is then the logarithm of the contact's length over the length
    /// of the shaft. From 0 on the contact is at the tip. The coordinate then gives the angle between the force and a force
    /// straight against the shaft: `π/2 exp(−2 position / π)`.
    pub(super) position: f64,
    /// Logarithm of the force, in the unit of [`Load`].
    pub(super) force: f64,
}

/// A quantity of a contact with its derivatives by the two coordinates.
#[derive(Debug, Clone, Copy)]
pub(super) struct Change {
    /// Value.
    pub(super) value: f64,
    /// Derivative by the first coordinate.
    pub(super) by_position: f64,
    /// Derivative by the second coordinate.
    pub(super) by_force: f64,
}

/// A contact and the state of the shaft under it.
#[derive(Debug, Clone, Copy)]
pub(super) struct LoadedContact {
    /// The contact.
    pub(super) contact: FrictionlessContact,
    /// The shaft from the contact to the base.
    pub(super) shot: Shot,
    /// Bending moment and shear at the base.
    pub(super) moment: Change,
    pub(super) shear: Change,
    /// Direction of the force in the frame of the base (rad).
    direction: Change,
    /// Position of the contact, in a frame at the base whose first axis has the direction of the force.
    along: Change,
    left: Change,
}

impl FrictionlessContact {
    /// The coordinates of the contact of a shape.
    pub(super) fn of(shape: &ShaftShape, elastica: &Elastica) -> Self {
        let length = shape.contact_length / elastica.length;
        let position = if length < 1.0 {
            math::ln(length)
        } else {
            let from_against = PI - (shape.force_direction - shape.tip_angle);
            FRAC_PI_2 * math::max(math::ln(FRAC_PI_2 / from_against), 0.0)
        };
        Self { position, force: math::ln(shape.force / elastica.force_unit) }
    }

    /// An approximation of the contact with a base moment, and with the given ratio of shear to moment. It is that of a
    /// uniform shaft with a small bend: a cantilever for a contact of the shaft, and a strut for a tip contact. For the
    /// strut the ratio is `k cot k` with the square `k²` of the force.
    pub(super) fn about(moment: f64, ratio: f64, taper: f64) -> Self {
        let softer = taper * taper;
        if ratio >= 1.0 {
            let contact = math::min(ratio.recip(), softer / moment);
            return Self { position: math::ln(contact), force: math::ln(moment / contact) };
        }
        // 1 − π² k² / 3 / (π² − k²) has the same value and slope at 0 and the same pole. Its error is at most 0.1 above
        // −1.
        let square = PI * PI * (1.0 - ratio) / (PI * PI / 3.0 + 1.0 - ratio);
        let k = square.sqrt();
        let from_against = moment / (k * math::sin(k) * softer);
        Self {
            position: FRAC_PI_2 * math::max(math::ln(FRAC_PI_2 / from_against), 0.0),
            force: math::ln(square * softer),
        }
    }

    /// The load at this contact.
    pub(super) fn load(self) -> Load {
        let angle = PI - FRAC_PI_2 * math::exp(-math::max(self.position, 0.0) / FRAC_PI_2);
        Load { contact: math::exp(math::min(self.position, 0.0)), angle, force: math::exp(self.force) }
    }
}

impl Elastica {
    /// The state of the shaft under a contact. `None` if the contact does not bend it to the left everywhere.
    pub(super) fn loaded(&self, contact: FrictionlessContact) -> Option<LoadedContact> {
        let load = contact.load();
        let shot = Shot::of(&load, self.taper)?;
        if !shot.bends_left {
            return None;
        }
        let is_at_tip = contact.position >= 0.0;
        let by_position = if is_at_tip { (PI - load.angle) / FRAC_PI_2 } else { load.contact };
        let change = |varied: &Varied| Change {
            value: varied.value,
            by_position: by_position * if is_at_tip { varied.by_angle } else { varied.by_contact },
            by_force: load.force * varied.by_force,
        };
        let (root, moment, lever) = (change(&shot.root), change(&shot.moment), change(&shot.lever));
        let angle_by_position = if is_at_tip { by_position } else { 0.0 };
        // The angle from the shaft at the base to the force.
        let at_base = Change {
            value: load.angle - root.value,
            by_position: angle_by_position - root.by_position,
            by_force: -root.by_force,
        };
        let (sin, cos) = math::sin_cos(at_base.value);
        let turned = load.force * cos;
        Some(LoadedContact {
            contact,
            shear: Change {
                value: load.force * sin,
                by_position: turned * at_base.by_position,
                by_force: load.force * sin + turned * at_base.by_force,
            },
            direction: Change {
                value: self.hinge_compliance * moment.value + at_base.value,
                by_position: self.hinge_compliance * moment.by_position + at_base.by_position,
                by_force: self.hinge_compliance * moment.by_force + at_base.by_force,
            },
            along: change(&shot.along),
            left: Change { value: -lever.value, by_position: -lever.by_position, by_force: -lever.by_force },
            moment,
            shot,
        })
    }
}

impl LoadedContact {
    /// Derivatives of the contact position by the two coordinates, along the direction of the force and to its left.
    fn moved(&self) -> Matrix2<f64> {
        let Self { along, left, direction, .. } = self;
        Matrix2::new(
            along.by_position - left.value * direction.by_position,
            along.by_force - left.value * direction.by_force,
            left.by_position + along.value * direction.by_position,
            left.by_force + along.value * direction.by_force,
        )
    }

    /// True if the contact is stable while the object stays fixed. A contact becomes unstable where it could move
    /// without a motion of the object. At the tip, the direction of a straight surface and its distance are fixed, and
    /// on the shaft a point. Their derivatives by the two coordinates form a matrix. Its determinant is positive from
    /// the straight shaft up to the limit of stability.
    pub(super) fn is_stable(&self) -> bool {
        if self.contact.position >= 0.0 {
            let Self { along, direction, .. } = self;
            direction.by_position * along.by_force - direction.by_force * along.by_position > 0.0
        } else {
            self.moved().determinant() > 0.0
        }
    }

    /// See [`Elastica::changes`]. `shape` is that of this contact.
    pub(super) fn by_readings(&self, elastica: &Elastica, shape: &ShaftShape) -> Option<Matrix3x2<f64>> {
        let readings = Matrix2::new(
            elastica.hinge_compliance * self.moment.by_position,
            elastica.hinge_compliance * self.moment.by_force,
            elastica.force_unit * self.shear.by_position,
            elastica.force_unit * self.shear.by_force,
        );
        let forward: Vector2<f64> = unit(shape.force_direction);
        let position = Matrix2::from_columns(&[forward, perpendicular(forward)]) * self.moved() * elastica.length;
        let direction = [self.direction.by_position, self.direction.by_force];
        let all = Matrix3x2::new(position.m11, position.m12, position.m21, position.m22, direction[0], direction[1]);
        Some(all * readings.try_inverse()?)
    }
}
