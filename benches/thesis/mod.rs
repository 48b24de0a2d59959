//! The thesis's policy as one would write it in Rust: the yardstick for the compiled one.

use vibrissa::geometry::{Vector2, rotate, unit};
use vibrissa::machine::{Action, BodyScalar, Mover, Senses, Turn, WhiskerScalar, WhiskerVector};

/// `policies/thesis.fsm` by hand.
#[derive(Debug, Clone)]
pub(crate) struct Thesis {
    /// Speed (m/s).
    pub(crate) speed: f64,
    /// Base angle at which the tip is known best (rad).
    pub(crate) target: f64,
    /// Base angle at which a whisker is in danger (rad).
    pub(crate) limit: f64,
    /// Time without touch after which the contour is lost (s).
    pub(crate) lost: f64,
    pub(crate) state: State,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum State {
    Exploring,
    Swiping { whisker: usize, untouched_since: Option<f64> },
    Failed,
}

impl Thesis {
    pub(crate) fn tick<S: Senses>(&mut self, senses: &mut S) -> Action {
        let bent = |whisker| senses.whisker(whisker, WhiskerScalar::Deflection).abs() > self.limit;
        if bent(0) || bent(1) {
            self.state = State::Failed;
        }
        if self.state == State::Exploring {
            let touching = |&whisker: &usize| senses.whisker(whisker, WhiskerScalar::Touching) > 0.5;
            let Some(&whisker) = [0, 1].iter().find(|whisker| touching(whisker)) else {
                let along_world = unit(senses.body(BodyScalar::Yaw));
                return Action::Steer { mover: Mover::Body, along_world, speed: self.speed, turn: Turn::Rate(0.0) };
            };
            self.state = State::Swiping { whisker, untouched_since: None };
        }
        if let State::Swiping { whisker, untouched_since } = &mut self.state {
            let whisker = *whisker;
            let now = senses.time();
            let touching = senses.whisker(whisker, WhiskerScalar::Touching) > 0.5;
            *untouched_since = if touching { None } else { Some(untouched_since.unwrap_or(now)) };
            let lost = untouched_since.is_some_and(|since| now - since >= self.lost - 1e-9);
            if senses.whisker(whisker, WhiskerScalar::Sense) < 0.0 || lost {
                self.state = State::Failed;
            } else {
                senses.record(whisker);
                return self.swipe(whisker, senses);
            }
        }
        Action::Stop
    }

    fn swipe<S: Senses>(&self, whisker: usize, senses: &S) -> Action {
        let touching = senses.whisker(whisker, WhiskerScalar::Touching) > 0.5;
        if !touching || senses.whisker(whisker, WhiskerScalar::ContourReady) < 0.5 {
            return Action::Hold;
        }
        let tangent = senses.whisker_vector(whisker, WhiskerVector::ContourTangent);
        let deflection = senses.whisker(whisker, WhiskerScalar::Deflection);
        let wanted = senses.tip_at(whisker, if deflection == 0.0 { 0.0 } else { self.target * deflection.signum() });
        let miss_base = wanted - senses.whisker_vector(whisker, WhiskerVector::TipBase);
        let miss = rotate(miss_base, senses.whisker(whisker, WhiskerScalar::Yaw));
        let pull = (1.5 * miss.norm() / (wanted - senses.tip_at(whisker, 0.0)).norm()).clamp(0.0, 1.0);
        let towards = (-miss).try_normalize(0.0).unwrap_or_default();
        let along_world: Vector2 = pull * towards + (1.0 - pull) * tangent;
        let turn = Turn::Facing(tangent.y.atan2(tangent.x));
        Action::Steer { mover: Mover::Whisker(whisker), along_world, speed: self.speed, turn }
    }
}
