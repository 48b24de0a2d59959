//! What MuJoCo's world makes of a whisker's shaft.

/// What MuJoCo's world makes of a whisker's shaft. The quasi-static world and perception always take the chain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ShaftModel {
    /// A chain of links on planar hinges, whose springs follow the trapezoid rule: a spring at the root, too.
    #[default]
    Chain,
    /// A chain of links on ball joints, the first of them clamped, between which MuJoCo's plugin `mujoco.elasticity.cable` acts.
    /// Each joint has the armature of the base hinge.
    Cable,
}

impl ShaftModel {
    /// Degrees of freedom of a shaft of so many links.
    #[must_use]
    pub fn degrees_of_freedom(self, links: usize) -> usize {
        match self {
            Self::Chain => links,
            Self::Cable => 3 * links.saturating_sub(1),
        }
    }
}
