//! A rig in a world.

use crate::rig::{Preset, Rig, ShaftModel};
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
        let mut rig = scene.rig.clone();
        rig.physics.shafts = ShaftModel::Chain;
        Self { name: "mujoco", rig, world: WorldKind::Mujoco }
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
        Preset::PeerCable.apply(&mut rig);
        Self { name: "peer_cable", rig, world: WorldKind::Mujoco }
    }

    /// The scene in this tier.
    pub(super) fn scene(&self, scene: &Scene) -> Scene {
        Scene { rig: self.rig.clone(), ..scene.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostic::Source;
    use crate::study::bench::SCENARIOS;

    #[test]
    fn what_worlds_are_compared_with_are_chains_whatever_the_scene_has() {
        let file = &SCENARIOS[0];
        let scene = Scene::from_yaml(&Source::new(file.path, file.text));
        let mut scene = scene.unwrap_or_else(|report| panic!("{report:?}"));
        Preset::PeerCable.apply(&mut scene.rig);
        assert_eq!(scene.rig.physics.shafts, ShaftModel::Cable);
        let chain = Tier::chain(&scene).rig;
        assert_eq!(chain.physics.shafts, ShaftModel::Chain);
        assert_eq!(chain.whiskers, scene.rig.whiskers);
    }
}
