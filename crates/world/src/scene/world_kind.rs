//! The simulators for a run.

use std::fmt;

/// The simulators for a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WorldKind {
    /// MuJoCo. Requires the feature `sim`.
    Mujoco,
    /// The quasi-static simulator.
    QuasiStatic,
}

impl WorldKind {
    /// All simulators.
    pub const ALL: [Self; 2] = [Self::Mujoco, Self::QuasiStatic];

    /// The name in scenarios, results and arguments.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Mujoco => "mujoco",
            Self::QuasiStatic => "quasistatic",
        }
    }

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
