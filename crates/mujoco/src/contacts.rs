//! The declaration of contacts in a MuJoCo model.

use std::fmt::{self, Write};

use vibrissa_runtime::rig::Rig;
use vibrissa_world::physics::{Physics, ShaftModel};

use super::prune::Scope;
use vibrissa_world::solid::Part;

/// The ratio of the time constants of friction and normal force, and MuJoCo's `impratio`.
///
/// MuJoCo's friction model separates a sliding contact. With one time constant `T` for both directions, a contact that
/// slides at `v` with the coefficient `mu` is `2 mu v T` higher than a contact at rest. For a whisker this exceeds the
/// penetration depth: the tip lifts off, falls back, and vibrates by millimetres. A longer time constant for friction
/// reduces the effect by this ratio. `impratio` keeps the creep of a sticking tip unchanged.
const SLIDING: f64 = 20.0;

/// The form in which a model declares contacts. Only links or the platform can touch a part of a solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Contacts {
    /// Explicit pairs. With masks, the engine would test every pair of bodies in every step, which takes a seventh of
    /// the time. A pruned model always has explicit pairs. They are few and change during the run.
    Pairs,
    /// Masks of the geoms, for a complete model (`--no-prune`, `vibrissa inspect mjcf`) with too many pairs. The engine keeps
    /// the parts of all solids in one bounding volume tree and queries it for each link.
    Masks,
}

impl Contacts {
    /// Selects the declaration for this number of parts. Pairs are used for pruned models, for models with friction,
    /// and for a single part. Friction is accurate only with pairs.
    pub(super) fn with(parts: usize, physics: &Physics, scope: &Scope) -> Self {
        if parts <= 1 || physics.friction > 0.0 || scope.capacity().is_some() { Self::Pairs } else { Self::Masks }
    }

    /// The attributes of a part of a solid.
    pub(super) fn of_part(self) -> &'static str {
        match self {
            Self::Pairs => r#"contype="0" conaffinity="0""#,
            Self::Masks => r#"contype="1" conaffinity="0""#,
        }
    }

    /// The attributes of a link or the platform.
    pub(super) fn of_rig(self) -> &'static str {
        match self {
            Self::Pairs => r#"contype="0" conaffinity="0""#,
            Self::Masks => r#"contype="0" conaffinity="1""#,
        }
    }

    /// Writes the contact parameters of the geoms, if contacts are declared by masks. They are the same for all geoms.
    pub(super) fn write_defaults(self, xml: &mut String, physics: &Physics) -> fmt::Result {
        if self == Self::Pairs {
            return Ok(());
        }
        writeln!(xml, "  <default>\n    <geom {}/>\n  </default>", contact(physics, "0 0 0"))
    }

    /// Writes the pairs of every part with every link and the platform, if contacts are declared by pairs. Their number
    /// is limited by the capacity of the scope. The geoms of these pairs change during the run.
    pub(super) fn write_pairs(
        self,
        xml: &mut String,
        rig: &Rig,
        physics: &Physics,
        scope: &Scope,
        parts: &[(String, &Part)],
    ) -> fmt::Result {
        if self == Self::Masks {
            return Ok(());
        }
        let links = scope
            .flexible(rig)
            .flat_map(|(_, whisker)| (0..whisker.shaft.links).map(move |link| format!("{}.{link}", whisker.name)));
        let mut contact = contact(physics, &format!("{0} {0}", physics.friction));
        if physics.friction > 0.0 {
            // Most integrators of the engine limit the time constant to at least two steps.
            let time = physics.contact_time.max(2.0 * physics.step);
            write!(contact, r#" solreffriction="{} 1""#, SLIDING * time)?;
        }
        writeln!(xml, r"  <contact>")?;
        let geoms = links.chain(["platform/body".to_owned()]);
        let pairs = geoms.flat_map(|geom| parts.iter().map(move |(part, _)| (part, geom.clone())));
        for (part, geom) in pairs.take(scope.capacity().unwrap_or(usize::MAX)) {
            writeln!(xml, r#"    <pair geom1="{part}" geom2="{geom}" {contact}/>"#)?;
        }
        writeln!(xml, r"  </contact>")
    }
}

/// Returns the option attribute for stiffer friction, empty without friction.
pub(super) fn friction_stiffness(physics: &Physics) -> String {
    if physics.friction > 0.0 { format!(r#" impratio="{SLIDING}""#) } else { String::new() }
}

/// The impedance with which a contact is as compliant as one of a planar chain with this `impedance`.
///
/// The compliance of a contact is the ratio `(1 − d) / d` for the impedance `d`, times an inverse mass. MuJoCo takes the
/// mean inverse mass of the link over three axes. Hinges in a second direction double it, so the ratio is halved.
fn compensated(impedance: f64, shafts: ShaftModel) -> f64 {
    if shafts == ShaftModel::SpatialChain { 2.0 * impedance / (1.0 + impedance) } else { impedance }
}

/// Returns the attributes of a contact with these friction coefficients.
fn contact(physics: &Physics, friction: &str) -> String {
    let [surface, full, depth] = physics.contact_impedance;
    let [surface, full] = [surface, full].map(|impedance| compensated(impedance, physics.shafts));
    let condim = if physics.friction > 0.0 { 3 } else { 1 };
    let time = physics.contact_time;
    format!(r#"condim="{condim}" friction="{friction}" solref="{time} 1" solimp="{surface} {full} {depth}""#)
}
