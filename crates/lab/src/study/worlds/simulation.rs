//! A rig in a world.

use vibrissa_runtime::rig::Rig;
use vibrissa_world::physics::{Physics, Preset, ShaftModel};
use vibrissa_world::scene::{Scene, WorldKind};

/// A rig in a world that represents the rig of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Simulation {
    /// Its name.
    pub name: &'static str,
    /// The rig.
    pub rig: Rig,
    /// The settings of the simulation.
    pub physics: Physics,
    /// The world.
    pub world: WorldKind,
}

impl Simulation {
    /// The scene's whiskers as chains in MuJoCo, the reference of comparisons.
    #[must_use]
    pub fn chain(scene: &Scene) -> Self {
        let physics = Physics { shafts: ShaftModel::Chain, ..scene.physics.clone() };
        Self { name: "mujoco", rig: scene.rig.clone(), physics, world: WorldKind::Mujoco }
    }

    /// The same chains in static equilibrium.
    #[must_use]
    pub fn quasi_static(scene: &Scene) -> Self {
        Self {
            name: "quasistatic",
            rig: scene.rig.clone(),
            physics: scene.physics.clone(),
            world: WorldKind::QuasiStatic,
        }
    }

    /// The baseline's cables instead of the chains, in MuJoCo.
    #[must_use]
    pub fn peer_cable(scene: &Scene) -> Self {
        let (mut rig, mut physics) = (scene.rig.clone(), scene.physics.clone());
        Preset::PeerCable.apply(&mut rig, &mut physics);
        Self { name: "peer_cable", rig, physics, world: WorldKind::Mujoco }
    }

    /// The scene with this simulation's rig and physics.
    pub(super) fn scene(&self, scene: &Scene) -> Scene {
        Scene { rig: self.rig.clone(), physics: self.physics.clone(), ..scene.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::built_in::SCENARIOS;
    use vibrissa_text::diagnostic::Source;
    use vibrissa_world::scenario;

    #[test]
    fn what_worlds_are_compared_with_are_chains_whatever_the_scene_has() {
        let file = &SCENARIOS[0];
        let scene = scenario::read(&Source::new(file.path, file.text));
        let mut scene = scene.unwrap_or_else(|report| panic!("{report:?}"));
        Preset::PeerCable.apply(&mut scene.rig, &mut scene.physics);
        assert_eq!(scene.physics.shafts, ShaftModel::Cable);
        let chain = Simulation::chain(&scene);
        assert_eq!(chain.physics.shafts, ShaftModel::Chain);
        assert_eq!(chain.rig.whiskers, scene.rig.whiskers);
    }
}
