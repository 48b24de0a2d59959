//! A scene.

use std::path::PathBuf;

use super::clearance::overlap;
use super::{Expectation, Goal, Stop, WorldKind};
use crate::geometry::{Contour, ContourSet, Pose, TunnelAxis};
use crate::mismatch::{Mismatch, TrueArray};
use crate::physics::Physics;
use crate::solid::Solid;
use vibrissa_runtime::calibration::Calibration;
use vibrissa_runtime::machine::ParameterValue;
use vibrissa_runtime::rig::Rig;
use vibrissa_text::diagnostic::Span;

/// A scenario after reading and validation.
#[derive(Debug, Clone)]
pub struct Scene {
    /// The name under which results are reported. It is a valid file name.
    pub name: String,
    /// A description for people, possibly empty.
    pub description: String,
    /// The platform, its whiskers and its sensors, as control assumes them.
    pub rig: Rig,
    /// The differences of the true array, which is simulated. `None` if it is the assumed one.
    pub mismatch: Option<Mismatch>,
    /// The calibration that the true array has made by itself, if the rig has it.
    pub self_calibration: Option<SelfCalibration>,
    /// The physics settings.
    pub physics: Physics,
    /// The solids, at least one. None overlaps another.
    pub solids: Vec<Solid>,
    /// The exact geometry for scores.
    pub truth: Truth,
    /// The pose of the platform at the start, at rest (world frame).
    pub start: Pose,
    /// The stop condition.
    pub stop: Stop,
    /// The expectations.
    pub expect: Vec<Expectation>,
    /// The default policy.
    pub policy: Option<PolicyReference>,
    /// The default simulator.
    pub world: Option<WorldKind>,
    /// The seed of the sensor noise.
    pub seed: u64,
}

impl Scene {
    /// The true array, if it differs from the assumed one.
    #[must_use]
    pub fn true_array(&self) -> Option<TrueArray> {
        self.mismatch.as_ref().map(|mismatch| mismatch.array(&self.rig))
    }

    /// The rig that perception assumes. With a mismatch, whiskers without a calibration have the tolerances of manufacture.
    #[must_use]
    pub fn assumed_rig(&self) -> Rig {
        let mut rig = self.rig.clone();
        if self.mismatch.is_some() {
            for whisker in rig.whiskers.iter_mut().filter(|whisker| whisker.calibration.is_none()) {
                whisker.calibration = Some(Calibration::untouched(whisker));
            }
        }
        rig
    }

    /// The stop condition with the tunnels of the scene.
    #[must_use]
    pub fn goal(&self) -> Goal<'_> {
        Goal { stop: &self.stop, tunnels: &self.truth.axes }
    }

    /// True if the seed of a run changes it: measurements have noise, or the true array is drawn.
    #[must_use]
    pub fn is_random(&self) -> bool {
        self.is_noisy() || self.mismatch.as_ref().is_some_and(Mismatch::is_drawn)
    }

    /// True if measurements have noise.
    #[must_use]
    pub fn is_noisy(&self) -> bool {
        self.rig.sensing.is_noisy() || self.true_array().is_some_and(|array| array.is_noisy())
    }

    /// True if the rig at `start`, with undeflected whiskers, is clear of all solids.
    #[must_use]
    pub fn is_clear_at(&self, start: &Pose) -> bool {
        self.solids.iter().all(|solid| overlap(&self.rig, start, solid.surface()).is_none())
    }

    /// The surfaces that whiskers touch: the outlines of all solids with their textures.
    #[must_use]
    pub fn surfaces(&self) -> ContourSet {
        let surfaces = ContourSet::new(self.solids.iter().map(|solid| solid.surface().clone()));
        surfaces.unwrap_or_else(|| self.truth.surfaces.clone())
    }
}

/// A calibration that a simulated array has made by its own touches. The rig of the scene has its values.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SelfCalibration {
    /// Hash of everything that it depends on.
    pub hash: String,
    /// True if an earlier command had made it.
    pub cached: bool,
}

/// A file to which a scenario or a sweep refers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileReference {
    /// The path, relative to the referring file.
    pub path: PathBuf,
    /// The name of the file without its extension.
    pub name: String,
    /// The position of the reference in the text.
    pub span: Span,
}

/// The policy of a scenario.
#[derive(Debug, Clone, PartialEq)]
pub struct PolicyReference {
    /// Its file.
    pub file: FileReference,
    /// The parameters that the scenario sets.
    pub settings: Vec<PolicySetting>,
}

/// A parameter of a policy with its value.
#[derive(Debug, Clone, PartialEq)]
pub struct PolicySetting {
    /// Name of the parameter.
    pub name: String,
    /// The value. The policy checks it later.
    pub value: ParameterValue,
    /// The position of the name in the text.
    pub span: Span,
}

/// The exact geometry against which a run is scored (world frame).
#[derive(Debug, Clone)]
pub struct Truth {
    /// The outlines of all solids. The error of an estimate is its distance from the nearest.
    pub surfaces: ContourSet,
    /// The reference for coverage and Hausdorff distance: the outline of a plain object, or the inner sides of a
    /// tunnel.
    pub reference: ContourSet,
    /// The centre lines of tunnels, for the baseline's axis error (section 5.3).
    pub axes: Vec<TunnelAxis>,
}

impl From<Contour> for Truth {
    /// The geometry of a single plain object.
    fn from(outline: Contour) -> Self {
        let surfaces = ContourSet::from(outline);
        Self { reference: surfaces.clone(), surfaces, axes: Vec::new() }
    }
}
