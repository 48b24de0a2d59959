//! One scene of a family.

use std::f64::consts::FRAC_PI_6;

use super::dice::{Dice, scene_seed};
use super::{Family, Layout};
use crate::diagnostic::Source;
use crate::scenario;
use crate::scene::{Jitter, Scene};

/// The speeds that scenes are drawn with (m/s).
pub const SPEEDS: [f64; 3] = [0.02, 0.05, 0.1];

/// How far a start may be from its family's.
const JITTER: Jitter = Jitter { position: 0.04, heading: FRAC_PI_6 };

/// One scene of a family, and how it is to be run.
#[derive(Debug, Clone)]
pub struct Draw {
    /// The scenario as a file has it.
    pub text: String,
    /// The same, read.
    pub scene: Scene,
    /// The speed (m/s) that the run sets, as the policy's parameter `speed`.
    pub speed: f64,
}

/// A family has no scene for a seed and a trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("no scene could be drawn for trial {trial} of `{family}`; this is a fault of the program, please report it")]
pub struct NoDraw {
    family: &'static str,
    trial: u64,
}

impl Family {
    /// The scene with this number. Others, and those of other families and seeds, are drawn independently of it.
    ///
    /// Its start is evenly distributed within 40 mm along x and y and 30° of the family's, the speed over [`SPEEDS`].
    ///
    /// # Errors
    /// [`NoDraw`] when what was drawn is no scene, which would be a fault of the family.
    pub fn draw(&self, seed: u64, trial: u64) -> Result<Draw, NoDraw> {
        self.draw_at(seed, trial, None)
    }

    /// The same scene for a run at a `speed` (m/s), or at the one that is drawn.
    ///
    /// # Errors
    /// As [`draw`](Self::draw).
    pub fn draw_at(&self, seed: u64, trial: u64, speed: Option<f64>) -> Result<Draw, NoDraw> {
        let seed = scene_seed(self.name, seed, trial);
        let mut dice = Dice::new(seed);
        let layout = (self.lay)(&mut dice);
        // The last number that is drawn, so that the scene is the same at every speed.
        let speed = speed.unwrap_or_else(|| SPEEDS[dice.count(0, 2) as usize]);
        let name = format!("{}-{trial}", self.name);
        drawn(&layout, &name, seed, speed).ok_or(NoDraw { family: self.name, trial })
    }
}

/// The scene with its start varied; `None` if there is none.
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
