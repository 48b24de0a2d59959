//! The interface between machine and perception.

use serde::{Deserialize, Serialize};

use crate::geometry::Vector2;

/// Perception as a machine sees it. The machine asks only for values that its active states need.
///
/// Whiskers are identified by their index in the program's list of whiskers. The contour of a whisker has the index of
/// the whisker. Contours through positions follow, in the order of the program's list of contours.
pub trait Senses {
    /// Time since the start of the run (s).
    fn time(&self) -> f64;

    /// A scalar of the body. Booleans are 1 and 0.
    fn body(&self, quantity: BodyScalar) -> f64;

    /// Position of the platform's centre of mass in the world frame (m).
    fn body_position(&self) -> Vector2;

    /// A scalar of a whisker or of a contour. Booleans are 1 and 0.
    fn whisker(&self, whisker: usize, quantity: WhiskerScalar) -> f64;

    /// A vector of a whisker or of a contour.
    fn whisker_vector(&self, whisker: usize, quantity: WhiskerVector) -> Vector2;

    /// The contact position of the whisker's tip (m, frame of the base) for a hypothetical base angle (rad).
    fn tip_at(&self, whisker: usize, base_angle: f64) -> Vector2;

    /// True if the tip that the whisker recorded in the previous tick closes a loop: it is within a distance `within` (m) of
    /// the first ones, and at least the time `after` (s) later. The body has moved around since.
    fn loop_closed(&self, whisker: usize, within: f64, after: f64) -> bool;

    /// A vector of a contour at the distance `back` (m) behind its end.
    fn contour_at(&self, contour: usize, back: f64, quantity: ContourVector) -> Vector2;

    /// Records the whisker's tip as a point of the estimated contour, if the whisker is in contact.
    fn record(&mut self, whisker: usize);

    /// Records a position (m, world frame) as a point of the contour with this index in the program's list of contours.
    fn record_position(&mut self, contour: usize, position: Vector2);

    /// Records a mark. No readable value depends on marks. The default ignores them.
    fn mark(&mut self, _whisker: usize, _mark: Mark) {}

    /// A scalar of the map. Booleans are 1 and 0. The default has no map, and nothing is known.
    fn map(&self, _quantity: MapScalar) -> f64 {
        f64::NAN
    }

    /// A vector of the map. The default has no map.
    fn map_vector(&self, _quantity: MapVector) -> Vector2 {
        Vector2::new(f64::NAN, f64::NAN)
    }

    /// True if a statement about a pose holds in the map. The default has no map, and nothing is proved.
    fn map_holds(&self, _question: MapQuestion, _position: Vector2, _heading: f64) -> bool {
        false
    }

    /// Sets the goal of the map's route: a position (m) and a heading (rad) of the body. The default has no map.
    fn go_to(&mut self, _position: Vector2, _heading: f64) {}

    /// Tells the map that its next target could not be touched. The default has no map.
    fn give_up(&mut self) {}

    /// Tells the map that something was felt at a position (m), with free ground in a direction. The default has no map.
    fn felt(&mut self, _position: Vector2, _normal: Vector2) {}
}

/// Scalars and booleans of the map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum MapScalar {
    /// Area (m²) of unknown ground beside free ground.
    Unknown,
    /// True if nothing is left to be touched or looked at.
    IsComplete,
    /// True if there is a next target.
    HasNext,
    /// True if the next target is at a surface, and not unknown ground.
    NextIsSurface,
    /// Side of the whisker for the next target: −1 for one on the right, +1 for one on the left.
    NextSide,
    /// Heading (rad) of the body from which the next target is begun.
    NextHeading,
    /// Speed (m/s) along the route.
    RouteSpeed,
    /// Yaw rate (rad/s) along the route.
    RouteYawRate,
    /// True if the body is at the goal.
    RouteIsDone,
    /// True if no route leads to the goal.
    RouteIsLost,
}

impl MapScalar {
    /// True if the scalar is a boolean.
    #[must_use]
    pub fn is_bool(self) -> bool {
        matches!(self, Self::IsComplete | Self::HasNext | Self::NextIsSurface | Self::RouteIsDone | Self::RouteIsLost)
    }
}

