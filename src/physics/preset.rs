//! Rigs to begin with.

use vibrissa_runtime::rig::{Rig, Shaft};

use super::{Integrator, Physics, ShaftModel};

/// A rig that a scenario begins with; what else it says is different from that.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Preset {
    /// The reference rig.
    #[default]
    Reference,
    /// The reference rig with whiskers as they are in the thesis's public program: cables of 40 links, soft contacts, steps of
    /// 1.67 ms.
    PeerCable,
}

impl Preset {
    /// Every preset.
    pub const ALL: [Self; 2] = [Self::Reference, Self::PeerCable];

    /// The name in scenarios.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Reference => "reference",
            Self::PeerCable => "peer_cable",
        }
    }

    /// The rig and its physics.
    #[must_use]
    pub fn rig(self) -> (Rig, Physics) {
        let (mut rig, mut physics) = (Rig::default(), Physics::default());
        self.apply(&mut rig, &mut physics);
        (rig, physics)
    }

    /// Gives a rig the links and the physics of the preset; friction, the solver, whether whiskers are rigid in the air, and everything
    /// that is no matter of how whiskers are simulated stay.
    ///
    /// Known of the thesis's public program are 40 links, the integrator, steps of 2 ms (the next that goes into a sample is shorter),
    /// that its whiskers ring at 4 Hz, which the armature of the reference hinge in every joint does, and that tips sink in by 0.23 to
    /// 0.39 mm, which is what MuJoCo's own impedance with this time constant makes of it.
    pub fn apply(self, rig: &mut Rig, physics: &mut Physics) {
        let reference = Physics::default();
        let (links, preset) = match self {
            Self::Reference => (Shaft::default().links, reference),
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
        let Physics { solver, rigid_in_air, friction, .. } = *physics;
        *physics = Physics { solver, rigid_in_air, friction, ..preset };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_preset_that_is_applied_to_another_makes_it_the_same_as_from_the_start() {
        for (one, other) in Preset::ALL.into_iter().flat_map(|one| Preset::ALL.map(|other| (one, other))) {
            let (mut rig, mut physics) = one.rig();
            other.apply(&mut rig, &mut physics);
            assert_eq!((rig, physics), other.rig(), "{one:?}, then {other:?}");
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
