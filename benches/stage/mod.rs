//! Scenes under policies, and runs in the middle of them, as the benches use them.

#![allow(dead_code, reason = "each bench uses a part of it")]
#![allow(clippy::disallowed_methods, reason = "a bench may open files")]

use std::error::Error;
use std::path::Path;
use std::sync::Arc;

use vibrissa::diagnostic::Source;
use vibrissa::mujoco::MujocoWorld;
use vibrissa::policy::compile;
use vibrissa::scenario;
use vibrissa::scene::Scene;
use vibrissa::world::World;
use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::Program;
use vibrissa_runtime::signal::{Command, Sample};

/// Ticks after which the platform swipes steadily.
pub(crate) const SETTLED: usize = 300;
/// Ticks in a row that are recorded: enough that the clock costs nothing, and that none is the only one of its kind.
const TICKS: usize = 64;

/// A scene and a policy.
pub(crate) struct Stage {
    pub(crate) scene: Scene,
    pub(crate) program: Arc<Program>,
}

/// A run in the middle of swiping.
pub(crate) struct Swiping {
    pub(crate) world: MujocoWorld,
    pub(crate) control: Control,
    /// What the control has commanded last.
    pub(crate) command: Command,
}

/// Ticks in a row.
pub(crate) struct Tape {
    /// As it is before the first.
    pub(crate) control: Control,
    /// The samples of each.
    pub(crate) ticks: Vec<Vec<Sample>>,
}

impl Stage {
    /// The disk, which `thesis.fsm` follows with one whisker.
    pub(crate) fn disk() -> Result<Self, Box<dyn Error>> {
        Self::load("scenarios/disk.yaml", "policies/thesis.fsm")
    }

    /// The smooth tunnel, where our own policy has a wall on either side.
    pub(crate) fn tunnel() -> Result<Self, Box<dyn Error>> {
        Self::load("scenarios/smooth-tunnel.yaml", "policies/vibrissa.fsm")
    }

    fn load(scenario: &str, policy: &str) -> Result<Self, Box<dyn Error>> {
        let scene = scenario::read(&read(scenario)?).map_err(|faults| format!("{faults:?}"))?;
        let program = compile(&read(policy)?).map_err(|faults| format!("{faults:?}"))?;
        Ok(Self { scene, program: Arc::new(program) })
    }

    pub(crate) fn world(&self) -> Result<MujocoWorld, Box<dyn Error>> {
        Ok(MujocoWorld::pruned(&self.scene.rig, &self.scene.physics, &self.scene.solids, self.scene.start, 0)?)
    }

    pub(crate) fn control(&self) -> Result<Control, Box<dyn Error>> {
        Ok(Control::new(&self.scene.rig, Arc::clone(&self.program))?)
    }

    /// The middle of swiping: after so many ticks.
    pub(crate) fn swiping(&self, settled: usize) -> Result<Swiping, Box<dyn Error>> {
        let (mut world, mut control) = (self.world()?, self.control()?);
        let mut command = Command::STOP;
        for _ in 0..settled {
            (command, _) = control.tick(world.advance(&command)?);
        }
        Ok(Swiping { world, control, command })
    }
}

impl Swiping {
    /// The ticks that come next.
    pub(crate) fn recorded(mut self) -> Result<Tape, Box<dyn Error>> {
        let (mut control, mut ticks) = (self.control.clone(), Vec::with_capacity(TICKS));
        for _ in 0..TICKS {
            let samples = self.world.advance(&self.command)?;
            ticks.push(samples.to_vec());
            (self.command, _) = control.tick(samples);
        }
        Ok(Tape { control: self.control, ticks })
    }
}

/// A text of the repository.
pub(crate) fn read(name: &str) -> Result<Source, Box<dyn Error>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
    Ok(Source::new(name, std::fs::read_to_string(path)?))
}
