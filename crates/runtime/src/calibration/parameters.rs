//! The parameters that touches of a known object determine.

use nalgebra::{SMatrix, SVector};

use crate::geometry::unit;
use crate::math;
use crate::mechanics::{Obstacle, TouchMechanics};
use crate::rig::Whisker;

use super::measured_whisker::MeasuredWhisker;

/// A parameter of a fit to touches, as a difference from the rig.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Parameter {
    /// Relative difference of the stiffness of the hinge. Bending stiffness and sensor gain have the same effect.
    Stiffness,
    /// Length of the shaft (m).
    Length,
    /// Direction of the undeflected shaft (rad).
    Direction,
    /// First coordinate of the base (m, body frame).
    BaseX,
    /// Second coordinate of the base (m, body frame).
    BaseY,
    /// Curvature of the shaft at rest (1/m), positive to its left.
    Curvature,
    /// Ratio of the radii at the tip and at the base.
    Taper,
    /// Reading of the whisker in the air (rad).
    Offset,
    /// Coefficient of friction on the known object, of a whisker at rest.
    Friction,
    /// Play of the hinge (rad): what is added to the base angle in the direction of the bend.
    Play,
    /// Displacement of the touched face (m) along its normal from where it was said to be.
    FaceHeight,
    /// Rotation of the touched face (rad, counter-clockwise) about the given point of it.
    FaceTurn,
}

impl Parameter {
    /// All parameters, in the order of vectors and covariances. The first [`WHISKER`](Self::WHISKER) are properties of
    /// the whisker, and a calibration keeps the first [`KEPT`](Self::KEPT).
    pub const ALL: [Self; COUNT] = [
        Self::Stiffness,
        Self::Length,
        Self::Direction,
        Self::BaseX,
        Self::BaseY,
        Self::Curvature,
        Self::Taper,
        Self::Offset,
        Self::Friction,
        Self::Play,
        Self::FaceHeight,
        Self::FaceTurn,
    ];
    /// Number of those that are properties of the whisker.
    pub const WHISKER: usize = 8;
    /// Number of those that a calibration keeps: these, and the friction.
    pub const KEPT: usize = 9;

    /// The name in messages and tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Stiffness => "stiffness",
            Self::Length => "length",
            Self::Direction => "direction",
            Self::BaseX => "base x",
            Self::BaseY => "base y",
            Self::Curvature => "curvature",
            Self::Taper => "taper",
            Self::Offset => "offset",
            Self::Friction => "friction",
            Self::Play => "play",
            Self::FaceHeight => "face height",
            Self::FaceTurn => "face turn",
        }
    }

    /// Its index in vectors and covariances.
    #[must_use]
    pub fn index(self) -> usize {
        self as usize
    }
}

/// Number of parameters.
pub(super) const COUNT: usize = 12;
/// A value for every parameter.
pub type Parameters = SVector<f64, COUNT>;
/// The covariance of all parameters.
pub type ParameterCovariance = SMatrix<f64, COUNT, COUNT>;

/// Steps of the parameters for derivatives.
const STEPS: [f64; COUNT] = [1e-5, 1e-6, 1e-5, 1e-6, 1e-6, 1e-4, 1e-5, 1e-9, 1e-4, 1e-9, 1e-6, 1e-5];

/// Tolerances of manufacture and mounting: the standard deviations of the parameters before any touch.
///
/// The stiffness of a round wire goes with the fourth power of its diameter, which is known to about a percent. Length
/// and base are those of a whisker that is glued by hand with the help of a ruler. A curved wire has its tip 1 mm aside
/// at a length of 100 mm.
#[must_use]
pub fn tolerances() -> Parameters {
    Parameters::from([0.05, 0.5e-3, 0.0175, 0.5e-3, 0.5e-3, 0.2, 0.015, 1e-5, 0.1, 1e-9, 1e-9, 1e-9])
}

/// The whisker with these parameters.
#[must_use]
pub(super) fn with_parameters(whisker: &Whisker, parameters: &Parameters) -> Whisker {
    let mut other = whisker.clone();
    other.hinge.stiffness *= 1.0 + parameters[Parameter::Stiffness.index()];
    other.shaft.length += parameters[Parameter::Length.index()];
    other.direction_body += parameters[Parameter::Direction.index()];
    other.base_body.x += parameters[Parameter::BaseX.index()];
    other.base_body.y += parameters[Parameter::BaseY.index()];
    other.shaft.curvature += parameters[Parameter::Curvature.index()];
    let taper = parameters[Parameter::Taper.index()];
    if taper != 0.0 {
        other.shaft.tip_radius = Some(other.shaft.radius * (whisker.shaft.taper() + taper));
    }
    other
}

/// The mechanics of a whisker with these parameters, and an obstacle (body frame) as its base sees it.
#[must_use]
pub(super) fn mechanics(whisker: &Whisker, parameters: &Parameters, obstacle: &Obstacle) -> (TouchMechanics, Obstacle) {
    let other = with_parameters(whisker, parameters);
    let friction = parameters[Parameter::Friction.index()];
    let obstacle = match *obstacle {
        Obstacle::Face { point, normal } => Obstacle::Face {
            point: point + parameters[Parameter::FaceHeight.index()] * unit(normal),
            normal: normal + parameters[Parameter::FaceTurn.index()],
        },
        pin @ Obstacle::Pin { .. } => pin,
    };
    (TouchMechanics::new(&other, friction), obstacle.seen_from(other.base_pose()))
}

/// The parameters on both sides of a point, for the derivative by one of them, and the difference between the two.
pub(super) fn beside(parameters: &Parameters, index: usize) -> ([Parameters; 2], f64) {
    let at = |by: f64| {
        let mut beside = *parameters;
        beside[index] += by;
        beside
    };
    ([at(-STEPS[index]), at(STEPS[index])], 2.0 * STEPS[index])
}

/// The measured whisker with these parameters and their covariance, and with a friction and its standard deviation. The
/// friction is that of a whisker that slides. One at rest may have any smaller one.
#[must_use]
pub(super) fn measured(
    whisker: &Whisker,
    parameters: &Parameters,
    covariance: &ParameterCovariance,
    [friction, friction_deviation]: [f64; 2],
) -> MeasuredWhisker {
    let other = with_parameters(whisker, parameters);
    MeasuredWhisker {
        hinge_stiffness: other.hinge.stiffness,
        length: other.shaft.length,
        direction: other.direction_body,
        base: other.base_body.into(),
        curvature: other.shaft.curvature,
        taper: other.shaft.taper(),
        offset: parameters[Parameter::Offset.index()],
        friction: math::max(friction, 0.0),
        covariance: std::array::from_fn(|row| {
            std::array::from_fn(|column| match (row < Parameter::WHISKER, column < Parameter::WHISKER) {
                (true, true) => covariance[(row, column)],
                (false, false) => math::square(friction_deviation),
                _ => 0.0,
            })
        }),
    }
}
