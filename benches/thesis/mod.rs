//! The contour following of `thesis.fsm`, written in Rust, as the reference for the compiled policy.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use vibrissa::geometry::{Vector2, rotate, turn_between, unit};
use vibrissa_runtime::machine::{Action, BodyScalar, ContourVector, Mover, Senses, Turn, WhiskerScalar, WhiskerVector};
use vibrissa_runtime::math;

/// The state `Following` of `policies/thesis.fsm` by hand, with all that it uses of the standard library.
#[derive(Debug, Clone)]
pub(crate) struct Following {
    /// Speed (m/s).
    pub(crate) speed: f64,
    /// Base angle at which the tip is known best (rad).
    pub(crate) target: f64,
    /// Base angle at which a whisker is in danger (rad).
    pub(crate) limit: f64,
    /// Time without touch after which the contour is lost (s).
    pub(crate) lost_for: f64,
    /// Loss of bend from tick to tick by which a whisker springs off an edge (rad).
    pub(crate) spring: f64,
    /// Least base angle along a wall (rad).
    pub(crate) light: f64,
    /// The whisker that swipes, and the other one.
    pub(crate) whiskers: [usize; 2],
    pub(crate) memory: Memory,
}

/// What swiping remembers.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Memory {
    bend: f64,
    edge: Vector2,
    way: Vector2,
    last_edge: Vector2,
    last_way: Vector2,
    between_since: Option<f64>,
    lost_since: Option<f64>,
    /// The yaw controllers along the contour and straight on.
    yaw: [Controller; 2],
}

/// A PID controller's past, without its derivative part, which this law does not use.
#[derive(Debug, Clone, Copy, Default)]
struct Controller {
    before: Option<f64>,
    integral: f64,
}

impl Controller {
    fn next(&mut self, now: f64, error: f64, [p, i, limit]: [f64; 3]) -> f64 {
        let grown = self.integral + error * self.before.map_or(0.0, |before| now - before);
        let output = p * error + i * grown;
        self.before = Some(now);
        if output.abs() <= limit {
            self.integral = grown;
        }
        output.clamp(-limit, limit)
    }
}

impl Following {
    /// One tick; `None` if it would leave the state.
    pub(crate) fn tick<S: Senses>(&mut self, senses: &mut S) -> Option<Action> {
        let [whisker, other] = self.whiskers;
        let now = senses.time();
        let deflection = senses.whisker(whisker, WhiskerScalar::BaseAngle);
        if deflection.abs() > self.limit || senses.whisker(other, WhiskerScalar::BaseAngle).abs() > self.limit {
            return None;
        }
        let touching = senses.whisker(whisker, WhiskerScalar::Touching) > 0.5;
        let sense = senses.whisker(whisker, WhiskerScalar::Sense);
        let is_along_wall = |index: usize| {
            senses.whisker(index, WhiskerScalar::Sense) > 0.0
                && senses.whisker(index, WhiskerScalar::BaseAngle).abs() > self.light
        };
        let trails = |index: usize| mounting_offset(index, senses) == 0.0;
        let is_between = is_along_wall(whisker) && is_along_wall(other) && trails(whisker) && trails(other);
        let travel_heading = senses.body(BodyScalar::Yaw) - mounting_offset(whisker, senses);
        let ahead = unit(travel_heading);
        let runs_ahead = |senses: &S| senses.whisker_vector(whisker, WhiskerVector::ContourTangent).dot(&ahead) > 0.3;
        if lasts(&mut self.memory.between_since, is_between, now, 0.1)
            || (deflection.abs() > 1.1 * self.target && !runs_ahead(senses))
            || deflection.abs() < self.memory.bend - self.spring
            || sense < 0.0
            || lasts(&mut self.memory.lost_since, !touching, now, self.lost_for)
        {
            return None;
        }
        senses.record(whisker);
        let side = senses.whisker(whisker, WhiskerScalar::Side);
        let action = if !runs_ahead(senses) {
            self.follow(whisker, 1, (ahead, self.target * side), now, senses)
        } else if touching && senses.whisker(whisker, WhiskerScalar::ContourReady) > 0.5 {
            let target = if deflection == 0.0 { 0.0 } else { self.target * deflection.signum() };
            let tangent = senses.whisker_vector(whisker, WhiskerVector::ContourTangent);
            self.follow(whisker, 0, (tangent, target), now, senses)
        } else {
            Action::Hold
        };
        let memory = &mut self.memory;
        let (edge, way) = (
            senses.whisker_vector(whisker, WhiskerVector::ContourEnd),
            senses.contour_at(whisker, 0.005, ContourVector::Tangent),
        );
        (memory.edge, memory.way) = if deflection.abs() < memory.bend - self.spring / 3.0 {
            (memory.last_edge, memory.last_way)
        } else {
            (edge, way)
        };
        (memory.last_edge, memory.last_way, memory.bend) = (edge, way, deflection.abs());
        Some(action)
    }

    fn follow<S: Senses>(
        &mut self,
        whisker: usize,
        controller: usize,
        (tangent, target): (Vector2, f64),
        now: f64,
        senses: &S,
    ) -> Action {
        let heading = math::atan2(tangent.y, tangent.x) + mounting_offset(whisker, senses);
        let off = turn_between(senses.body(BodyScalar::Yaw), heading);
        let gain = (self.speed / 0.025).min(2.0);
        let limit = (self.speed / 0.06).min(FRAC_PI_4);
        let rate = self.memory.yaw[controller].next(now, off, [gain, gain * gain / 5.0, limit]);
        let wanted = senses.tip_at(whisker, target);
        let yaw = senses.whisker(whisker, WhiskerScalar::Yaw);
        let offset = rotate(senses.whisker_vector(whisker, WhiskerVector::TipBase) - wanted, yaw);
        let pull = (1.5 * offset.norm() / (wanted - senses.tip_at(whisker, 0.0)).norm()).clamp(0.0, 0.6);
        let towards = offset.try_normalize(0.0).unwrap_or_default();
        let along_world = tangent * (1.0 - pull) + towards * pull;
        Action::Steer { mover: Mover::Whisker(whisker), along_world, speed: self.speed, turn: Turn::Rate(rate) }
    }
}

/// The yaw offset (rad) of the body from the surface that the mounting of a whisker needs.
fn mounting_offset<S: Senses>(whisker: usize, senses: &S) -> f64 {
    let side = senses.whisker(whisker, WhiskerScalar::Side);
    let mounting = turn_between(senses.body(BodyScalar::Yaw), senses.whisker(whisker, WhiskerScalar::Yaw));
    2.0 * (FRAC_PI_2 - mounting * side).max(0.0) * side
}

/// Whether a condition has held for a time; `since` is when it began to.
fn lasts(since: &mut Option<f64>, holds: bool, now: f64, time: f64) -> bool {
    *since = if holds { Some(since.unwrap_or(now)) } else { None };
    since.is_some_and(|since| now - since >= time - 1e-9)
}
