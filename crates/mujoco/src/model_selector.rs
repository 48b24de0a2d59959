//! The selection of the model for the current state.

use super::{Reach, Scope, is_gentle, may_be_rigid};
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::Command;
use vibrissa_world::geometry::{Point2, Pose};
use vibrissa_world::physics::Physics;
use vibrissa_world::solid::{PartsError, Solid};

use super::broad_phase::BroadPhase;
use super::engine::Engine;
use super::world::MujocoError;

/// A whisker without contact is at rest if its hinge reads less than this share of the contact threshold,
const REST: f64 = 0.01;
/// and if its speed relative to the base is less than this (m/s). It is the speed of residual vibration at such a
/// reading.
const REST_SPEED: f64 = 2e-3;
/// Margins for the motion of the platform in a tick: relative to the motion at its velocity, and absolute (m).
const TRAVEL: (f64, f64) = (0.5, 1e-3);
/// Selects the model: the parts in reach, the flexible whiskers, and the pairs that may touch.
pub(super) struct ModelSelector {
    /// The initial capacity for pairs of a pruned model. `None` for a complete model, in which only rigid whiskers are
    /// selected.
    capacity: Option<usize>,
    reach: Reach,
    physics: Physics,
    /// The centre (m, world frame) of the window for which the model contains all parts in reach.
    window: Option<Point2>,
    /// Other models with the same parts and capacity, but with other rigid whiskers.
    others: Vec<Engine>,
    broad_phase: BroadPhase,
}

impl ModelSelector {
    /// The selection among `solids`.
    ///
    /// # Errors
    /// [`PartsError`] if a solid is too large for MuJoCo.
    pub(super) fn new(
        rig: &Rig,
        physics: &Physics,
        solids: &[Solid],
        capacity: Option<usize>,
    ) -> Result<Self, PartsError> {
        Ok(Self {
            capacity,
            reach: Reach::new(rig, solids)?,
            physics: physics.clone(),
            window: None,
            others: Vec::new(),
            broad_phase: BroadPhase::default(),
        })
    }

    /// Builds the model for the start.
    pub(super) fn initial_model(&mut self, rig: &Rig, start: Pose) -> Result<Engine, MujocoError> {
        let mut scope = Scope::whole(rig, self.reach.parts());
        for (index, whisker) in rig.whiskers.iter().enumerate() {
            let is_rigid = self.physics.has_rigid_whiskers()
                && may_be_rigid(whisker, self.reach.clearance(whisker, &start), 0.0, false);
            scope = scope.with_rigid(index, is_rigid);
        }
        if let Some(capacity) = self.capacity {
            scope = scope.with_capacity(capacity);
            if self.reach.is_windowed() {
                scope = scope.with_parts(self.reach.parts_about(start.position));
                self.window = Some(start.position);
            }
        }
        Engine::new(rig, &self.physics, self.reach.parts(), start, scope)
    }

    /// Replaces the model, if necessary, before the next tick under `command`.
    pub(super) fn select(&mut self, rig: &Rig, engine: &mut Engine, command: &Command) -> Result<(), MujocoError> {
        let body = engine.body();
        let (velocity, yaw_rate) = engine.body_velocity();
        let period = rig.sensing.control_rate.recip();
        let speed = velocity.norm().max(command.velocity_world.norm());
        let turning = yaw_rate.abs().max(command.yaw_rate.abs());
        let travel = |radius: f64| (1.0 + TRAVEL.0) * period * (speed + radius * turning) + TRAVEL.1;
        let mut scope = engine.scope.clone();
        for (index, whisker) in rig.whiskers.iter().enumerate() {
            let travel = travel(whisker.base_body.coords.norm());
            let clearance = self.reach.clearance(whisker, &body);
            let is_rigid = engine.scope.is_rigid(index);
            let stays = self.physics.has_rigid_whiskers()
                && may_be_rigid(whisker, clearance, travel, is_rigid)
                && is_gentle(rig, whisker, command, velocity, yaw_rate)
                && (is_rigid || is_at_rest(rig, engine, index));
            scope = scope.with_rigid(index, stays);
        }
        if let Some(centre) = self.window
            && !self.reach.is_within(body.position, centre, travel(0.0))
        {
            let centre = self.reach.window_ahead(body.position, command.velocity_world);
            self.window = Some(centre);
            scope = scope.with_parts(self.reach.parts_about(centre));
        }
        if scope != engine.scope {
            self.replace(rig, engine, scope)?;
        }
        Ok(())
    }

    /// Updates the pairs that the engine tests for contact at the current state.
    pub(super) fn update_pairs(&mut self, rig: &Rig, engine: &mut Engine) -> Result<(), MujocoError> {
        let Some(capacity) = engine.scope.capacity() else { return Ok(()) };
        let Some(pairs) = self.broad_phase.changed_pairs(rig, &self.reach, engine) else { return Ok(()) };
        if pairs.len() <= capacity {
            engine.set_pairs(pairs);
            return Ok(());
        }
        let scope = engine.scope.clone().with_capacity(2 * pairs.len());
        self.replace(rig, engine, scope)?;
        self.update_pairs(rig, engine)
    }

    fn replace(&mut self, rig: &Rig, engine: &mut Engine, scope: Scope) -> Result<(), MujocoError> {
        self.broad_phase.invalidate();
        if !scope.is_like(&engine.scope) {
            self.others.clear();
        }
        let known = self.others.iter().position(|other| other.scope == scope);
        let mut next = match known {
            Some(index) => self.others.swap_remove(index),
            None => Engine::new(rig, &self.physics, self.reach.parts(), engine.body(), scope)?,
        };
        next.resume(engine);
        let last = std::mem::replace(engine, next);
        if last.scope.is_like(&engine.scope) {
            self.others.push(last);
        }
        Ok(())
    }
}

/// True if a whisker without contact is so still that it can become rigid.
fn is_at_rest(rig: &Rig, engine: &Engine, whisker: usize) -> bool {
    let reading = engine.angles(whisker).next().map_or(0.0, |[angle, _]| angle.abs());
    reading < REST * rig.sensing.contact_threshold && engine.speed(rig, whisker) < REST_SPEED
}
