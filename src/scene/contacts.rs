//! What can touch what in a MuJoCo model.

use std::fmt::{self, Write};

use crate::rig::{Physics, Rig};

/// How a model says what can touch what: each part of a solid, and each link of a whisker and the platform. Nothing else can.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Contacts {
    /// Pair by pair. Geoms that collide by their masks would make the engine look at every two bodies in every step, which
    /// costs a seventh of the time.
    Pairs,
    /// By the masks of the geoms. The engine then keeps the parts of all solids in one tree of boxes, and asks it for those
    /// near each link.
    Masks,
}

impl Contacts {
    /// The quicker way for this many parts.
    pub(super) fn with(parts: usize) -> Self {
        if parts <= 1 { Self::Pairs } else { Self::Masks }
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

    /// How contacts behave, where it is a matter of the geoms. It is the same for all of them: the engine takes the larger
    /// friction of a contact's two sides.
    pub(super) fn write_defaults(self, xml: &mut String, physics: &Physics) -> fmt::Result {
        if self == Self::Pairs {
            return Ok(());
        }
        let sliding_alone = format!("{} 0 0", physics.friction);
        writeln!(xml, "  <default>\n    <geom {}/>\n  </default>", contact(physics, &sliding_alone))
    }

    /// The pairs, where it is a matter of them.
    pub(super) fn write_pairs(self, xml: &mut String, rig: &Rig) -> fmt::Result {
        if self == Self::Masks {
            return Ok(());
        }
        let links = rig
            .whiskers
            .iter()
            .flat_map(|whisker| (0..whisker.shaft.links).map(move |link| format!("{}.{link}", whisker.name)));
        let contact = contact(&rig.physics, &format!("{0} {0}", rig.physics.friction));
        writeln!(xml, r"  <contact>")?;
        for geom in links.chain(["platform/body".to_owned()]) {
            writeln!(xml, r#"    <pair geom1="object" geom2="{geom}" {contact}/>"#)?;
        }
        writeln!(xml, r"  </contact>")
    }
}

/// The attributes of a contact, with its coefficients of friction.
fn contact(physics: &Physics, friction: &str) -> String {
    let [surface, full, depth] = physics.contact_impedance;
    let condim = if physics.friction > 0.0 { 3 } else { 1 };
    let time = physics.contact_time;
    format!(r#"condim="{condim}" friction="{friction}" solref="{time} 1" solimp="{surface} {full} {depth}""#)
}
