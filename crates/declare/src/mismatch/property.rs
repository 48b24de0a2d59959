//! The properties.

use super::Difference;

/// A property in which the true array may differ from the assumed one.
///
/// A whisker's property has one value for each whisker. "Backward" is the direction of rotation away from the heading,
/// so that one value is symmetric for both sides of the platform. [`DIFFERENCES`](super::DIFFERENCES) has the meanings.
#[expect(missing_docs, reason = "the table below has the meaning of each one")]
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Property {
    Stiffness,
    Radius,
    TipRadius,
    Length,
    TipAside,
    Links,
    Hinge,
    BaseForward,
    BaseOutward,
    Direction,
    Gain,
    Cubic,
    Offset,
    Drift,
    Noise,
    Resolution,
    SensorLatency,
    Lost,
    PoseNoise,
    HeadingNoise,
    PoseWander,
    HeadingWander,
    WanderTime,
    PoseLatency,
    CommandLatency,
    Servo,
    Friction,
    /// The key of the rig with this path.
    Rig(&'static str),
}

impl Property {
    /// All properties. Values are drawn in this order.
    pub fn all() -> impl Iterator<Item = Self> {
        Difference::all().map(|difference| difference.property)
    }
}
