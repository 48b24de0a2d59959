//! A compiled MuJoCo model and its state.

use std::ops::Range;

use mujoco_rs::prelude::{MjData, MjModel};
use mujoco_rs::wrappers::mj_model::MjtObjBase;

use super::{Scope, mjcf_within, part_names};
use vibrissa_runtime::math;
use vibrissa_runtime::rig::{Rig, Shaft};
use vibrissa_world::geometry::{Point2, Pose, Vector2};
use vibrissa_world::physics::{Physics, ShaftModel};
use vibrissa_world::solid::Part;
use vibrissa_world::world::Fault;

use super::link::{Link, LinkEnds};
use super::messages::WARNINGS;
use super::world::MujocoError;

/// The platform's joints come first: x, y, yaw.
const PLATFORM_JOINTS: usize = 3;

/// A part of the rig that can touch a solid.
#[derive(Debug, Clone, Copy)]
pub(super) enum Member {
    /// The platform's body.
    Body,
    /// A link, by the index of its whisker and its index on the whisker.
    Link(usize, usize),
}

/// A part of a solid, by its index, and a member of the rig that may touch it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pair {
    pub(super) of: Member,
    pub(super) part: usize,
}

/// A state: positions, velocities, and the accelerations for a warm start of the solver.
#[derive(Debug, Clone)]
struct State {
    positions: Vec<f64>,
    velocities: Vec<f64>,
    accelerations: Vec<f64>,
}

/// The ranges of a whisker's joints in the state: its hinge, followed by the joints of the shaft.
#[derive(Debug, Clone)]
struct Joints {
    positions: Range<usize>,
    velocities: Range<usize>,
}

/// A compiled model within a scope, and its state.
pub(super) struct Engine {
    data: MjData<Box<MjModel>>,
    kept: State,
    pub(super) scope: Scope,
    /// The joints of every flexible whisker.
    joints: Vec<Option<Joints>>,
    shafts: ShaftModel,
    /// The geom of the first link of every flexible whisker. The geoms of its other links follow.
    first_links: Vec<Option<usize>>,
    /// The geoms of the parts in the model, ascending by the parts' indices.
    part_geoms: Vec<i32>,
    platform_geom: i32,
    /// The capacity of the model's pair list.
    capacity: usize,
}

impl Engine {
    pub(super) fn new(
        rig: &Rig,
        physics: &Physics,
        parts: &[Part],
        start: Pose,
        scope: Scope,
    ) -> Result<Self, MujocoError> {
        let refused = |error: &dyn std::fmt::Display| MujocoError::Model(error.to_string());
        let xml = mjcf_within(rig, physics, parts, start, &scope);
        let model = Box::new(MjModel::from_xml_string(&xml).map_err(|error| refused(&error))?);
        let geom = |name: &str| {
            let id = model.name_to_id(MjtObjBase::mjOBJ_GEOM, name);
            id.ok_or_else(|| refused(&format_args!("it has no geom `{name}`")))
        };
        let geom_id = |name: &str| i32::try_from(geom(name)?).map_err(|error| refused(&error));
        let platform_geom = geom_id("platform/body")?;
        let part_geoms = part_names(parts, &scope).map(|name| geom_id(&name)).collect::<Result<_, _>>()?;
        let mut joints = vec![None; rig.whiskers.len()];
        let mut first_links = joints.iter().map(|_| None).collect::<Vec<_>>();
        let shafts = physics.shafts;
        let (mut position, mut velocity) = (PLATFORM_JOINTS, PLATFORM_JOINTS);
        for (index, whisker) in scope.flexible(rig) {
            first_links[index] = Some(geom(&format!("{}.0", whisker.name))?);
            let freedom = shafts.degrees_of_freedom(whisker.shaft.links);
            let numbers = match shafts {
                ShaftModel::Chain | ShaftModel::SpatialChain => freedom,
                // The position of a ball joint is a quaternion.
                ShaftModel::Cable => freedom / 3 * 4,
            };
            let positions = position..position + 1 + numbers;
            let velocities = velocity..velocity + 1 + freedom;
            (position, velocity) = (positions.end, velocities.end);
            joints[index] = Some(Joints { positions, velocities });
        }
        let capacity = model.pair_margin().len();
        let mut data = MjData::try_new(model).map_err(|error| refused(&error))?;
        data.reset_keyframe(0).map_err(|error| refused(&error))?;
        let kept = State {
            positions: data.qpos().to_vec(),
            velocities: data.qvel().to_vec(),
            accelerations: data.qacc_warmstart().to_vec(),
        };
        Ok(Self { data, kept, scope, joints, shafts, first_links, part_geoms, platform_geom, capacity })
    }

