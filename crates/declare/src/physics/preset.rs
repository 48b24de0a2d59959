//! Predefined rigs.

use vibrissa_runtime::rig::{Rig, Shaft};

use super::{Integrator, Physics, ShaftModel};

vibrissa_runtime::kinds! {
    /// A predefined rig. A scenario states only the differences from it.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub enum Preset,
    /// The name in scenarios.
    fn name {
        /// The reference rig.
        #[default]
        Reference = "reference",
        /// The reference rig with the whiskers of the peer, the baseline's public program: cables of 40 links, soft
        /// contacts, steps of 1.67 ms.
        PeerCable = "peer_cable",
        /// The array of the thesis, with half of the step of the reference rig.
        ThesisArray = "thesis_array",
    }
}

impl Preset {
    /// Returns the rig and its physics settings.
    #[must_use]
    pub fn rig(self) -> (Rig, Physics) {
        let mut rig = match self {
            Self::Reference | Self::PeerCable => Rig::default(),
            Self::ThesisArray => Rig::thesis_array(),
        };
        let mut physics = Physics::default();
        self.apply(&mut rig, &mut physics);
        (rig, physics)
    }

    /// Applies the links and the physics settings of the preset to a rig. Friction, the height of objects, the solver,
    /// rigid whiskers, and all settings that do not concern the simulation of whiskers are kept.
    ///
    /// These properties of the peer are known: 40 links, the integrator, and steps of 2 ms (the next valid step is
    /// shorter). Its whiskers have a residual vibration of 4 Hz, which results from the armature of the reference hinge
    /// in every joint. Its tips penetrate by 0.23 to 0.39 mm, which results from MuJoCo's default impedance with this
    /// time constant.
    ///
    /// Whiskers of 75 mm vibrate 1.8 times as fast as those of 100 mm, hence the step of the array of the thesis.
    pub fn apply(self, rig: &mut Rig, physics: &mut Physics) {
        let reference = Physics::default();
        let (links, preset) = match self {
            Self::Reference => (Shaft::default().links, reference),
            Self::ThesisArray => (Shaft::default().links, Physics { step: 1.0 / 600.0, ..reference }),
            Self::PeerCable => {
                let step = 1.0 / 600.0;
                let cable = Physics {
                    shafts: ShaftModel::Cable,
                    step,
                    calm_step: step,
                    integrator: Integrator::ImplicitFast,
                    contact_time: 10e-3,
                    contact_impedance: [0.9, 0.95, 1e-3],
                    penetration_limit: 3e-3,
                    ..reference
                };
                (40, cable)
            }
        };
        for whisker in &mut rig.whiskers {
            whisker.shaft.links = links;
        }
        let Physics { solver, rigid_in_air, friction, object_height, .. } = *physics;
        *physics = Physics { solver, rigid_in_air, friction, object_height, ..preset };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_preset_that_is_applied_to_another_gives_it_the_same_links_and_physics_and_keeps_the_rest() {
        let with_links = |mut rig: Rig, links: usize| {
            rig.whiskers.iter_mut().for_each(|whisker| whisker.shaft.links = links);
            rig
        };
        for (one, other) in Preset::ALL.into_iter().flat_map(|one| Preset::ALL.map(|other| (one, other))) {
            let (mut rig, mut physics) = one.rig();
            other.apply(&mut rig, &mut physics);
            let (model, expected) = other.rig();
            assert_eq!(physics, expected, "{one:?}, then {other:?}");
            let links = model.whiskers[0].shaft.links;
            assert_eq!(rig, with_links(one.rig().0, links), "{one:?}, then {other:?}");
        }
        assert_eq!(Preset::default().rig(), (Rig::default(), Physics::default()));
    }

    #[test]
    fn the_peers_cable_keeps_friction_and_mounting() {
        let (mut rig, mut physics) = (Rig::default(), Physics::default());
        (physics.friction, rig.whiskers[0].direction_body) = (0.3, 1.0);
        Preset::PeerCable.apply(&mut rig, &mut physics);
        assert_eq!((physics.friction, rig.whiskers[0].direction_body), (0.3, 1.0));
        assert_eq!(physics.shafts, ShaftModel::Cable);
    }
}
