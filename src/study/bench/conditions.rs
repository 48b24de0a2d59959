//! What makes the bench harder.

use std::fmt;

use serde::Serialize;

use crate::scene::Scene;

/// What makes a run of the bench harder than the thesis's scenes are: friction, and the estimated noise of the real sensor.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Conditions {
    /// Coefficient of sliding friction of whatever is touched. The tip model knows it, as one knows it that was calibrated on
    /// such a surface.
    pub friction: f64,
    /// Whether sensors have the noise and the resolution that the real one is estimated to have.
    pub noise: bool,
}

/// The longest step (s) and time constant of contacts (s) at which a tip slides steadily up to a friction of 0.3, and one that was
/// stuck and springs off sinks in by less than the limit.
const STEP: f64 = 1.0 / 3600.0;
const CONTACT_TIME: f64 = 1.25e-3;
/// How deep a tip may sink in (m) for a moment: one that was stuck springs off faster than one that slid.
const PENETRATION_LIMIT: f64 = 3e-3;

impl Conditions {
    /// Whether nothing is made harder.
    #[must_use]
    pub fn are_ideal(self) -> bool {
        self == Self::default()
    }

    /// The name of a scenario, and what makes it harder.
    #[must_use]
    pub fn named(self, scenario: &str) -> String {
        if self.are_ideal() { scenario.to_owned() } else { format!("{scenario}, {self}") }
    }

    /// Makes a scene so.
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