    /// Copies the state of another engine. A whisker that was rigid there becomes straight and at rest. A whisker that
    /// is rigid here was already straight.
    pub(super) fn resume(&mut self, other: &Self) {
        self.data.ctrl_mut().copy_from_slice(other.data.ctrl());
        let platform = Joints { positions: 0..PLATFORM_JOINTS, velocities: 0..PLATFORM_JOINTS };
        let own = std::iter::once(Some(platform.clone())).chain(self.joints.iter().cloned()).collect::<Vec<_>>();
        let others = std::iter::once(Some(platform)).chain(other.joints.iter().cloned());
        for (own, other_joints) in own.into_iter().zip(others) {
            let Some(own) = own else { continue };
            if let Some(from) = other_joints {
                self.data.qpos_mut()[own.positions].copy_from_slice(&other.data.qpos()[from.positions]);
                self.data.qvel_mut()[own.velocities.clone()]
                    .copy_from_slice(&other.data.qvel()[from.velocities.clone()]);
                self.data.qacc_warmstart_mut()[own.velocities]
                    .copy_from_slice(&other.data.qacc_warmstart()[from.velocities]);
            } else {
                let straight = self.data.model().qpos0()[own.positions.clone()].to_vec();
                self.data.qpos_mut()[own.positions].copy_from_slice(&straight);
                self.data.qvel_mut()[own.velocities.clone()].fill(0.0);
                self.data.qacc_warmstart_mut()[own.velocities].fill(0.0);
            }
        }
    }

