//! The worlds that a run can take place in.

use std::fmt;

/// The worlds that a run can take place in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WorldKind {
    /// The simulation by MuJoCo; only a program built with the feature `sim` has it.
    Mujoco,
    /// Static equilibria, one after the other.
    QuasiStatic,
}

impl WorldKind {
    /// Every world.
    pub const ALL: [Self; 2] = [Self::Mujoco, Self::QuasiStatic];

    /// The name in scenarios, results and arguments.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Mujoco => "mujoco",
            Self::QuasiStatic => "quasistatic",
        }
    }
}

impl Default for WorldKind {
    /// The simulation, in a program that has it.
    fn default() -> Self {
        if cfg!(feature = "sim") { Self::Mujoco } else { Self::QuasiStatic }
    }
}

/// A world to run in, and how much of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WorldSetup {
    /// The world.
    pub kind: WorldKind,
    /// Whether what cannot matter is left out.
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
