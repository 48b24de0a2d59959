//! A compiled model and its state.

use std::ops::Range;

use mujoco_rs::prelude::{MjData, MjModel};
use mujoco_rs::wrappers::mj_model::MjtObjBase;

use super::{Scope, mjcf_within, part_names};
use crate::geometry::{Point2, Pose, Vector2, unit};
use crate::physics::{Physics, ShaftModel};
use crate::solid::Solid;
use crate::world::Fault;
use vibrissa_runtime::rig::{Rig, Shaft, Whisker};

use super::messages::WARNINGS;
use super::world::MujocoError;

/// The joints of the platform come first: along x, along y, yaw.
const PLATFORM_JOINTS: usize = 3;

/// What of a rig may touch something.
#[derive(Debug, Clone, Copy)]
pub(super) enum Member {
    /// The platform's body.
    Body,
    /// A link, by the indices of its whisker and along that.
    Link(usize, usize),
}

/// A part of a solid, by its index, and what may touch it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pair {
    pub(super) of: Member,
    pub(super) part: usize,
}

/// A state: positions, velocities, and the accelerations that the solver begins with.
#[derive(Debug, Clone)]
struct State {
    positions: Vec<f64>,
    velocities: Vec<f64>,
    accelerations: Vec<f64>,
}

/// Where a whisker's joints stand in the state: its hinge, then those along the shaft.
#[derive(Debug, Clone)]
struct Joints {
    positions: Range<usize>,
    velocities: Range<usize>,
}

/// A compiled model of as much of a scene as its scope says, and its state.
pub(super) struct Engine {
    data: MjData<Box<MjModel>>,
    kept: State,
    pub(super) scope: Scope,
    /// The joints of every whisker that bends.
    joints: Vec<Option<Joints>>,
    shafts: ShaftModel,
    /// The geom of the first link of every whisker that bends; those of the others come one after the other.
    first_links: Vec<Option<usize>>,
    /// The geoms of the parts that are there, ascending by the parts' indices.
    part_geoms: Vec<i32>,
    platform_geom: i32,
    /// How many pairs there is room for.
    room: usize,
}

impl Engine {
    pub(super) fn new(
        rig: &Rig,
        physics: &Physics,
        solids: &[Solid],
        start: Pose,
        scope: Scope,
    ) -> Result<Self, MujocoError> {
        let refused = |error: &dyn std::fmt::Display| MujocoError::Model(error.to_string());
        let xml = mjcf_within(rig, physics, solids, start, &scope);
        let model = Box::new(MjModel::from_xml_string(&xml).map_err(|error| refused(&error))?);
        let geom = |name: &str| {
            let id = model.name_to_id(MjtObjBase::mjOBJ_GEOM, name);
            id.ok_or_else(|| refused(&format_args!("it has no geom `{name}`")))
        };
        let geom_id = |name: &str| i32::try_from(geom(name)?).map_err(|error| refused(&error));
        let platform_geom = geom_id("platform/body")?;
        let part_geoms = part_names(solids, &scope).map(|name| geom_id(&name)).collect::<Result<_, _>>()?;
        let mut joints = vec![None; rig.whiskers.len()];
        let mut first_links = joints.iter().map(|_| None).collect::<Vec<_>>();
        let shafts = physics.shafts;
        let (mut position, mut velocity) = (PLATFORM_JOINTS, PLATFORM_JOINTS);
        for (index, whisker) in scope.flexible(rig) {
            first_links[index] = Some(geom(&format!("{}.0", whisker.name))?);
            let freedom = shafts.degrees_of_freedom(whisker.shaft.links);
            let numbers = match shafts {
                ShaftModel::Chain => freedom,
                // A ball joint's position is a quaternion.
                ShaftModel::Cable => freedom / 3 * 4,
            };
            let positions = position..position + 1 + numbers;
            let velocities = velocity..velocity + 1 + freedom;
            (position, velocity) = (positions.end, velocities.end);
            joints[index] = Some(Joints { positions, velocities });
        }
        let room = model.pair_margin().len();
        let mut data = MjData::try_new(model).map_err(|error| refused(&error))?;
        data.reset_keyframe(0).map_err(|error| refused(&error))?;
        let kept = State {
            positions: data.qpos().to_vec(),
            velocities: data.qvel().to_vec(),
            accelerations: data.qacc_warmstart().to_vec(),
        };
        Ok(Self { data, kept, scope, joints, shafts, first_links, part_geoms, platform_geom, room })
    }

    /// Goes on from another's state. A whisker that was rigid there is straight and at rest; one that is rigid here was.
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

