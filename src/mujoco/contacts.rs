//! What can touch what in a MuJoCo model.

use std::fmt::{self, Write};

use crate::physics::Physics;
use vibrissa_runtime::rig::Rig;

use super::prune::Scope;
use crate::solid::Part;

/// How much slower a contact takes up sliding than sinking in, and how much harder it then holds against it.
///
/// The engine's law of friction pushes a sliding contact apart: with one time constant `T` for both directions, a contact that slides at
/// `v` with the friction `mu` stands `2 mu v T` higher than one that rests. For a whisker that is more than it sinks in: the tip
/// lifts off, falls back, and rings by millimetres. A longer time constant for sliding makes that as much less; the other
/// factor keeps the creep of a tip that sticks what it was.
const SLIDING: f64 = 20.0;

/// How a model says what can touch what: each part of a solid, and each link of a whisker and the platform. Nothing else can.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Contacts {
    /// Pair by pair. Geoms that collide by their masks would make the engine look at every two bodies in every step, which
    /// costs a seventh of the time. A pruned model always has pairs, few, and others from time to time.
    Pairs,
    /// By the masks of the geoms, in a model with everything (`--no-prune`, `vibrissa mjcf`), where there would be a pair of every link and
    /// every part. The engine keeps the parts of all solids in one tree of boxes, and asks it for those near each link.
    Masks,
}

impl Contacts {
    /// The way for this many parts: pairs where they are named as they come in reach, where there is friction, which only pairs do well,
    /// and where they are few; else masks.
    pub(super) fn with(parts: usize, physics: &Physics, scope: &Scope) -> Self {
        if parts <= 1 || physics.friction > 0.0 || scope.room().is_some() { Self::Pairs } else { Self::Masks }
    }

    /// The attributes of a solid's part.
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

    /// How contacts behave, where it is a matter of the geoms. It is the same for all of them.
    pub(super) fn write_defaults(self, xml: &mut String, physics: &Physics) -> fmt::Result {
        if self == Self::Pairs {
            return Ok(());
        }
        writeln!(xml, "  <default>\n    <geom {}/>\n  </default>", contact(physics, "0 0 0"))
    }

    /// The pairs of every part with every link and the platform, where it is a matter of them; as many of them as there is room for, whose
    /// parts and links are then others from time to time.
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
            // With most integrators the engine takes no time constant below two steps.
            let time = physics.contact_time.max(2.0 * physics.step);
            write!(contact, r#" solreffriction="{} 1""#, SLIDING * time)?;
        }
        writeln!(xml, r"  <contact>")?;
        let geoms = links.chain(["platform/body".to_owned()]);
        let pairs = geoms.flat_map(|geom| parts.iter().map(move |(part, _)| (part, geom.clone())));
        for (part, geom) in pairs.take(scope.room().unwrap_or(usize::MAX)) {
            writeln!(xml, r#"    <pair geom1="{part}" geom2="{geom}" {contact}/>"#)?;
        }
        writeln!(xml, r"  </contact>")
    }
}

/// The attribute of the engine's options by which friction holds harder; none without friction.
pub(super) fn hold(physics: &Physics) -> String {
    if physics.friction > 0.0 { format!(r#" impratio="{SLIDING}""#) } else { String::new() }
}

/// The attributes of a contact, with its coefficients of friction.
fn contact(physics: &Physics, friction: &str) -> String {
    let [surface, full, depth] = physics.contact_impedance;
    let condim = if physics.friction > 0.0 { 3 } else { 1 };
    let time = physics.contact_time;
    format!(r#"condim="{condim}" friction="{friction}" solref="{time} 1" solimp="{surface} {full} {depth}""#)
}