    /// Sets the pairs that the engine tests, ascending by member. Their number must not exceed the
    /// [capacity](Scope::capacity).
    pub(super) fn set_pairs(&mut self, pairs: &[Pair]) {
        // A part that is not in the model is outside of the window, so it is out of reach until the model is replaced.
        // Rigid whiskers have no geoms.
        let geoms = pairs.iter().filter_map(|pair| Some((self.part_geom(pair.part)?, self.geom(pair.of)?)));
        let geoms: Vec<_> = geoms.collect();
        debug_assert!(geoms.len() <= self.capacity, "{} pairs, but a capacity of {}", geoms.len(), self.capacity);
        let geoms = geoms.into_iter().take(self.capacity).collect::<Vec<_>>();
        #[expect(unsafe_code, reason = "pairs are a table that the engine takes for its own")]
        #[expect(
            clippy::cast_possible_wrap,
            reason = "no more than the model was compiled with, whose count is such a number"
        )]
        // SAFETY: `model_mut` requires that no size changes, and `npair` changes. It is sound for these reasons:
        // - No array of the data depends on the number of pairs. Its buffers and its arena keep their sizes.
        // - The arrays of pairs in the model keep their addresses and lengths. `npair` never exceeds `capacity`, the
        //   compiled number. All pairs have equal properties except geoms and signatures, so the other arrays of a slot
        //   hold for any pair.
        // - A model with a changed `npair` must not be copied, saved, swapped, or compared by its layout. This model is
        //   owned by the data alone, and none of these operations occurs.
        // - All ids are geoms of this model, looked up by name. The engine checks that a collision function exists for
        //   the types of both geoms. The mesh of a prism always has a convex hull graph, because the mesh is defined by
        //   its vertices only.
        // - The engine merges pairs with the candidates of its mask-based broad phase by ascending signature. The
        //   signatures ascend, because bodies are in the order of the pairs. In a model with a capacity all masks are
        //   0, and there are no such candidates.
        let model = unsafe {
            let model = self.data.model_mut();
            model.ffi_mut().npair = geoms.len() as i64;
            for (slot, (part, other)) in geoms.iter().enumerate() {
                model.pair_geom1_mut()[slot] = *part;
                model.pair_geom2_mut()[slot] = *other;
            }
            model
        };
        for (slot, (_, other)) in geoms.into_iter().enumerate() {
            // The signature contains both bodies. The part belongs to the world, body 0, in the high half.
            let body = usize::try_from(other).map(|geom| model.geom_bodyid()[geom]);
            model.pair_signature_mut()[slot] = body.unwrap_or_default();
        }
    }

    fn part_geom(&self, part: usize) -> Option<i32> {
        self.part_geoms.get(self.scope.rank_of_part(part)?).copied()
    }

    fn geom(&self, of: Member) -> Option<i32> {
        match of {
            Member::Body => Some(self.platform_geom),
            Member::Link(whisker, link) => i32::try_from(self.first_links[whisker]? + link).ok(),
        }
    }

    /// Sets the target velocities of the servos (m/s, rad/s).
    pub(super) fn command(&mut self, velocity: Vector2, yaw_rate: f64) {
        self.data.ctrl_mut().copy_from_slice(&[velocity.x, velocity.y, yaw_rate]);
    }

    /// Simulates a step of this length (s).
    pub(super) fn step(&mut self, length: f64) {
        self.data.model_opt_mut().timestep = length;
        self.data.step();
    }

    /// Saves the state for [`Self::restore`].
    pub(super) fn save(&mut self) {
        let Self { data, kept, .. } = self;
        kept.positions.clone_from_slice(data.qpos());
        kept.velocities.clone_from_slice(data.qvel());
        kept.accelerations.clone_from_slice(data.qacc_warmstart());
    }

    /// Restores the last saved state.
    pub(super) fn restore(&mut self) {
        let Self { data, kept, .. } = self;
        data.qpos_mut().copy_from_slice(&kept.positions);
        data.qvel_mut().copy_from_slice(&kept.velocities);
        data.qacc_warmstart_mut().copy_from_slice(&kept.accelerations);
    }

    /// Returns the warning of the engine, if there is one. The engine resets its state silently after a divergence.
    /// Only its warning counters show that.
    pub(super) fn warning(&self) -> Option<&'static str> {
        let mut warned = self.data.warning().iter().zip(WARNINGS);
        warned.find(|(warning, _)| warning.number > 0).map(|(_, cause)| cause)
    }

    /// The penetration depths (m) of all contacts before the last step. The flag is true for contacts of the platform's
    /// body.
    pub(super) fn contacts(&self) -> impl Iterator<Item = (f64, bool)> {
        self.data.contact().iter().map(|contact| (-contact.dist, contact.geom.contains(&self.platform_geom)))
    }

    /// Returns the position (m, world frame) and the link of a whisker's deepest contact.
    pub(super) fn deepest(&self, whisker: usize, links: usize) -> Option<(Point2, usize)> {
        let first = self.first_links[whisker]?;
        let link_of = |geom: &i32| usize::try_from(*geom).ok()?.checked_sub(first).filter(|link| *link < links);
        let contacts = self.data.contact().iter().filter(|contact| contact.dist < 0.0);
        let touching = contacts.filter_map(|contact| Some((contact, contact.geom.iter().find_map(link_of)?)));
        let (contact, link) = touching.min_by(|(a, _), (b, _)| a.dist.total_cmp(&b.dist))?;
        Some((Point2::new(contact.pos[0], contact.pos[1]), link))
    }

    /// True if all positions are finite.
    pub(super) fn is_finite(&self) -> bool {
        self.data.qpos().iter().all(|position| position.is_finite())
    }

    /// The pose of the platform in the world frame.
    pub(super) fn body(&self) -> Pose {
        let positions = self.data.qpos();
        Pose { position: Point2::new(positions[0], positions[1]), heading: positions[2] }
    }

    /// The velocity (m/s, world frame) and the yaw rate (rad/s) of the platform.
    pub(super) fn body_velocity(&self) -> (Vector2, f64) {
        let velocities = self.data.qvel();
        (Vector2::new(velocities[0], velocities[1]), velocities[2])
    }

    /// Every link of a flexible whisker, from the base to the tip.
    pub(super) fn links(&self, rig: &Rig, whisker: usize) -> impl Iterator<Item = Link> {
        let base = &rig.whiskers[whisker];
        let mut angles = self.angles(whisker);
        let hinge = angles.next().unwrap_or_default();
        let mut ends = LinkEnds::new(base, &self.body(), hinge, self.shafts == ShaftModel::SpatialChain);
        angles.zip(base.shaft.rest_angles()).map(move |(angles, rest)| ends.next_link(rest, angles))
    }

    /// The angles (rad) of a whisker's hinge, followed by those of every link relative to its predecessor: about the
    /// vertical axis, and about the transverse axis after that. Empty for a rigid whisker.
    pub(super) fn angles(&self, whisker: usize) -> impl Iterator<Item = [f64; 2]> {
        let joints = self.joints[whisker].as_ref();
        let positions = joints.map_or(&[][..], |joints| &self.data.qpos()[joints.positions.clone()]);
        self.by_joint(positions, 4).map(|position| match position {
            [angle] => [*angle, 0.0],
            [vertical, transverse] => [*vertical, *transverse],
            // A quaternion about the vertical axis.
            [cosine, .., sine] => [2.0 * math::atan2(*sine, *cosine), 0.0],
            [] => [0.0; 2],
        })
    }

    /// An upper bound of the speed (m/s) of any point of a whisker relative to its base.
    pub(super) fn speed(&self, rig: &Rig, whisker: usize) -> f64 {
        let joints = self.joints[whisker].as_ref();
        let velocities = joints.map_or(&[][..], |joints| &self.data.qvel()[joints.velocities.clone()]);
        let rates = self.by_joint(velocities, 3).map(|velocity| match velocity {
            [rate] => *rate,
            rates => rates.iter().map(|rate| rate * rate).sum::<f64>().sqrt(),
        });
        swing(&rig.whiskers[whisker].shaft, rates)
    }

    /// Splits per-joint values of a whisker into those of the hinge and of every link. A ball joint has `of_ball`
    /// values.
    fn by_joint<'a>(&self, of_joints: &'a [f64], of_ball: usize) -> impl Iterator<Item = &'a [f64]> + use<'a> {
        let (shafts, mut rest, mut joints) = (self.shafts, of_joints, 0..);
        std::iter::from_fn(move || {
            let size = shafts.joint_size(joints.next()?, of_ball);
            let (own, others) = rest.split_at_checked(size).filter(|_| !rest.is_empty())?;
            rest = others;
            Some(own)
        })
    }

    /// An upper bound of the displacement (m) of any point of a whisker relative to its base since its joints had these
    /// angles (rad).
    pub(super) fn swing_since(&self, rig: &Rig, whisker: usize, angles: &[[f64; 2]]) -> f64 {
        let turns =
            self.angles(whisker).zip(angles).map(|(now, before)| math::hypot(now[0] - before[0], now[1] - before[1]));
        swing(&rig.whiskers[whisker].shaft, turns)
    }

    /// The axial force and the shear (N) that act on a whisker's shaft at its base. Requires force sensors in the
    /// model.
    pub(super) fn base_forces(&self, whisker: usize) -> (f64, f64) {
        let force = &self.data.sensordata()[3 * whisker..3 * whisker + 3];
        // MuJoCo reports the force of the shaft's parent on the shaft with the opposite sign.
        (-force[0], -force[1])
    }

    /// The energy (J) of springs and motion. Requires a [refresh](Self::refresh) after a step.
    pub(super) fn energy(&mut self) -> f64 {
        self.data.energy_pos();
        self.data.energy_vel();
        self.data.energy().iter().sum()
    }

    /// Recomputes quantities that are derived from positions and velocities. After a step, they still belong to the
    /// state before it.
    pub(super) fn refresh(&mut self) {
        self.data.forward();
    }
}

