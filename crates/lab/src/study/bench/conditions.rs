//! Conditions of the bench beyond the baseline's.

use std::fmt;

use serde::Serialize;

use vibrissa_world::scene::Scene;

/// Friction and estimated sensor noise. The baseline's scenes have neither.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Conditions {
    /// Coefficient of sliding friction of all objects. The contact estimator assumes the same coefficient, as if it had
    /// been calibrated on such a surface.
    pub friction: f64,
    /// True if sensors have the noise and the resolution that are estimated for the real sensor.
    pub noise: bool,
}

impl Conditions {
    /// True without friction and noise.
    #[must_use]
    pub fn are_ideal(self) -> bool {
        self == Self::default()
    }

    /// The name of a scenario followed by the conditions.
    #[must_use]
    pub fn named(self, scenario: &str) -> String {
        if self.are_ideal() { scenario.to_owned() } else { format!("{scenario}, {self}") }
    }

    /// Sets friction and noise of a scene.
    pub fn apply(self, scene: &mut Scene) {
        let Scene { rig, physics, .. } = scene;
        if self.friction > 0.0 {
            physics.set_friction(self.friction, rig.sensing.sample_rate);
            rig.sensing.friction = self.friction;
        }
        if self.noise {
            rig.sensing.make_real();
        }
    }
}

impl fmt::Display for Conditions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.friction > 0.0, self.noise) {
            (false, false) => f.write_str("ideal"),
            (true, false) => write!(f, "friction {}", self.friction),
            (false, true) => f.write_str("noise"),
            (true, true) => write!(f, "friction {}, noise", self.friction),
        }
    }
}
