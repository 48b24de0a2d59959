//! What is felt, as a test says.

use std::f64::consts::{FRAC_PI_2, PI};

use vibrissa_runtime::geometry::{Point2, Pose, Vector2, rotate, unit};
use vibrissa_runtime::machine::{BodyScalar, ContourVector, Senses, WhiskerScalar, WhiskerVector};

/// A whisker that is felt as a test says: 0 is on the right, 1 on the left.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Whisker {
    pub(crate) base_angle: f64,
    pub(crate) tangent: Vector2,
    pub(crate) ready: bool,
}

/// What is felt.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Felt {
    pub(crate) body: Pose,
    pub(crate) whiskers: [Whisker; 2],
    /// The direction (rad, body frame) of the left whisker.
    pub(crate) mounting: f64,
}

pub(crate) const SWEPT_BACK: f64 = 105.0 * PI / 180.0;
pub(crate) const LENGTH: f64 = 0.1;
pub(crate) const FREE: Whisker = Whisker { base_angle: 0.0, tangent: Vector2::new(1.0, 0.0), ready: false };

impl Felt {
    pub(crate) fn at(body: Pose) -> Self {
        Self { body, whiskers: [FREE; 2], mounting: SWEPT_BACK }
    }

    /// The same in a mirror that lies along x; left and right change places.
    pub(crate) fn mirrored(&self) -> Self {
        let whisker = |whisker: Whisker| Whisker {
            base_angle: -whisker.base_angle,
            tangent: flipped(whisker.tangent),
            ..whisker
        };
        let Self { body, whiskers: [right, left], mounting } = *self;
        let body = Pose { position: flipped(body.position.coords).into(), heading: -body.heading };
        Self { body, whiskers: [whisker(left), whisker(right)], mounting }
    }

    pub(crate) fn side(whisker: usize) -> f64 {
        if whisker == 0 { -1.0 } else { 1.0 }
    }

    pub(crate) fn base(&self, whisker: usize) -> Point2 {
        self.body.point_to_world(Point2::new(0.053, 0.03 * Self::side(whisker)))
    }

    pub(crate) fn yaw(&self, whisker: usize) -> f64 {
        self.body.heading + self.mounting * Self::side(whisker)
    }

    pub(crate) fn tip_at_rest(&self, whisker: usize) -> Point2 {
        self.base(whisker) + LENGTH * unit(self.yaw(whisker))
    }

    pub(crate) fn is_touching(&self, whisker: usize) -> bool {
        self.whiskers[whisker].base_angle.abs() > 2e-5
    }
}

pub(crate) fn flipped(vector: Vector2) -> Vector2 {
    Vector2::new(vector.x, -vector.y)
}

impl Senses for Felt {
    fn time(&self) -> f64 {
        0.0
    }

    fn body(&self, _: BodyScalar) -> f64 {
        self.body.heading
    }

    fn body_position(&self) -> Vector2 {
        self.body.position.coords
    }

    fn whisker(&self, whisker: usize, quantity: WhiskerScalar) -> f64 {
        let Whisker { base_angle, ready, .. } = self.whiskers[whisker];
        match quantity {
            WhiskerScalar::BaseAngle => base_angle,
            WhiskerScalar::Touching => f64::from(u8::from(self.is_touching(whisker))),
            WhiskerScalar::Yaw => self.yaw(whisker),
            WhiskerScalar::Side => Self::side(whisker),
            WhiskerScalar::Sense if self.is_touching(whisker) => base_angle.signum() * Self::side(whisker),
            WhiskerScalar::Length => LENGTH,
            WhiskerScalar::Fitted => 1.0,
            WhiskerScalar::ContourReady => f64::from(u8::from(ready)),
            WhiskerScalar::Sense
            | WhiskerScalar::ContourCurvature
            | WhiskerScalar::TipDeviation
            | WhiskerScalar::BaseAngleDeviation
            | WhiskerScalar::RecordedDeviation => 0.0,
        }
    }

    fn whisker_vector(&self, whisker: usize, quantity: WhiskerVector) -> Vector2 {
        let tip_base = self.tip_at(whisker, self.whiskers[whisker].base_angle);
        let tangent = self.whiskers[whisker].tangent;
        match quantity {
            WhiskerVector::TipBase => tip_base,
            WhiskerVector::Tip | WhiskerVector::ContourEnd => {
                self.base(whisker).coords + rotate(tip_base, self.yaw(whisker))
            }
            WhiskerVector::Base => self.base(whisker).coords,
            WhiskerVector::ContourTangent => tangent,
            WhiskerVector::ContourNormal => rotate(tangent, -FRAC_PI_2 * Self::side(whisker)),
        }
    }

    /// A whisker that bends like a circle, more than any does.
    fn tip_at(&self, _: usize, base_angle: f64) -> Vector2 {
        LENGTH * unit(500.0 * base_angle)
    }

    fn contour_at(&self, whisker: usize, _: f64, quantity: ContourVector) -> Vector2 {
        self.whisker_vector(
            whisker,
            match quantity {
                ContourVector::Point => WhiskerVector::ContourEnd,
                ContourVector::Tangent => WhiskerVector::ContourTangent,
                ContourVector::Normal => WhiskerVector::ContourNormal,
            },
        )
    }

    fn loop_closed(&self, _: usize, _: f64, _: f64) -> bool {
        false
    }

    fn record(&mut self, _: usize) {}

    fn record_position(&mut self, _: usize, _: Vector2) {}
}

/// The platform at the origin heading along x, one whisker bent by `base_angle` in units of its target, as forward motion does.
pub(crate) fn swiping(whisker: usize, bend: f64) -> Felt {
    let mut felt = Felt::at(Pose::default());
    let base_angle = 3e-4 * bend * Felt::side(whisker);
    felt.whiskers[whisker] = Whisker { base_angle, tangent: Vector2::new(1.0, 0.0), ready: true };
    felt
}
