//! What a run in MuJoCo omits, with reasons.

use vibrissa_runtime::rig::{Rig, Whisker};
use vibrissa_world::geometry::{Pose, unit};
use vibrissa_world::physics::Physics;
use vibrissa_world::solid::{PartsError, Solid};
use vibrissa_world::world::{Decision, Verdict};

use super::reach::{Reach, may_be_rigid};

/// What the simulator omits for a rig at `start` among `solids`. Counts refer to the start.
///
/// # Errors
/// [`PartsError`] if a solid is too large for MuJoCo.
pub fn decisions(rig: &Rig, physics: &Physics, solids: &[Solid], start: Pose) -> Result<Vec<Decision>, PartsError> {
    let mut decisions = Vec::new();
    let reach = Reach::new(rig, solids)?;
    let parts = reach.parts().len();
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
    Ok(decisions)
}

/// The number of pairs of links and parts that are near each other while a whisker is undeflected.
fn near_straight(reach: &Reach, whisker: &Whisker, body: &Pose) -> usize {
    let (base, direction) = (body.point_to_world(whisker.base_body), body.heading + whisker.direction_body);
    let start = |link: usize| base + link as f64 * whisker.shaft.link_length() * unit(direction);
    reach.near_links(whisker, (0..whisker.shaft.links).map(|link| (start(link), direction)), 0.0).count()
}
