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
    /// The chain with further hinges that let it bend out of the plane, under gravity. They are at the base and at
    /// every second link.
    SpatialChain,
}

impl ShaftModel {
    /// Degrees of freedom of a whisker with this number of links, apart from its base hinge.
    #[must_use]
    pub fn degrees_of_freedom(self, links: usize) -> usize {
        match self {
            Self::Chain => links,
            Self::Cable => 3 * links.saturating_sub(1),
            Self::SpatialChain => 1 + links + links.div_ceil(2),
        }
    }

    /// The count of numbers that describe a joint of a whisker: 0 is the base hinge, and the next are the joints of the
    /// links. A ball joint has `of_ball` numbers.
    #[must_use]
    pub fn joint_size(self, joint: usize, of_ball: usize) -> usize {
        match (self, joint) {
            (Self::Chain, _) | (Self::Cable, 0) => 1,
            // The first link of a cable is clamped.
            (Self::Cable, 1) => 0,
            (Self::Cable, _) => of_ball,
            (Self::SpatialChain, joint) => 1 + usize::from(joint.checked_sub(1).is_none_or(Self::bends_out_of_plane)),
        }
    }

    /// True for the links of a spatial chain that can rotate out of the plane. A chain with twice as long links is
    /// sufficient there, because no reading depends on that shape.
    #[must_use]
    pub fn bends_out_of_plane(link: usize) -> bool {
        link.is_multiple_of(2)
    }
}
