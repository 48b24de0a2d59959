//! The simulators for a run.

use std::fmt;

vibrissa_runtime::kinds! {
    /// The simulators for a run.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum WorldKind,
    /// The name in scenarios, results and arguments.
    fn name {
        /// MuJoCo. Requires the feature `sim`.
        Mujoco = "mujoco",
        /// The quasi-static simulator.
        QuasiStatic = "quasistatic",
    }
}

impl WorldKind {
    /// A line about the simulator, for help.
    #[must_use]
    pub fn about(self) -> &'static str {
        match self {
            Self::Mujoco => "Simulation by MuJoCo",
            Self::QuasiStatic => "Quasi-static simulation: no inertia, several times faster",
        }
    }
}

impl Default for WorldKind {
    /// MuJoCo if it is available, else the quasi-static simulator.
    fn default() -> Self {
        if cfg!(feature = "sim") { Self::Mujoco } else { Self::QuasiStatic }
    }
}

/// A simulator and its options.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WorldSetup {
    /// The simulator.
    pub kind: WorldKind,
    /// True if the model is pruned.
    pub prune: bool,
}

impl From<WorldKind> for WorldSetup {
    fn from(kind: WorldKind) -> Self {
        Self { kind, prune: true }
    }
}

impl fmt::Display for WorldKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