    /// Lets the engine look for contacts of these pairs alone, ascending by what may touch; there must be [room](Scope::room) for them.
    pub(super) fn look_for(&mut self, pairs: &[Pair]) {
        // A part that is not there is out of the window, and so out of reach until the model is another; rigid whiskers have no geoms.
        let geoms = pairs.iter().filter_map(|pair| Some((self.part_geom(pair.part)?, self.geom(pair.of)?)));
        let geoms: Vec<_> = geoms.collect();
        debug_assert!(geoms.len() <= self.room, "{} pairs, but room for {}", geoms.len(), self.room);
        let geoms = geoms.into_iter().take(self.room).collect::<Vec<_>>();
        #[expect(unsafe_code, reason = "pairs are a table that the engine takes for its own")]
        #[expect(
            clippy::cast_possible_wrap,
            reason = "no more than the model was compiled with, whose count is such a number"
        )]
        // SAFETY: `model_mut` demands that every size stays equal, and `npair` is one that does not. Why that is sound here:
        // - No array of the data is as long as there are pairs; its buffers and its arena stay as they were allocated.
        // - The model's own arrays of pairs stay where they are, as long as at first: `npair` is never above `room`, the number that was
        //   compiled. Beyond geoms and signatures all pairs are alike, so that what the others tell of a slot holds for any pair in it.
        // - A model with another `npair` than was allocated must not be copied, written out, swapped for another, or told compatible by
        //   its layout: this one belongs to the data alone, and nobody does any of that.
        // - All ids are those of geoms of this very model, looked up by name. The engine checks for each pair that there is a function for
        //   the kinds of its two geoms. A prism's mesh has a graph of its hull whether or not a pair named it at first, because
        //   it is given by its corners alone.
        // - The engine merges pairs with what its search by masks finds, by signatures that ascend: so they do, as bodies come in the
        //   order of pairs. In a model with room all masks are 0, and that search finds nothing.
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
            // The two bodies, of which the part's is the world, 0: it comes first, in the high half.
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

    /// Sets the velocities that the servos are to reach (m/s, rad/s).
    pub(super) fn command(&mut self, velocity: Vector2, yaw_rate: f64) {
        self.data.ctrl_mut().copy_from_slice(&[velocity.x, velocity.y, yaw_rate]);
    }

    /// Takes a step of this length (s).
    pub(super) fn step(&mut self, length: f64) {
        self.data.model_opt_mut().timestep = length;
        self.data.step();
    }

    /// Keeps the state, for [`Self::back`].
    pub(super) fn keep(&mut self) {
        let Self { data, kept, .. } = self;
        kept.positions.clone_from_slice(data.qpos());
        kept.velocities.clone_from_slice(data.qvel());
        kept.accelerations.clone_from_slice(data.qacc_warmstart());
    }

    /// Goes back to the state that was kept last.
    pub(super) fn back(&mut self) {
        let Self { data, kept, .. } = self;
        data.qpos_mut().copy_from_slice(&kept.positions);
        data.qvel_mut().copy_from_slice(&kept.velocities);
        data.qacc_warmstart_mut().copy_from_slice(&kept.accelerations);
    }

    /// What the engine has warned of. It resets its state when it diverges and goes on as if nothing had been; only its counters tell.
    pub(super) fn warning(&self) -> Option<&'static str> {
        let mut warned = self.data.warning().iter().zip(WARNINGS);
        warned.find(|(warning, _)| warning.number > 0).map(|(_, cause)| cause)
    }

    /// The depths (m) of all contacts before the last step, and whether the platform's body is in it.
    pub(super) fn contacts(&self) -> impl Iterator<Item = (f64, bool)> {
        self.data.contact().iter().map(|contact| (-contact.dist, contact.geom.contains(&self.platform_geom)))
    }

    /// The place (m, world frame) and link of a whisker's deepest contact.
    pub(super) fn deepest(&self, whisker: usize, links: usize) -> Option<(Point2, usize)> {
        let first = self.first_links[whisker]?;
        let link_of = |geom: &i32| usize::try_from(*geom).ok()?.checked_sub(first).filter(|link| *link < links);
        let contacts = self.data.contact().iter().filter(|contact| contact.dist < 0.0);
        let touching = contacts.filter_map(|contact| Some((contact, contact.geom.iter().find_map(link_of)?)));
        let (contact, link) = touching.min_by(|(a, _), (b, _)| a.dist.total_cmp(&b.dist))?;
        Some((Point2::new(contact.pos[0], contact.pos[1]), link))
    }

    /// Whether all positions are numbers.
    pub(super) fn is_finite(&self) -> bool {
        self.data.qpos().iter().all(|position| position.is_finite())
    }

    /// Where the platform is.
    pub(super) fn body(&self) -> Pose {
        let positions = self.data.qpos();
        Pose { position: Point2::new(positions[0], positions[1]), heading: positions[2] }
    }

    /// The platform's velocity (m/s) and yaw rate (rad/s).
    pub(super) fn body_velocity(&self) -> (Vector2, f64) {
        let velocities = self.data.qvel();
        (Vector2::new(velocities[0], velocities[1]), velocities[2])
    }

    /// Of every link of a whisker that bends, where it begins (m, world frame), and its direction (rad).
    pub(super) fn links(&self, rig: &Rig, whisker: usize) -> impl Iterator<Item = (Point2, f64)> {
        let Whisker { base_body, direction_body, shaft, .. } = &rig.whiskers[whisker];
        let (body, length) = (self.body(), shaft.link_length());
        let mut angles = self.angles(whisker);
        let mut start = body.point_to_world(*base_body);
        let mut direction = body.heading + direction_body + angles.next().unwrap_or(0.0);
        angles.map(move |turn| {
            direction += turn;
            let link = (start, direction);
            start += length * unit(direction);
            link
        })
    }

    /// The angles (rad) by which a whisker's hinge is turned, and then every link against what it is on; none if it is rigid.
    pub(super) fn angles(&self, whisker: usize) -> impl Iterator<Item = f64> {
        let joints = self.joints[whisker].as_ref();
        let positions = joints.map_or(&[][..], |joints| &self.data.qpos()[joints.positions.clone()]);
        self.by_joint(positions, 4).map(|position| match position {
            [angle] => *angle,
            // A quaternion about the vertical.
            [cosine, .., sine] => 2.0 * sine.atan2(*cosine),
            [] => 0.0,
        })
    }

    /// A bound on the speed (m/s) of a whisker's points against its base.
    pub(super) fn speed(&self, rig: &Rig, whisker: usize) -> f64 {
        let joints = self.joints[whisker].as_ref();
        let velocities = joints.map_or(&[][..], |joints| &self.data.qvel()[joints.velocities.clone()]);
        let rates = self.by_joint(velocities, 3).map(|velocity| match velocity {
            [rate] => *rate,
            rates => rates.iter().map(|rate| rate * rate).sum::<f64>().sqrt(),
        });
        swing(&rig.whiskers[whisker].shaft, rates)
    }

    /// What belongs to a whisker's hinge, and then to every link, of what its joints have, of which a ball has so many. A cable's first
    /// link is clamped, and has nothing.
    fn by_joint<'a>(&self, of_joints: &'a [f64], of_ball: usize) -> impl Iterator<Item = &'a [f64]> + use<'a> {
        let (hinge, along) = of_joints.split_at(of_joints.len().min(1));
        let (clamped, of_link) = match self.shafts {
            ShaftModel::Chain => (0, 1),
            ShaftModel::Cable => (hinge.len(), of_ball),
        };
        hinge.chunks_exact(1).chain(std::iter::repeat_n(&[][..], clamped)).chain(along.chunks_exact(of_link))
    }

    /// A bound on how far (m) a whisker's points went against its base since its joints were at these angles (rad).
    pub(super) fn swing_since(&self, rig: &Rig, whisker: usize, angles: &[f64]) -> f64 {
        let turns = self.angles(whisker).zip(angles).map(|(angle, before)| angle - before);
        swing(&rig.whiskers[whisker].shaft, turns)
    }

    /// Axial force and shear (N) that act on a whisker's shaft at its base. Needs forces to be sensed.
    pub(super) fn base_forces(&self, whisker: usize) -> (f64, f64) {
        let force = &self.data.sensordata()[3 * whisker..3 * whisker + 3];
        // MuJoCo reports what the platform does to the shaft.
        (-force[0], -force[1])
    }

    /// The energy (J) in springs and motion. Needs to be [refreshed](Self::refresh) after a step.
    pub(super) fn energy(&mut self) -> f64 {
        self.data.energy_pos();
        self.data.energy_vel();
        self.data.energy().iter().sum()
    }

    /// After a step, what is derived from places and speeds, such as what sensors hold, belongs to the state before it.
    pub(super) fn refresh(&mut self) {
        self.data.forward();
    }
}

/// A bound on how far (m) turns (rad) of a whisker's joints move its points, or on their speed: no joint moves the tip by more than the
/// shaft behind it is long.
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
    use crate::geometry::{circle, polygon};

    /// The geoms and the signatures of the pairs that an engine looks for.
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
        let rig = Rig::default();
        let scope = Scope::whole(&rig, &solids).with_room(1000);
        let parts = scope.part_count();
        let mut engine = Engine::new(&rig, &Physics::default(), &solids, Pose::default(), scope).unwrap();
        let mut compiled = pairs(&engine);
        let links = rig.whiskers.iter().enumerate();
        let links =
            links.flat_map(|(index, whisker)| (0..whisker.shaft.links).map(move |link| Member::Link(index, link)));
        let members = std::iter::once(Member::Body).chain(links);
        let all: Vec<_> = members.flat_map(|of| (0..parts).map(move |part| Pair { of, part })).collect();
        engine.look_for(&all[..3]);
        engine.look_for(&all);
        let mut named = pairs(&engine);
        assert!(parts > 2 && named.is_sorted_by_key(|(signature, ..)| signature), "{named:?}");
        compiled.sort_unstable();
        named.sort_unstable();
        assert_eq!(named, compiled);
    }
}
