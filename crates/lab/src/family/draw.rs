//! One scene of a family.

use std::f64::consts::FRAC_PI_6;

use std::path::Path;

use super::sampler::{Sampler, scene_seed};
use super::values::Values;
use super::{Family, Layout, Scenes};
use crate::load::{beside, outline_file};
use vibrissa_declare::catalogue::common::{SPEED, START_HEADING, START_X, START_Y};
use vibrissa_text::diagnostic::{Diagnostic, Source};
use vibrissa_text::file::CommandFiles;
use vibrissa_world::geometry::{Pose, Vector2};
use vibrissa_world::scenario::{self, DrawnScenario};
use vibrissa_world::scene::{Jitter, Scene};

/// The random speeds of scenes (m/s).
pub const SPEEDS: [f64; 3] = [0.02, 0.05, 0.1];

/// Largest deviation of a random start from that of its family.
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

/// A family has no scene for a seed and a trial, or for given values.
#[derive(Debug, Clone, thiserror::Error)]
pub enum NoDraw {
    /// A random scene is not valid.
    #[error(
        "no scene could be sampled for trial {trial} of `{family}`; this is a fault of the program, please report it"
    )]
    Random {
        /// The family.
        family: String,
        /// The number of the scene.
        trial: u64,
    },
    /// The scene with the given values is not valid.
    #[error("`{family}` has no scene with these values: {reason}; choose other values")]
    Given {
        /// The family.
        family: String,
        /// The first error of the scene.
        reason: String,
    },
    /// No draw of the scenario of a file is a scene.
    #[error("{}: no scene could be drawn: {}", source_text.name, reason(faults))]
    Written {
        /// The text of the file.
        source_text: Box<Source>,
        /// The errors of the last draw.
        faults: Vec<Diagnostic>,
    },
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
        self.draw_with(seed, trial, &Values::default())
    }

    /// The same scene with `given` values of some or all parameters. Only these parameters differ.
    ///
    /// # Errors
    /// [`NoDraw`] if the result is not a valid scene.
    pub fn draw_with(&self, seed: u64, trial: u64, given: &Values) -> Result<Draw, NoDraw> {
        let seed = scene_seed(&self.name, seed, trial);
        let name = format!("{}-{trial}", self.name);
        let lay = match &self.scenes {
            Scenes::Laid(lay) => lay,
            Scenes::Written(scenario) => return written(scenario, &name, seed, given),
        };
        drawn(*lay, &name, seed, given).map_err(|reason| {
            if *given == Values::default() {
                NoDraw::Random { family: self.name.to_string(), trial }
            } else {
                NoDraw::Given { family: self.name.to_string(), reason }
            }
        })
    }

    /// The scene with the `given` values of all parameters. Its name is that of the family. A parameter without a value
    /// has the same random value in every scene.
    ///
    /// # Errors
    /// [`NoDraw`] if the result is not a valid scene.
    pub fn scene(&self, given: &Values) -> Result<Draw, NoDraw> {
        match &self.scenes {
            Scenes::Laid(lay) => drawn(*lay, &self.name, 0, given)
                .map_err(|reason| NoDraw::Given { family: self.name.to_string(), reason }),
            Scenes::Written(scenario) => written(scenario, &self.name, 0, given),
        }
    }
}

fn drawn(lay: fn(&mut Sampler<'_>) -> Layout, name: &str, seed: u64, given: &Values) -> Result<Draw, String> {
    let mut sampler = Sampler::new(seed, given);
    let layout = lay(&mut sampler);
    let speed = speed(&mut sampler);
    let read = |layout: &Layout| {
        let text = layout.text(name, seed, speed);
        let scene = scenario::read(&Source::new(name, &*text)).map_err(|faults| reason(&faults))?;
        Ok::<_, String>((text, scene))
    };
    let given_start = [START_X, START_Y, START_HEADING].map(|parameter| given.get(&parameter));
    let random = if given_start.iter().all(Option::is_some) {
        layout.start
    } else {
        JITTER.start(&read(&layout)?.1, seed).ok_or("the rig touches an object at every start")?
    };
    let start = displaced(&layout.start, &random, given_start);
    let (text, scene) = read(&Layout { start, ..layout })?;
    Ok(Draw { text, scene, speed })
}

/// A scene of a file. Its start is that of the file.
fn written(scenario: &DrawnScenario, name: &str, seed: u64, given: &Values) -> Result<Draw, NoDraw> {
    let mut sampler = Sampler::new(seed, given);
    let (source, mut files) = (scenario.source(), CommandFiles::new());
    let mut file = |name: &str| outline_file(&beside(Path::new(&source.name), name), &mut files);
    let scene = scenario.scene(name, seed, &mut || sampler.between(0.0, 1.0), &mut file);
    let scene = scene.map_err(|faults| NoDraw::Written { source_text: Box::new(source.clone()), faults })?;
    let speed = speed(&mut sampler);
    Ok(Draw { text: scene.text, scene: scene.scene, speed })
}

/// The speed of a scene (m/s). It is sampled last, so that the scene is the same at every speed.
fn speed(sampler: &mut Sampler<'_>) -> f64 {
    sampler.number_or(&SPEED, |sampler| SPEEDS[sampler.count(0, 2) as usize])
}

/// The random start, except for the given displacements from the mean start.
fn displaced(mean: &Pose, random: &Pose, [x, y, heading]: [Option<f64>; 3]) -> Pose {
    let moved = |given: Option<f64>, mean: f64, random: f64| given.map_or(random, |given| mean + given);
    let position =
        Vector2::new(moved(x, mean.position.x, random.position.x), moved(y, mean.position.y, random.position.y));
    Pose { position: position.into(), heading: moved(heading, mean.heading, random.heading) }
}

/// The first error of a scene. An error without a message cannot occur.
fn reason(faults: &[Diagnostic]) -> String {
    faults.first().map(|fault| format!("{}: {}", fault.message, fault.primary.text)).unwrap_or_default()
}
