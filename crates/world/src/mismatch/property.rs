//! The properties in which the true array may differ from the assumed one.

/// A property in which the true array may differ from the assumed one.
///
/// A whisker's property has one value for each whisker. "Backward" is the direction of rotation away from the heading,
/// so that one value is symmetric for both sides of the platform.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Property {
    /// Whisker: relative difference of Young's modulus.
    Stiffness,
    /// Whisker: relative difference of the radius, along the whole shaft.
    Radius,
    /// Whisker: relative difference of the radius at the tip, in addition.
    TipRadius,
    /// Whisker: difference of the length (m).
    Length,
    /// Whisker: distance (m) of the tip from a straight shaft because of uniform curvature, positive backward.
    TipAside,
    /// Whisker: number of links of the simulated chain.
    Links,
    /// Whisker: relative difference of the stiffness of the base hinge.
    Hinge,
    /// Whisker: displacement of the base along the heading (m).
    BaseForward,
    /// Whisker: displacement of the base away from the axis of the platform (m).
    BaseOutward,
    /// Whisker: rotation of the shaft's direction (rad), positive backward.
    Direction,
    /// Sensor of a whisker: relative difference of the gain.
    Gain,
    /// Sensor of a whisker: relative difference of the reading at 1 mrad because of a cubic term.
    Cubic,
    /// Sensor of a whisker: reading without deflection (rad).
    Offset,
    /// Sensor of a whisker: growth of the offset (rad per minute).
    Drift,
    /// Sensor of a whisker: standard deviation of the noise (rad), in addition to the noise that perception knows.
    Noise,
    /// Sensor of a whisker: resolution (rad).
    Resolution,
    /// Sensor of a whisker: age of a reading in its sample (s).
    SensorLatency,
    /// Sensors: share of the lost readings, 0 to 1.
    Lost,
    /// Pose: standard deviation of the noise of each coordinate (m), independent in every sample.
    PoseNoise,
    /// Pose: standard deviation of the noise of the heading (rad), independent in every sample.
    HeadingNoise,
    /// Pose: standard deviation of the wander of each coordinate (m).
    PoseWander,
    /// Pose: standard deviation of the wander of the heading (rad).
    HeadingWander,
    /// Pose: correlation time of the wander (s).
    WanderTime,
    /// Pose: age of a pose in its sample (s).
    PoseLatency,
    /// Commands: time from a command to its effect (s).
    CommandLatency,
    /// Platform: time constant of the servos (s).
    Servo,
    /// Objects: coefficient of sliding friction.
    Friction,
}

impl Property {
    /// All properties. Values are drawn in this order.
    pub const ALL: [Self; 27] = [
        Self::Stiffness,
        Self::Radius,
        Self::TipRadius,
        Self::Length,
        Self::TipAside,
        Self::Links,
        Self::Hinge,
        Self::BaseForward,
        Self::BaseOutward,
        Self::Direction,
        Self::Gain,
        Self::Cubic,
        Self::Offset,
        Self::Drift,
        Self::Noise,
        Self::Resolution,
        Self::SensorLatency,
        Self::Lost,
        Self::PoseNoise,
        Self::HeadingNoise,
        Self::PoseWander,
        Self::HeadingWander,
        Self::WanderTime,
        Self::PoseLatency,
        Self::CommandLatency,
        Self::Servo,
        Self::Friction,
    ];
}