/// An upper bound of the displacement (m) that joint rotations (rad) cause, or of the speed that joint velocities
/// cause. Each joint contributes its angle times the length of the shaft behind it.
fn swing(shaft: &Shaft, turns: impl Iterator<Item = f64>) -> f64 {
    let length = |joint: usize| shaft.length - joint.saturating_sub(1) as f64 * shaft.link_length();
    turns.enumerate().map(|(joint, turn)| turn.abs() * length(joint)).sum()
}

impl From<MujocoError> for Fault {
    fn from(cause: MujocoError) -> Self {
        Self::Model { cause: cause.to_string() }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use vibrissa_world::geometry::{circle, polygon};
    use vibrissa_world::solid::{Solid, convex_parts};

    /// The geoms and the signatures of the pairs that the engine tests.
    fn pairs(engine: &Engine) -> Vec<(i32, i32, i32)> {
        let model = engine.data.model();
        let geoms = model.pair_geom1().iter().zip(model.pair_geom2());
        geoms.zip(model.pair_signature()).map(|((a, b), signature)| (*signature, *a, *b)).collect()
    }

    #[test]
    fn pairs_that_are_named_are_as_if_compiled_and_ascend_as_the_engine_merges_them() {
        let corners = [(0.06, 0.3), (0.3, 0.3), (0.3, 0.6), (0.06, 0.6), (0.1, 0.45)].map(|(x, y)| Point2::new(x, y));
        let outlines = [circle(Point2::new(0.3, 0.15), 0.1), polygon(&corners)];
        let solids = outlines.map(|outline| Solid::inside(outline.unwrap()).unwrap());
        let all_parts = convex_parts(&solids).unwrap();
        let rig = Rig::default();
        let scope = Scope::whole(&rig, &all_parts).with_capacity(1000);
        let parts = scope.part_count();
        let mut engine = Engine::new(&rig, &Physics::default(), &all_parts, Pose::default(), scope).unwrap();
        let mut compiled = pairs(&engine);
        let links = rig.whiskers.iter().enumerate();
        let links =
            links.flat_map(|(index, whisker)| (0..whisker.shaft.links).map(move |link| Member::Link(index, link)));
        let members = std::iter::once(Member::Body).chain(links);
        let all: Vec<_> = members.flat_map(|of| (0..parts).map(move |part| Pair { of, part })).collect();
        engine.set_pairs(&all[..3]);
        engine.set_pairs(&all);
        let mut named = pairs(&engine);
        assert!(parts > 2 && named.is_sorted_by_key(|(signature, ..)| signature), "{named:?}");
        compiled.sort_unstable();
        named.sort_unstable();
        assert_eq!(named, compiled);
    }
}
