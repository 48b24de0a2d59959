//! The scenes of a tuning.

use std::sync::Arc;

use sha2::{Digest, Sha256};
use vibrissa_runtime::machine::{Program, SetError};
use vibrissa_runtime::units::Dimension;

use super::axis::Axis;
use super::candidate::Candidate;
use crate::family::{Family, NoDraw};
use crate::load::Loaded;
use crate::trial::{Trial, short_hash};
use vibrissa_world::scene::{Scene, WorldSetup};

/// A scene in which candidates run.
#[derive(Debug, Clone)]
pub struct TuningScene {
    /// Its name.
    pub name: String,
    of: SceneOf,
    /// A hash of everything that defines it.
    pub hash: String,
}

#[derive(Debug, Clone)]
enum SceneOf {
    Scenario(Box<Scene>),
    Family { family: Family, seed: u64, number: u64 },
}

/// The error of a run that cannot be prepared.
#[derive(Debug, thiserror::Error)]
pub enum CandidateError {
    /// The family has no scene.
    #[error(transparent)]
    Draw(#[from] NoDraw),
    /// The policy does not have a parameter that the run sets.
    #[error(transparent)]
    Set(#[from] SetError),
}

impl TuningScene {
    /// The scene of a scenario.
    #[must_use]
    pub fn scenario(scenario: Loaded<Scene>) -> Self {
        let Loaded { value: scene, hash } = scenario;
        Self { name: scene.name.clone(), of: SceneOf::Scenario(Box::new(scene)), hash: short_hash(&hash.finalize()) }
    }

    /// The scene of a family with this number.
    ///
    /// # Errors
    /// [`NoDraw`] if the family has no such scene.
    pub fn family(family: Family, seed: u64, number: u64) -> Result<Self, NoDraw> {
        let draw = family.draw(seed, number)?;
        let hash = short_hash(&Sha256::digest(draw.text));
        Ok(Self { name: draw.scene.name, of: SceneOf::Family { family, seed, number }, hash })
    }

    /// Number of the scene in its family, 0 for a scenario.
    #[must_use]
    pub fn number(&self) -> u64 {
        match &self.of {
            SceneOf::Scenario(_) => 0,
            SceneOf::Family { number, .. } => *number,
        }
    }

    /// The scene of a scenario.
    #[must_use]
    pub fn of_scenario(&self) -> Option<&Scene> {
        match &self.of {
            SceneOf::Scenario(scene) => Some(scene),
            SceneOf::Family { .. } => None,
        }
    }

    /// The run of a candidate. A scene of a family has its own speed, unless the speed (m/s) is tuned or fixed.
    ///
    /// # Errors
    /// [`CandidateError`] if it cannot be prepared.
    pub fn trial(
        &self,
        candidate: &Candidate,
        axes: &[Axis],
        program: &Program,
        fixed_speed: Option<f64>,
        world: impl Fn(&Scene) -> WorldSetup,
    ) -> Result<Trial, CandidateError> {
        let program = candidate.program(axes, program)?;
        let (scene, program) = match &self.of {
            SceneOf::Scenario(scene) => ((**scene).clone(), program),
            SceneOf::Family { family, seed, number } => {
                let speed = candidate.value("speed").or(fixed_speed);
                let values = speed.map(|speed| ("speed", speed)).into_iter().collect();
                let draw = family.draw_with(*seed, *number, &values)?;
                let mut program = Arc::unwrap_or_clone(program);
                program.set("speed", draw.speed, Dimension::SPEED)?;
                (draw.scene, Arc::new(program))
            }
        };
        Ok(Trial { world: world(&scene), ..Trial::new(scene, program) })
    }
}
