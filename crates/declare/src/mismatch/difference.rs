//! The properties with their keys in a mismatch.

use std::f64::consts::FRAC_PI_2;

use vibrissa_runtime::units::{Dimension, Key};

use super::Property;
use crate::rig::{KEYS, RigKey};

/// What a mismatch does with the number of a key of the rig.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Change {
    /// The number grows by a share of itself.
    Relative,
    /// The value is added.
    Added,
    /// The value replaces the number. It is drawn with uniform density of its logarithm, because it is positive.
    Replaced,
}

impl Change {
    /// Changes a number.
    pub fn apply(self, number: &mut f64, value: f64) {
        match self {
            Self::Relative => *number *= 1.0 + value,
            Self::Added => *number += value,
            Self::Replaced => *number = value,
        }
    }

    pub(crate) const fn about(self) -> &'static str {
        match self {
            Self::Relative => "relative difference from the key of the rig",
            Self::Added => "difference from the key of the rig",
            Self::Replaced => "true value of the key of the rig, drawn by its logarithm",
        }
    }
}

/// What has a value of a property.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scope {
    /// Each whisker.
    Whisker,
    /// The whole array.
    Array,
}

/// A property with its key in a mismatch.
#[derive(Debug, Clone, Copy)]
pub struct Difference {
    /// The property.
    pub property: Property,
    /// The keys that lead to it, separated by points.
    pub path: &'static str,
    /// The dimension.
    pub dimension: Dimension,
    /// The smallest and the largest value, in SI units.
    pub range: (f64, f64),
    /// A possible value, for messages.
    pub example: &'static str,
    /// The meaning, for the documentation.
    pub about: &'static str,
    /// What has a value of it.
    pub scope: Scope,
    /// The key of the rig that it changes, if it changes that one alone.
    pub of: Option<(&'static str, Change)>,
}

impl Difference {
    const fn new(property: Property, path: &'static str, dimension: Dimension, range: (f64, f64)) -> Self {
        Self { property, path, dimension, range, example: "", about: "", scope: Scope::Whisker, of: None }
    }

    const fn relative(property: Property, path: &'static str) -> Self {
        Self::new(property, path, Dimension::NUMBER, (-0.9, 10.0))
    }

    const fn length(property: Property, path: &'static str) -> Self {
        Self::new(property, path, Dimension::LENGTH, (-0.1, 0.1))
    }

    /// An age that is at most a second.
    const fn age(property: Property, path: &'static str) -> Self {
        Self::new(property, path, Dimension::TIME, (0.0, 1.0))
    }

    const fn of_array(self) -> Self {
        Self { scope: Scope::Array, ..self }
    }

    const fn of(self, path: &'static str, change: Change) -> Self {
        Self { of: Some((path, change)), ..self }
    }

    const fn about(self, example: &'static str, about: &'static str) -> Self {
        Self { example, about, ..self }
    }

    /// True if the logarithm of a value is drawn with uniform density, and not the value.
    #[must_use]
    pub fn is_logarithmic(&self) -> bool {
        matches!(self.of, Some((_, Change::Replaced)))
    }

    /// The key with its range.
    #[must_use]
    pub fn key(&self) -> Key {
        Key::new(self.path.rsplit('.').next().unwrap_or(self.path), self.dimension, self.range, self.example)
    }

