//! The disk scene under the thesis's policy, as the benches use it.

use std::error::Error;
use std::path::Path;
use std::sync::Arc;

use vibrissa::diagnostic::Source;
use vibrissa::machine::Program;
use vibrissa::policy::compile;
use vibrissa::run::Control;
use vibrissa::scene::Scene;
use vibrissa::signal::{Command, Sample};
use vibrissa::world::{MujocoWorld, World};

/// Ticks after which the platform swipes steadily.
const SETTLED: usize = 300;

/// The scene and the policy.
pub struct Disk {
    pub scene: Scene,
    pub program: Arc<Program>,
}

impl Disk {
    pub fn load() -> Result<Self, Box<dyn Error>> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let read = |name: &str| std::fs::read_to_string(root.join(name)).map(|text| Source::new(name, text));
        let scene = Scene::from_yaml(&read("scenarios/disk.yaml")?).map_err(|faults| format!("{faults:?}"))?;
        let program = compile(&read("policies/thesis.fsm")?).map_err(|faults| format!("{faults:?}"))?;
        Ok(Self { scene, program: Arc::new(program) })
    }

    pub fn world(&self) -> Result<MujocoWorld, Box<dyn Error>> {
        Ok(MujocoWorld::new(&self.scene.rig, Some(&self.scene.object), self.scene.start, 0)?)
    }

    pub fn control(&self) -> Result<Control, Box<dyn Error>> {
        Ok(Control::new(&self.scene.rig, Arc::clone(&self.program))?)
    }

    /// A world and a controller in the middle of swiping, and the samples that led there, a block a tick.
    pub fn settled(&self) -> Result<(MujocoWorld, Control, Command, Vec<Vec<Sample>>), Box<dyn Error>> {
        let (mut world, mut control) = (self.world()?, self.control()?);
        let mut command = Command::STOP;
        let mut blocks = Vec::new();
        for _ in 0..SETTLED {
            let samples = world.advance(&command)?.to_vec();
            (command, _) = control.tick(&samples);
            blocks.push(samples);
        }
        Ok((world, control, command, blocks))
    }
}
