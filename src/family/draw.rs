//! One scene of a family.

use std::f64::consts::FRAC_PI_6;

use super::sampler::{Sampler, scene_seed};
use super::{Family, Layout};
use crate::diagnostic::Source;
use crate::scenario;
use crate::scene::{Jitter, Scene};

/// The speeds of scenes (m/s).
pub const SPEEDS: [f64; 3] = [0.02, 0.05, 0.1];

/// Largest deviation of a start from that of its family.
const JITTER: Jitter = Jitter { position: 0.04, heading: FRAC_PI_6 };

/// One scene of a family with the parameters of its run.
#[derive(Debug, Clone)]
pub struct Draw {
    /// The scenario as text.
    pub text: String,
    /// The scenario as a scene.
    pub scene: Scene,
    /// The speed of the run (m/s), a value for the policy's parameter `speed`.
    pub speed: f64,
}

/// A family has no scene for a seed and a trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("no scene could be sampled for trial {trial} of `{family}`; this is a fault of the program, please report it")]
pub struct NoDraw {
    family: &'static str,
    trial: u64,
}

impl Family {
    /// The scene with this number. It is independent of other scenes, families and seeds.
    ///
    /// Its start is sampled uniformly within 40 mm along x and y and 30° of the family's start. Its speed is sampled
    /// uniformly from [`SPEEDS`].
    ///
    /// # Errors
    /// [`NoDraw`] if the result is not a valid scene, which would be a fault of the family.
    pub fn draw(&self, seed: u64, trial: u64) -> Result<Draw, NoDraw> {
        self.draw_at(seed, trial, None)
    }

    /// The same scene for a run at a `speed` (m/s), or at the random speed.
    ///
    /// # Errors
    /// As [`draw`](Self::draw).
    pub(crate) fn draw_at(&self, seed: u64, trial: u64, speed: Option<f64>) -> Result<Draw, NoDraw> {
        let seed = scene_seed(self.name, seed, trial);
        let mut sampler = Sampler::new(seed);
        let layout = (self.lay)(&mut sampler);
        // The speed is sampled last, so that the scene is the same at every speed.
        let speed = speed.unwrap_or_else(|| SPEEDS[sampler.count(0, 2) as usize]);
        let name = format!("{}-{trial}", self.name);
        drawn(&layout, &name, seed, speed).ok_or(NoDraw { family: self.name, trial })
    }
}

/// The scene with a random start. `None` if it is not valid.
fn drawn(layout: &Layout, name: &str, seed: u64, speed: f64) -> Option<Draw> {
    let read = |layout: &Layout| {
        let text = layout.text(name, seed, speed);
        let scene = scenario::read(&Source::new(name, &*text)).ok()?;
        Some((text, scene))
    };
    let (_, plain) = read(layout)?;
    let (text, scene) = read(&Layout { start: JITTER.start(&plain, seed)?, ..layout.clone() })?;
    Some(Draw { text, scene, speed })
}