    /// All differences. Values are drawn in this order, so a new one changes only those behind it.
    pub fn all() -> impl Iterator<Item = Self> {
        DIFFERENCES.into_iter().chain(KEYS.iter().filter_map(RigKey::difference))
    }
}

use Difference as D;
use Property as P;

/// The differences that are not those of a single key of the rig, or that have another name. A value depends on the place of
/// its entry.
#[rustfmt::skip] // A difference is a line, as in a table.
pub const DIFFERENCES: [Difference; 27] = [
    D::relative(P::Stiffness, "stiffness").of("whiskers.*.young_modulus", Change::Relative).about("5 %", "relative difference of Young's modulus"),
    D::relative(P::Radius, "radius")
        .about("-1 %", "relative difference of the radius of the whole shaft. The stiffness changes with its fourth power"),
    D::relative(P::TipRadius, "tip_radius").about("-5 %", "relative difference of the radius at the tip, in addition"),
    D::length(P::Length, "length").of("whiskers.*.length", Change::Added).about("0.5 mm", "difference of the length"),
    D::length(P::TipAside, "tip_aside").about("1 mm", "distance of the tip from a straight shaft, positive backward. The shaft is an arc at rest"),
    D::new(P::Links, "links", Dimension::NUMBER, (4.0, 64.0)).about("32", "number of links of the simulated chain"),
    D::relative(P::Hinge, "hinge").of("whiskers.*.hinge.stiffness", Change::Relative)
        .about("5 %", "relative difference of the stiffness of the base hinge"),
    D::length(P::BaseForward, "base.forward").about("0.5 mm", "displacement of the base along the heading"),
    D::length(P::BaseOutward, "base.outward").about("0.5 mm", "displacement of the base away from the axis of the platform"),
    D::new(P::Direction, "direction", Dimension::ANGLE, (-FRAC_PI_2, FRAC_PI_2))
        .about("1 deg", "rotation of the shaft's direction, positive backward"),
    D::relative(P::Gain, "sensor.gain").about("2 %", "relative difference of the gain"),
    D::new(P::Cubic, "sensor.cubic", Dimension::NUMBER, (-10.0, 10.0))
        .about("1 %", "relative difference of the reading at 1 mrad because of a cubic term"),
    D::new(P::Offset, "sensor.offset", Dimension::ANGLE, (-1.0, 1.0)).about("2 urad", "reading without deflection, counter-clockwise"),
    D::new(P::Drift, "sensor.drift_per_minute", Dimension::ANGLE, (-1.0, 1.0)).about("5 urad", "growth of the offset in a minute"),
    D::new(P::Noise, "sensor.noise", Dimension::ANGLE, (0.0, 1.0)).about("0.5 urad", "standard deviation of noise in each sample"),
    D::new(P::Resolution, "sensor.resolution", Dimension::ANGLE, (0.0, 1.0)).about("0.034 urad", "resolution of a reading"),
    D::age(P::SensorLatency, "sensor.latency").about("5 ms", "age of a reading in its sample"),
    D::new(P::Lost, "sensor.lost.share", Dimension::NUMBER, (0.0, 1.0)).of_array().about("1 %", "share of the lost readings"),
    D::new(P::PoseNoise, "pose.noise.position", Dimension::LENGTH, (0.0, 0.1)).of_array()
        .about("0.05 mm", "standard deviation of noise of each coordinate in each sample"),
    D::new(P::HeadingNoise, "pose.noise.heading", Dimension::ANGLE, (0.0, 0.5)).of_array()
        .about("0.02 deg", "standard deviation of noise of the heading in each sample"),
    D::new(P::PoseWander, "pose.wander.position", Dimension::LENGTH, (0.0, 0.1)).of_array()
        .about("0.05 mm", "standard deviation of an error of each coordinate that changes slowly"),
    D::new(P::HeadingWander, "pose.wander.heading", Dimension::ANGLE, (0.0, 0.5)).of_array()
        .about("0.02 deg", "standard deviation of an error of the heading that changes slowly"),
    D::new(P::WanderTime, "pose.wander.time", Dimension::TIME, (1e-3, 1e4)).of_array()
        .about("1 s", "correlation time of these errors, 1 s if it is omitted"),
    D::age(P::PoseLatency, "pose.latency").of_array().about("10 ms", "age of a pose in its sample"),
    D::age(P::CommandLatency, "command.latency").of_array().about("33 ms", "time from a command to its effect, rounded to sample periods"),
    D::new(P::Servo, "servo", Dimension::TIME, (1e-3, 10.0)).of_array()
        .about("100 ms", "true time constant of the servos, for velocities, and for yaw rates without `yaw_servo`"),
    D::new(P::Friction, "friction", Dimension::NUMBER, (0.0, 10.0)).of_array()
        .about("0.1", "true coefficient of friction of all objects. Steps and contacts of the simulation become as short as friction needs"),
];
