//! One scene of a family.

use std::f64::consts::FRAC_PI_6;

use super::approach::is_felt;
use super::dice::{Dice, scene_seed};
use super::{Family, Layout};
use crate::diagnostic::Source;
use crate::scene::{Jitter, Scene};
use crate::units::{Dimension, Quantity};

/// The speeds that scenes are drawn with (m/s).
pub const SPEEDS: [f64; 3] = [0.02, 0.05, 0.1];

/// How far a start is from its family's.
const JITTER: Jitter = Jitter { position: 0.04, heading: FRAC_PI_6 };

/// How often a scene is drawn at most until it is one with a start.
const DRAWS: u32 = 50;

/// One scene of a family, and how it is to be run.
#[derive(Debug, Clone)]
pub struct Draw {
    /// The scenario as a file has it.
    pub text: String,
    /// The same, read.
    pub scene: Scene,
    /// Parameters of the policy that the run sets, by name.
    pub settings: Vec<(&'static str, Quantity)>,
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
    /// Its start is evenly distributed over those within 40 mm along x and y and 30° of the family's from which a whisker is
    /// the first to touch something straight ahead, at least 20 mm before the body; the speed over [`SPEEDS`].
    ///
    /// # Errors
    /// [`NoDraw`] when none of many that were drawn is a scene, which would be a fault of the family.
    pub fn draw(&self, seed: u64, trial: u64) -> Result<Draw, NoDraw> {
        let seed = scene_seed(self.name, seed, trial);
        let mut dice = Dice::new(seed);
        let name = format!("{}-{trial}", self.name);
        let drawn = (0..DRAWS).find_map(|_| {
            let layout = (self.lay)(&mut dice);
            let speed = SPEEDS[dice.count(0, 2) as usize];
            read(&layout, &name, seed, speed)
        });
        drawn.ok_or(NoDraw { family: self.name, trial })
    }
}

/// The scene with its start varied; `None` if there is none, or no start.
fn read(layout: &Layout, name: &str, seed: u64, speed: f64) -> Option<Draw> {
    let scene = |text: &str| Scene::from_yaml(&Source::new(name, text)).ok();
    let plain = scene(&layout.text(name, seed, speed))?;
    let start = JITTER.start_where(&plain, seed, |start| is_felt(&plain, start))?;
    let text = Layout { start, ..layout.clone() }.text(name, seed, speed);
    let speed = Quantity { value_si: speed, dimension: Dimension::SPEED, unit: None };
    Some(Draw { scene: scene(&text)?, text, settings: vec![("speed", speed)] })
}
