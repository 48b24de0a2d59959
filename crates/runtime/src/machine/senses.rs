//! What a machine can ask of perception.

use serde::{Deserialize, Serialize};

use crate::geometry::Vector2;

/// Perception as a machine sees it. Values are asked for only when the active state needs them.
///
/// Every whisker is named by its index in the program's list of whiskers.
pub trait Senses {
    /// Time since the start of the run (s).
    fn time(&self) -> f64;

    /// A number that belongs to the body; truths are 1 and 0.
    fn body(&self, quantity: BodyScalar) -> f64;

    /// Position of the platform's centre of mass in the world frame (m).
    fn body_position(&self) -> Vector2;

    /// A number that belongs to a whisker; truths are 1 and 0.
    fn whisker(&self, whisker: usize, quantity: WhiskerScalar) -> f64;

    /// A vector that belongs to a whisker.
    fn whisker_vector(&self, whisker: usize, quantity: WhiskerVector) -> Vector2;

    /// Where the whisker's tip would touch, in the frame of its base (m), if its base angle were `base_angle` (rad).
    fn tip_at(&self, whisker: usize, base_angle: f64) -> Vector2;

    /// A vector of the whisker's contour at the distance `back` (m) behind its end.
    fn contour_at(&self, whisker: usize, back: f64, quantity: ContourVector) -> Vector2;

    /// Takes the whisker's tip, if it touches, as a point of the estimated contour.
    fn record(&mut self, whisker: usize);

    /// Takes note of what has become of the whisker's contact. Nothing that can be read depends on it; by default nobody notes it.
    fn mark(&mut self, _whisker: usize, _mark: Mark) {}
}

/// What a policy can note of a whisker's contact, for whoever looks at the run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Mark {
    /// The object's edge was lost.
    Lost,
    /// Contact was found again.
    Found,
}

impl Mark {
    /// Every mark.
    pub const ALL: [Self; 2] = [Self::Lost, Self::Found];

    /// The word that stands for it in a policy.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Lost => "lost",
            Self::Found => "found",
        }
    }
}

/// Numbers and truths that belong to the body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum BodyScalar {
    /// Heading in the world frame (rad).
    Yaw,
    /// Whether something other than its whiskers keeps the body from following its commands.
    Blocked,
    /// The speed that the body lacks against what its commands ask for (m/s), at the corner that lacks most.
    Shortfall,
}

/// Numbers and truths that belong to a whisker.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum WhiskerScalar {
    /// Filtered base angle (rad, counter-clockwise positive).
    BaseAngle,
    /// Whether the base angle is beyond the rig's contact threshold.
    Touching,
    /// Direction of the undeflected shaft in the world frame (rad).
    Yaw,
    /// −1 for a whisker on the right, +1 for one on the left.
    Side,
    /// +1 when bent as forward motion bends it, −1 when bent the other way, 0 when not touching.
    Sense,
    /// Length of the shaft (m).
    Length,
    /// Whether the contour behind the tip is known well enough to have a tangent.
    ContourReady,
    /// Curvature at the end of the contour (rad/m, counter-clockwise positive in the direction of travel).
    ContourCurvature,
    /// How far off the place of the tip's contact may be (m): a standard deviation.
    TipDeviation,
    /// Whether the rig has it.
    Fitted,
}

/// Vectors that belong to a whisker.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum WhiskerVector {
    /// Place of the tip's contact in the world frame (m).
    Tip,
    /// Place of the tip's contact in the frame of the whisker's base (m).
    TipBase,
    /// Place of the base in the world frame (m).
    Base,
    /// Direction of travel at the end of the contour in the world frame (unit vector).
    ContourTangent,
    /// Newest point of the contour in the world frame (m).
    ContourEnd,
    /// Direction away from the object at the end of the contour in the world frame (unit vector): square to the direction of
    /// travel, on the side on which the whisker's base was when the newest point was taken.
    ContourNormal,
}

/// Vectors of a contour somewhere behind its end, in the world frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ContourVector {
    /// The place (m).
    Point,
    /// Direction of travel (unit vector).
    Tangent,
    /// Direction away from the object (unit vector).
    Normal,
}
