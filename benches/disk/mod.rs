//! The disk scene under the thesis's policy, as the benches use it.

#![allow(dead_code, reason = "each bench uses a part of it")]

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
pub(crate) const SETTLED: usize = 300;

/// The scene and the policy.
pub(crate) struct Disk {
    pub(crate) scene: Scene,
    pub(crate) program: Arc<Program>,
}

/// A run in the middle of swiping.
pub(crate) struct Swiping {
    pub(crate) world: MujocoWorld,
    pub(crate) control: Control,
    /// The samples of the last tick.
    pub(crate) samples: Vec<Sample>,
}

impl Disk {
    pub(crate) fn load() -> Result<Self, Box<dyn Error>> {
        let scene = Scene::from_yaml(&read("scenarios/disk.yaml")?).map_err(|faults| format!("{faults:?}"))?;
        let program = compile(&Self::policy()?).map_err(|faults| format!("{faults:?}"))?;
        Ok(Self { scene, program: Arc::new(program) })
    }

    /// The policy's text.
    pub(crate) fn policy() -> Result<Source, Box<dyn Error>> {
        read("policies/thesis.fsm")
    }

    pub(crate) fn world(&self) -> Result<MujocoWorld, Box<dyn Error>> {
        Ok(MujocoWorld::pruned(&self.scene.rig, &self.scene.solids, self.scene.start, 0)?)
    }

    pub(crate) fn control(&self) -> Result<Control, Box<dyn Error>> {
        Ok(Control::new(&self.scene.rig, Arc::clone(&self.program))?)
    }

    /// The middle of swiping.
    pub(crate) fn swiping(&self) -> Result<Swiping, Box<dyn Error>> {
        let (mut world, mut control) = (self.world()?, self.control()?);
        let mut command = Command::STOP;
        let mut samples = Vec::new();
        for _ in 0..SETTLED {
            samples = world.advance(&command)?.to_vec();
            (command, _) = control.tick(&samples);
        }
        Ok(Swiping { world, control, samples })
    }
}

fn read(name: &str) -> Result<Source, Box<dyn Error>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
    Ok(Source::new(name, std::fs::read_to_string(path)?))
}
