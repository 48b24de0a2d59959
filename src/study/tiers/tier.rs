//! A rig in a world.

use crate::rig::Rig;
use crate::scene::{Scene, WorldKind};

/// A rig in a world, which stands for a scene's.
#[derive(Debug, Clone, PartialEq)]
pub struct Tier {
    /// What it is called.
    pub name: &'static str,
    /// The rig.
    pub rig: Rig,
    /// The world.
    pub world: WorldKind,
}

impl Tier {
    /// The scene's whiskers as chains, by MuJoCo: what others are compared with.
    #[must_use]
    pub fn chain(scene: &Scene) -> Self {
        Self { name: "mujoco", rig: scene.rig.clone(), world: WorldKind::Mujoco }
    }

    /// The same chains in static equilibrium.
    #[must_use]
    pub fn quasi_static(scene: &Scene) -> Self {
        Self { name: "quasistatic", rig: scene.rig.clone(), world: WorldKind::QuasiStatic }
    }

    /// The peer's cables in their place, by MuJoCo.
    #[must_use]
    pub fn peer_cable(scene: &Scene) -> Self {
        let mut rig = scene.rig.clone();
        rig.make_peer_cable();
        Self { name: "peer_cable", rig, world: WorldKind::Mujoco }
    }

    /// The scene in this tier.
    pub(super) fn scene(&self, scene: &Scene) -> Scene {
        Scene { rig: self.rig.clone(), ..scene.clone() }
    }
}
