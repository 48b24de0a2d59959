//! The hinge at the base of a whisker.

use serde::{Deserialize, Serialize};

/// The base hinge of a whisker: a torsion spring with damping.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Hinge {
    /// Stiffness (N m/rad).
    pub stiffness: f64,
    /// Damping (N m s/rad).
    pub damping: f64,
    /// Inertia of the moving part of the suspension (kg m²).
    pub armature: f64,
}

impl Default for Hinge {
    fn default() -> Self {
        Self { stiffness: 1.0, damping: 0.01, armature: 1e-5 }
    }
}
