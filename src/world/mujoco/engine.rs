//! A compiled model and its state.

use std::ops::Range;

use mujoco_rs::prelude::{MjData, MjModel};
use mujoco_rs::wrappers::mj_model::MjtObjBase;

use crate::geometry::{Point2, Pose, Vector2};
use crate::rig::{Rig, ShaftModel};
use crate::scene::{Scope, Solid, mjcf_within};
use crate::world::Fault;

use super::messages::WARNINGS;
use super::world::MujocoError;

/// The joints of the platform come first: along x, along y, yaw.
const PLATFORM_JOINTS: usize = 3;

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
    /// A model of the same layout, which is changed and then takes the other's place: models in use cannot be changed.
    spare: Option<Box<MjModel>>,
    kept: State,
    pub(super) scope: Scope,
    /// The joints of every whisker that bends.
    joints: Vec<Option<Joints>>,
    shafts: ShaftModel,
    /// The geom of the first link of every whisker that bends; those of the others come one after the other.
    first_links: Vec<Option<usize>>,
    platform_geom: i32,
    /// Whether contacts are a matter of masks; else of pairs.
    by_masks: bool,
    /// The first link of every whisker that the engine looks for contacts of.
    touching_from: Vec<usize>,
}

impl Engine {
    pub(super) fn new(rig: &Rig, solids: &[Solid], start: Pose, scope: Scope) -> Result<Self, MujocoError> {
        let refused = |error: &dyn std::fmt::Display| MujocoError::Model(error.to_string());
        let xml = mjcf_within(rig, solids, start, &scope);
        let model = Box::new(MjModel::from_xml_string(&xml).map_err(|error| refused(&error))?);
        let geom = |name: &str| {
            let id = model.name_to_id(MjtObjBase::mjOBJ_GEOM, name);
            id.ok_or_else(|| refused(&format_args!("it has no geom `{name}`")))
        };
        let platform_geom = i32::try_from(geom("platform/body")?).map_err(|error| refused(&error))?;
        let mut joints = vec![None; rig.whiskers.len()];
        let mut first_links = joints.iter().map(|_| None).collect::<Vec<_>>();
        let shafts = rig.physics.shafts;
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
        let by_masks = model.pair_margin().is_empty();
        let spare = Some(model.clone());
        let mut data = MjData::try_new(model).map_err(|error| refused(&error))?;
        data.reset_keyframe(0).map_err(|error| refused(&error))?;
        let kept = State {
            positions: data.qpos().to_vec(),
            velocities: data.qvel().to_vec(),
            accelerations: data.qacc_warmstart().to_vec(),
        };
        let touching_from = vec![0; rig.whiskers.len()];
        Ok(Self { data, spare, kept, scope, joints, shafts, first_links, platform_geom, by_masks, touching_from })
    }

    /// Goes on from another's state. A whisker that was rigid there is straight and at rest; one that is rigid here was.
    pub(super) fn resume(&mut self, other: &Self) {
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

    /// Lets the engine look for contacts of every whisker's links from these on, and of no other link.
    pub(super) fn touch_from(&mut self, rig: &Rig, first: &[usize]) {
        if self.touching_from == first {
            return;
        }
        let Some(mut model) = self.spare.take() else { return };
        for (index, whisker) in self.scope.flexible(rig) {
            let Some(first_link) = self.first_links[index] else { continue };
            for link in 0..whisker.shaft.links {
                let body = usize::try_from(model.geom_bodyid()[first_link + link]).unwrap_or_default();
                let touches = self.by_masks && link >= first[index];
                model.geom_conaffinity_mut()[first_link + link] = i32::from(touches);
                model.body_conaffinity_mut()[body] = i32::from(touches);
            }
            let links = first_link..first_link + whisker.shaft.links;
            for pair in 0..model.pair_margin().len() {
                let geoms = [model.pair_geom1()[pair], model.pair_geom2()[pair]]
                    .map(|geom| usize::try_from(geom).unwrap_or_default());
                if let Some(link) = geoms.into_iter().find(|geom| links.contains(geom)) {
                    let margin = if link - first_link >= first[index] { 0.0 } else { never(&model, geoms) };
                    model.pair_margin_mut()[pair] = margin;
                }
            }
        }
        self.touching_from.copy_from_slice(first);
        // The two have the same layout, as one is the other's clone.
        self.spare = Some(self.data.swap_model(model));
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

    /// The angle (rad) of a whisker's hinge; 0 if it is rigid.
    pub(super) fn base_angle(&self, whisker: usize) -> f64 {
        self.joints[whisker].as_ref().map_or(0.0, |joints| self.data.qpos()[joints.positions.start])
    }

    /// How far (rad) every link of a whisker is turned against what it is on, of so many links.
    pub(super) fn turns(&self, whisker: usize, links: usize) -> Vec<f64> {
        let Some(joints) = &self.joints[whisker] else { return vec![0.0; links] };
        let along = &self.data.qpos()[joints.positions.start + 1..joints.positions.end];
        match self.shafts {
            ShaftModel::Chain => along.to_vec(),
            ShaftModel::Cable => {
                let about_vertical = |quaternion: &[f64]| 2.0 * quaternion[3].atan2(quaternion[0]);
                std::iter::once(0.0).chain(along.chunks_exact(4).map(about_vertical)).collect()
            }
        }
    }

    /// A bound on the speed (m/s) of a whisker's points against its base: no joint moves the tip faster than the shaft behind it is long.
    pub(super) fn speed(&self, rig: &Rig, whisker: usize) -> f64 {
        let Some(joints) = &self.joints[whisker] else { return 0.0 };
        let shaft = &rig.whiskers[whisker].shaft;
        let behind = |link: usize| shaft.length - link as f64 * shaft.link_length();
        let rates = &self.data.qvel()[joints.velocities.clone()];
        let Some((hinge, along)) = rates.split_first() else { return 0.0 };
        let of_shaft: f64 = match self.shafts {
            ShaftModel::Chain => along.iter().enumerate().map(|(link, rate)| rate.abs() * behind(link)).sum(),
            ShaftModel::Cable => {
                let norm = |rates: &[f64]| rates.iter().map(|rate| rate * rate).sum::<f64>().sqrt();
                along.chunks_exact(3).enumerate().map(|(joint, rates)| norm(rates) * behind(joint + 1)).sum()
            }
        };
        hinge.abs() * shaft.length + of_shaft
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

/// The margin (m) at which the engine drops a pair at its first look: it compares the distance of two middles with the sum of the radii
/// of the spheres about both and the margin, by their squares.
fn never(model: &MjModel, geoms: [usize; 2]) -> f64 {
    -geoms.into_iter().filter_map(|geom| model.geom_rbound().get(geom)).sum::<f64>()
}

impl From<MujocoError> for Fault {
    fn from(cause: MujocoError) -> Self {
        Self::Model { cause: cause.to_string() }
    }
}
