//! Conditions of the bench beyond the baseline's.

use std::fmt;

use serde::Serialize;

use crate::scene::Scene;

/// Friction and estimated sensor noise. The baseline's scenes have neither.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Conditions {
    /// Coefficient of sliding friction of all objects. The contact estimator assumes the same coefficient, as if it had
    /// been calibrated on such a surface.
    pub friction: f64,
    /// True if sensors have the noise and the resolution that are estimated for the real sensor.
    pub noise: bool,
}

/// The longest step (s) and contact time constant (s) that suffice with friction. Up to a friction of 0.3 a tip slides
/// steadily, and a tip that snaps off after sticking penetrates less than the limit.
const STEP: f64 = 1.0 / 3600.0;
const CONTACT_TIME: f64 = 1.25e-3;
/// Largest short penetration depth of a tip (m). A tip that stuck snaps off faster than a sliding one.
const PENETRATION_LIMIT: f64 = 3e-3;

impl Conditions {
    /// True without friction and noise.
    #[must_use]
    pub(crate) fn are_ideal(self) -> bool {
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
            (physics.friction, rig.sensing.friction) = (self.friction, self.friction);
            let period = rig.sensing.sample_rate.recip();
            let steps = (period / physics.step.min(STEP) - 1e-9).ceil();
            physics.step = period / steps;
            physics.contact_time = physics.contact_time.min(CONTACT_TIME);
            physics.penetration_limit = physics.penetration_limit.max(PENETRATION_LIMIT);
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
