//! The report of what a run omits, with reasons.

use std::fmt;

use serde::Serialize;

use vibrissa_runtime::rig::{Rig, Whisker};
use vibrissa_world::geometry::{Pose, unit};
use vibrissa_world::physics::Physics;
use vibrissa_world::scene::WorldKind;
use vibrissa_world::solid::Solid;

use super::reach::{Reach, may_be_rigid};

/// The treatment of a part of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// It is omitted. The run is bit-identical without it.
    LeftOut,
    /// It is kept.
    Kept,
    /// A physics setting reduces it. The run changes slightly.
    Setting,
}

/// A decision about a part of a run.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Decision {
    /// The treatment.
    pub verdict: Verdict,
    /// The subject of the decision.
    pub subject: String,
    /// The saving; `None` for a part that is kept.
    pub saves: Option<String>,
    /// The reason.
    pub why: String,
}

/// All decisions about a run. They follow from the scenario and from the values that the policy reads.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Pruning {
    /// The decisions.
    pub decisions: Vec<Decision>,
}

impl Pruning {
    /// Decides for a rig at `start` among `solids` in a simulator, with a policy that binds whiskers with these names.
    /// Counts refer to the start.
    #[must_use]
    pub fn new(
        rig: &Rig,
        physics: &Physics,
        solids: &[Solid],
        start: Pose,
        bound: &[String],
        world: WorldKind,
    ) -> Self {
        let mut decisions = Vec::new();
        match world {
            WorldKind::Mujoco => in_mujoco(&mut decisions, rig, physics, solids, start),
            WorldKind::QuasiStatic => decisions.push(Decision {
                verdict: Verdict::LeftOut,
                subject: "pieces of outlines far from all whiskers".to_owned(),
                saves: Some("distances to these pieces; a bounding-box tree returns the near ones".to_owned()),
                why: "a link touches only pieces within its own length".to_owned(),
            }),
        }
        whiskers(&mut decisions, rig, bound);
        Self { decisions }
    }
}

fn in_mujoco(decisions: &mut Vec<Decision>, rig: &Rig, physics: &Physics, solids: &[Solid], start: Pose) {
    let reach = Reach::new(rig, solids);
    let parts = solids.iter().flat_map(Solid::parts).count();
    let near = if reach.is_windowed() { reach.parts_about(start.position).len() } else { parts };
    if reach.is_windowed() {
        decisions.push(Decision {
            verdict: Verdict::LeftOut,
            subject: "parts of solids out of reach".to_owned(),
            saves: Some(format!("{} of {parts} geoms at the start", parts - near)),
            why: "the rig cannot reach them before the model is rebuilt with the parts that are near then".to_owned(),
        });
    } else {
        decisions.push(Decision {
            verdict: Verdict::Kept,
            subject: format!("all parts of solids, of which there are {parts}"),
            saves: None,
            why: "they are few, and rebuilding the model would take longer".to_owned(),
        });
    }
    let links: usize = rig.whiskers.iter().map(|whisker| whisker.shaft.links).sum();
    let touchable: usize = rig.whiskers.iter().map(|whisker| near_straight(&reach, whisker, &start)).sum();
    decisions.push(Decision {
        verdict: Verdict::LeftOut,
        subject: "contacts of links and parts that are not near each other".to_owned(),
        saves: Some(format!("{} of {} pairs at the start", links * near - touchable, links * near)),
        why: "pairs are updated before any part of the rig has moved 2 mm, so no other pair can touch".to_owned(),
    });
    if !rig.sensing.forces {
        decisions.push(Decision {
            verdict: Verdict::LeftOut,
            subject: "forces at the bases of whiskers".to_owned(),
            saves: Some(format!("{} sensors, and one evaluation of the dynamics per sample", rig.whiskers.len())),
            why: "the rig does not sense them".to_owned(),
        });
    }
    if physics.has_rigid_whiskers() {
        let is_rigid = |whisker: &&_| may_be_rigid(whisker, reach.clearance(whisker, &start), 0.0, false);
        let freedom = |whisker: &Whisker| 1 + physics.shafts.degrees_of_freedom(whisker.shaft.links);
        let joints: usize = rig.whiskers.iter().filter(is_rigid).map(freedom).sum();
        let all = 3 + rig.whiskers.iter().map(freedom).sum::<usize>();
        decisions.push(Decision {
            verdict: Verdict::Setting,
            subject: "`rigid_in_air`: whiskers at rest in the air are rigid".to_owned(),
            saves: Some(format!("{joints} of {all} degrees of freedom at the start")),
            why: "their base angles are below a hundredth of the contact threshold. The last digits of the path change, which can \
                  change decisions of a policy"
                .to_owned(),
        });
    }
    let steps = (1.0 / (rig.sensing.sample_rate * physics.step)).round().max(1.0);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a validated small count")]
    let together = physics.steps_in_calm(steps as usize);
    if together > 1 {
        decisions.push(Decision {
            verdict: Verdict::Setting,
            subject: "`calm_step`: longer steps while no whisker moves fast".to_owned(),
            saves: Some(format!("{} of {together} steps", together - 1)),
            why: "a sliding contact needs no shorter steps. A long step that ends with a fast whisker is repeated in short steps"
                .to_owned(),
        });
    }
}

/// The number of pairs of links and parts that are near each other while a whisker is undeflected.
fn near_straight(reach: &Reach, whisker: &Whisker, body: &Pose) -> usize {
    let (base, direction) = (body.point_to_world(whisker.base_body), body.heading + whisker.direction_body);
    let start = |link: usize| base + link as f64 * whisker.shaft.link_length() * unit(direction);
    reach.near_links(whisker, (0..whisker.shaft.links).map(|link| (start(link), direction)), 0.0).count()
}

fn whiskers(decisions: &mut Vec<Decision>, rig: &Rig, bound: &[String]) {
    for whisker in rig.whiskers.iter().filter(|whisker| !bound.contains(&whisker.name)) {
        decisions.push(Decision {
            verdict: Verdict::LeftOut,
            subject: format!("perception of `{}`", whisker.name),
            saves: Some("its filter, contact estimator and contour in every tick".to_owned()),
            why: "the policy does not bind it".to_owned(),
        });
        decisions.push(Decision {
            verdict: Verdict::Kept,
            subject: format!("the whisker `{}`", whisker.name),
            saves: None,
            why: "the policy does not bind it, but its contact forces act on the platform, and its penetration depth is limited"
                .to_owned(),
        });
    }
}

impl fmt::Display for Pruning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, Decision { verdict, subject, saves, why }) in self.decisions.iter().enumerate() {
            let verdict = match verdict {
                Verdict::LeftOut => "left out",
                Verdict::Kept => "kept",
                Verdict::Setting => "setting",
            };
            let line = if index > 0 { "\n" } else { "" };
            write!(f, "{line}{verdict:<10}{subject}")?;
            if let Some(saves) = saves {
                write!(f, "\n          saves: {saves}")?;
            }
            write!(f, "\n          why: {why}")?;
        }
        Ok(())
    }
}
