//! Rigs to begin with.

use super::{Integrator, Physics, Rig, ShaftModel};

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

    /// The rig.
    #[must_use]
    pub fn rig(self) -> Rig {
        let mut rig = Rig::default();
        if self == Self::PeerCable {
            rig.make_peer_cable();
        }
        rig
    }
}

impl Rig {
    /// Gives a rig the links and the physics of [`Preset::PeerCable`]; friction and everything that is no matter of how whiskers are
    /// simulated stays.
    ///
    /// Known of that program are 40 links, the integrator, steps of 2 ms (the next that goes into a sample is shorter), that its
    /// whiskers ring at 4 Hz, which the armature of the reference hinge in every joint does, and that tips sink in by 0.23 to 0.39 mm, which
    /// is what MuJoCo's own impedance with this time constant makes of it.
    pub fn make_peer_cable(&mut self) {
        for whisker in &mut self.whiskers {
            whisker.shaft.links = 40;
        }
        let step = 1.0 / 600.0;
        self.physics = Physics {
            shafts: ShaftModel::Cable,
            step,
            calm_step: step,
            integrator: Integrator::ImplicitFast,
            contact_time: 10e-3,
            contact_impedance: [0.9, 0.95, 1e-3],
            penetration_limit: 3e-3,
            ..self.physics
        };
    }
}
