//! A true array.

use super::Loss;
use super::Property as P;
use super::ranges::Values;
use crate::physics::Physics;
use vibrissa_runtime::rig::Rig;

/// The true array: the rig, and the errors of its measurements and commands.
#[derive(Debug, Clone, PartialEq)]
pub struct TrueArray {
    /// The true rig. Its sensing is the assumed one.
    pub rig: Rig,
    /// The errors of the sensor of every whisker.
    pub sensors: Vec<SensorErrors>,
    /// Share of the lost readings, 0 to 1.
    pub lost: f64,
    /// The consequence of a lost reading.
    pub loss: Loss,
    /// The errors of measured poses.
    pub pose: PoseErrors,
    /// Time from a command to its effect (s).
    pub command_latency: f64,
    /// Coefficient of sliding friction of all objects. `None` for that of the scene.
    pub friction: Option<f64>,
    /// The values for the physics settings.
    pub(super) values: Values,
}

/// The errors of the sensor of one whisker. Perception does not know them.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SensorErrors {
    /// Relative difference of the gain.
    pub gain: f64,
    /// Cubic term (1/rad²): a base angle `a` reads `a (1 + gain + cubic a²)`.
    pub cubic: f64,
    /// Reading without deflection (rad).
    pub offset: f64,
    /// Growth of the offset (rad/s).
    pub drift: f64,
    /// Standard deviation of the noise (rad).
    pub noise: f64,
    /// Resolution (rad). 0 means continuous.
    pub resolution: f64,
    /// Age of a reading in its sample (s).
    pub latency: f64,
}

/// The errors of measured poses. Perception does not know them.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PoseErrors {
    /// Standard deviations of the noise, independent in every sample: of each coordinate (m), and of the heading (rad).
    pub noise: (f64, f64),
    /// Standard deviations of the wander: of each coordinate (m), and of the heading (rad).
    pub wander: (f64, f64),
    /// Correlation time of the wander (s).
    pub wander_time: f64,
    /// Age of a pose in its sample (s).
    pub latency: f64,
}

/// Base angle (rad) at which [`P::Cubic`] is the relative difference.
const CUBIC_AT: f64 = 1e-3;
/// Seconds in a minute.
const MINUTE: f64 = 60.0;
/// Correlation time (s) of a wander without one.
const WANDER_TIME: f64 = 1.0;

impl TrueArray {
    /// True if samples and commands are exact, apart from the errors that perception knows.
    #[must_use]
    pub fn is_measured_exactly(&self) -> bool {
        let (no_error, no_pose_error) = (SensorErrors::default(), PoseErrors::default());
        let pose = PoseErrors { wander_time: no_pose_error.wander_time, ..self.pose };
        self.sensors.iter().all(|sensor| *sensor == no_error)
            && pose == no_pose_error
            && self.lost == 0.0
            && self.command_latency == 0.0
    }

    /// True if measurements have noise that perception does not know, or lost readings.
    #[must_use]
    pub fn is_noisy(&self) -> bool {
        let PoseErrors { noise, wander, .. } = self.pose;
        let poses = [noise.0, noise.1, wander.0, wander.1].into_iter();
        let sensors = self.sensors.iter().map(|sensor| sensor.noise);
        poses.chain(sensors).chain([self.lost]).any(|spread| spread > 0.0)
    }

    /// The physics settings for the true friction and contacts.
    #[must_use]
    pub fn physics(&self, assumed: &Physics) -> Physics {
        let mut physics = assumed.clone();
        if let Some(friction) = self.friction {
            physics.set_friction(friction, self.rig.sensing.sample_rate);
        }
        self.values.apply(&mut physics);
        physics
    }
}

impl SensorErrors {
    pub(super) fn new(values: &Values) -> Self {
        Self {
            gain: values.or_zero(P::Gain),
            cubic: values.or_zero(P::Cubic) / (CUBIC_AT * CUBIC_AT),
            offset: values.or_zero(P::Offset),
            drift: values.or_zero(P::Drift) / MINUTE,
            noise: values.or_zero(P::Noise),
            resolution: values.or_zero(P::Resolution),
            latency: values.or_zero(P::SensorLatency),
        }
    }
}

impl PoseErrors {
    pub(super) fn new(values: &Values) -> Self {
        Self {
            noise: (values.or_zero(P::PoseNoise), values.or_zero(P::HeadingNoise)),
            wander: (values.or_zero(P::PoseWander), values.or_zero(P::HeadingWander)),
            wander_time: values.get(P::WanderTime).unwrap_or(WANDER_TIME),
            latency: values.or_zero(P::PoseLatency),
        }
    }
}
