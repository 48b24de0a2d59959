//! A scenario as a whole.

use super::{Expectation, Rig, Stop, yaml};
use crate::diagnostic::{Diagnostic, Source};
use crate::geometry::{Contour, Pose};
use std::path::PathBuf;

/// One scenario, read and checked.
#[derive(Debug, Clone)]
pub struct Scene {
    /// The name under which results are reported; fit to be a file's name.
    pub name: String,
    /// What it is about, for people; may be empty.
    pub description: String,
    /// The platform, its whiskers, and how they are simulated.
    pub rig: Rig,
    /// The outline of the object, in world coordinates. The exact reference that estimates are measured against.
    pub object: Contour,
    /// Where the platform starts, at rest: its centre of mass and its heading, in the world.
    pub start: Pose,
    /// When a run ends.
    pub stop: Stop,
    /// What must hold at the end of a run.
    pub expect: Vec<Expectation>,
    /// The policy to run unless another is asked for, relative to the scenario's file.
    pub policy: Option<PathBuf>,
    /// Seed of the sensor noise.
    pub seed: u64,
}

impl Scene {
    /// Reads a scenario.
    ///
    /// # Errors
    /// Everything that is wrong with it, in the order of the text: at least one diagnostic, all of them errors. A text
    /// that is no YAML is reported alone.
    ///
    /// ```
    /// use vibrissa::diagnostic::Source;
    /// use vibrissa::scene::Scene;
    /// let text = "
    /// name: disk
    /// object: {circle: {centre: [40 cm, 40 cm], radius: 30 cm}}
    /// start: {position: [0 mm, 72 mm], heading: 90 deg}
    /// stop: {time: 120 s}
    /// ";
    /// let scene = Scene::from_yaml(&Source::new("disk.yaml", text)).unwrap();
    /// assert!((scene.object.length() - 0.6 * std::f64::consts::PI).abs() < 1e-12);
    /// ```
    pub fn from_yaml(source: &Source) -> Result<Self, Vec<Diagnostic>> {
        yaml::read(source)
    }
}
