//! The model of a whisker's shaft in MuJoCo.

/// The model of a whisker's shaft in MuJoCo. The quasi-static simulator and perception always use the chain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ShaftModel {
    /// A chain of links on planar hinges. Joint springs follow the trapezoid rule, with a spring at the root.
    #[default]
    Chain,
    /// A chain of links on ball joints with MuJoCo's plugin `mujoco.elasticity.cable`. The first link is clamped. Each
    /// joint has the armature of the base hinge.
    Cable,
}

impl ShaftModel {
    /// Degrees of freedom of a shaft with this number of links.
    #[must_use]
    pub(crate) fn degrees_of_freedom(self, links: usize) -> usize {
        match self {
            Self::Chain => links,
            Self::Cable => 3 * links.saturating_sub(1),
        }
    }
}
