//! Conditions of the scenes of the bench.

use std::fmt;

use serde::Serialize;

use vibrissa_declare::physics::{ShaftModel, sag};
use vibrissa_world::scene::Scene;

/// Conditions beyond those of the baseline's scenes, which have none of them.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Conditions {
    /// Coefficient of sliding friction of all objects. The contact estimator assumes the same coefficient, as if it had
    /// been calibrated on such a surface.
    pub friction: f64,
    /// True if sensors have the noise and the resolution that are estimated for the real sensor.
    pub noise: bool,
    /// True if whiskers are round wires under gravity, whose pitch lifts their tips into the plane. Only MuJoCo simulates
    /// that.
    pub round: bool,
}

impl Conditions {
    /// The conditions of a real array. Its mismatch has friction and noise.
    pub const REAL: Self = Self { friction: 0.0, noise: false, round: true };

    /// True without any.
    #[must_use]
    pub fn are_ideal(self) -> bool {
        self == Self::default()
    }

    /// The name of a scenario followed by the conditions.
    #[must_use]
    pub fn named(self, scenario: &str) -> String {
        if self.are_ideal() { scenario.to_owned() } else { format!("{scenario}, {self}") }
    }

    /// Sets the conditions of a scene.
    pub fn apply(self, scene: &mut Scene) {
        let Scene { rig, physics, .. } = scene;
        if self.friction > 0.0 {
            physics.set_friction(self.friction, rig.sensing.sample_rate);
            rig.sensing.friction = self.friction;
        }
        if self.noise {
            rig.sensing.make_real();
        }
        if self.round {
            physics.shafts = ShaftModel::SpatialChain;
            for whisker in &mut rig.whiskers {
                whisker.pitch = sag(whisker);
            }
        }
    }
}

impl fmt::Display for Conditions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let friction = (self.friction > 0.0).then(|| format!("friction {}", self.friction));
        let noise = self.noise.then(|| "noise".to_owned());
        let round = self.round.then(|| "round wires".to_owned());
        let all: Vec<_> = friction.into_iter().chain(noise).chain(round).collect();
        f.write_str(if all.is_empty() { "ideal".to_owned() } else { all.join(", ") }.as_str())
    }
}