/// Vectors of the map, in the world frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum MapVector {
    /// Place of the next target (m).
    NextPlace,
    /// Unit vector from the next target to free ground.
    NextNormal,
    /// Position of the body from which the next target is begun (m).
    NextPosition,
    /// Direction of motion along the route (unit vector, or zero at a standstill).
    RouteDirection,
}

/// Statements about a pose that a map can prove.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum MapQuestion {
    /// The position is proved free.
    IsFree,
    /// The ground of the body at the pose is proved free.
    IsClear,
    /// A contour was recorded at the position, up to 10 mm.
    IsTraced,
}

crate::kinds! {
    /// A mark of a policy for the evaluation of a run.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum Mark,
    /// The keyword of this mark in a policy.
    fn name {
        /// The whisker has lost the object at an edge.
        Lost = "lost",
        /// The whisker has found contact again.
        Found = "found",
    }
}

/// Scalars and booleans of the body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum BodyScalar {
    /// Heading in the world frame (rad).
    Yaw,
    /// True if something other than the whiskers prevents the body from following its commands.
    Blocked,
    /// Difference (m/s) between the commanded and the actual speed, at the corner of the body with the largest one.
    Shortfall,
    /// Length of the body from tail to nose (m).
    Length,
    /// Greatest width of the body (m).
    Width,
    /// Width of the body at the nose (m).
    NoseWidth,
    /// Width of the body at the tail (m).
    TailWidth,
    /// Distance of the nose ahead of the centre of mass (m).
    NoseReach,
    /// Ratio of the base angles of the first bound whisker and of the reference whisker, bent to the same shape.
    Flexibility,
    /// Time (s) in which the first bound whisker, moving freely, comes nearer to rest by a factor e.
    Decay,
    /// Ratio of the base angles of the first bound whisker and of the reference whisker, by their inertia under the same
    /// acceleration.
    Sway,
}

/// Scalars and booleans of a whisker.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum WhiskerScalar {
    /// Filtered base angle (rad, counter-clockwise positive).
    BaseAngle,
    /// True if the base angle exceeds the contact threshold: that of the rig, or five of its standard deviations.
    Touching,
    /// Direction of the undeflected shaft in the world frame (rad).
    Yaw,
    /// −1 for a whisker on the right, +1 for one on the left.
    Side,
    /// +1 if bent as by forward motion, −1 if bent oppositely, 0 without contact.
    Sense,
    /// Length of the shaft (m).
    Length,
    /// True if there are enough keypoints for a tangent of the local contour.
    ContourReady,
    /// Curvature at the end of the contour (rad/m, counter-clockwise positive in the direction of travel).
    ContourCurvature,
    /// Standard deviation of the contact position of the tip (m).
    TipDeviation,
    /// True if the rig has the whisker.
    Fitted,
    /// Standard deviation of the filtered base angle (rad).
    BaseAngleDeviation,
    /// Standard deviation from the outline with which the tip is recorded (m).
    RecordedDeviation,
}

impl WhiskerScalar {
    /// True if every contour has the scalar, also one without a whisker.
    #[must_use]
    pub fn is_of_contour(self) -> bool {
        matches!(self, Self::ContourReady | Self::ContourCurvature)
    }
}

/// Vectors of a whisker.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum WhiskerVector {
    /// Contact position of the tip in the world frame (m).
    Tip,
    /// Contact position of the tip in the frame of the whisker's base (m).
    TipBase,
    /// Position of the base in the world frame (m).
    Base,
    /// Direction of travel at the end of the contour in the world frame (unit vector).
    ContourTangent,
    /// Newest point of the contour in the world frame (m).
    ContourEnd,
    /// Unit normal at the end of the contour in the world frame, pointing away from the object. It is perpendicular to
    /// the direction of travel. Its side is that of the whisker's base when the newest point was recorded. It is the left
    /// side for a contour through positions.
    ContourNormal,
}

impl WhiskerVector {
    /// True if every contour has the vector, also one without a whisker.
    #[must_use]
    pub fn is_of_contour(self) -> bool {
        matches!(self, Self::ContourTangent | Self::ContourEnd | Self::ContourNormal)
    }
}

/// Vectors of a contour at a distance behind its end, in the world frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ContourVector {
    /// Position (m).
    Point,
    /// Direction of travel (unit vector).
    Tangent,
    /// Direction away from the object (unit vector).
    Normal,
}
