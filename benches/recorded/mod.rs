//! What a policy felt in one tick of a run.

use vibrissa::geometry::Vector2;
use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::{BodyScalar, ContourVector, Senses, WhiskerScalar, WhiskerVector};

/// All that can be asked of a whisker, each in the place that its own number names, as in [`Recorded`].
const SCALARS: [WhiskerScalar; 8] = [
    WhiskerScalar::BaseAngle,
    WhiskerScalar::Touching,
    WhiskerScalar::Yaw,
    WhiskerScalar::Side,
    WhiskerScalar::Sense,
    WhiskerScalar::Length,
    WhiskerScalar::ContourReady,
    WhiskerScalar::ContourCurvature,
];
const VECTORS: [WhiskerVector; 5] = [
    WhiskerVector::Tip,
    WhiskerVector::TipBase,
    WhiskerVector::Base,
    WhiskerVector::ContourTangent,
    WhiskerVector::ContourEnd,
];

/// How far behind a contour's end (m) the policy asks for its direction.
const BACK: f64 = 5e-3;

/// The values that `thesis.fsm` read in one tick. They are recorded, so that reading them costs almost nothing.
#[derive(Debug, Clone)]
pub(crate) struct Recorded {
    time: f64,
    yaw: f64,
    position: Vector2,
    whiskers: Vec<Whisker>,
}

#[derive(Debug, Clone)]
struct Whisker {
    scalars: [f64; SCALARS.len()],
    vectors: [Vector2; VECTORS.len()],
    /// The contour's direction at the distance [`BACK`] behind its end.
    way: Vector2,
    /// The tip at no deflection, and at the target of either sign.
    tip_at: [(f64, Vector2); 3],
}

impl Recorded {
    /// What the tick that `control` has just done read. It recorded its contour point before it asked for the contour, and
    /// asked for nothing before that changes by it: so this is what it got.
    pub(crate) fn after(control: &Control, target: f64) -> Self {
        let senses = control.perception();
        let whisker = |index| Whisker {
            scalars: SCALARS.map(|quantity| senses.whisker(index, quantity)),
            vectors: VECTORS.map(|quantity| senses.whisker_vector(index, quantity)),
            way: senses.contour_at(index, BACK, ContourVector::Tangent),
            tip_at: [0.0, target, -target].map(|deflection| (deflection, senses.tip_at(index, deflection))),
        };
        Self {
            time: Senses::time(senses),
            yaw: senses.body(BodyScalar::Yaw),
            position: senses.body_position(),
            whiskers: (0..control.machine().program().whiskers.len()).map(whisker).collect(),
        }
    }
}

/// What was felt after a command. In a loop nothing can be felt before that: every number waits for the one before it, so that
/// the processor cannot do two ticks at once.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Felt<'r> {
    pub(crate) recorded: &'r Recorded,
    /// Zero.
    pub(crate) command: f64,
}

impl Felt<'_> {
    fn vector(&self, recorded: Vector2) -> Vector2 {
        recorded.add_scalar(self.command)
    }
}

impl Senses for Felt<'_> {
    fn time(&self) -> f64 {
        self.recorded.time + self.command
    }

    fn body(&self, quantity: BodyScalar) -> f64 {
        match quantity {
            BodyScalar::Yaw => self.recorded.yaw + self.command,
            _ => self.command,
        }
    }

    fn body_position(&self) -> Vector2 {
        self.vector(self.recorded.position)
    }

    fn whisker(&self, whisker: usize, quantity: WhiskerScalar) -> f64 {
        self.recorded.whiskers[whisker].scalars[quantity as usize] + self.command
    }

    fn whisker_vector(&self, whisker: usize, quantity: WhiskerVector) -> Vector2 {
        self.vector(self.recorded.whiskers[whisker].vectors[quantity as usize])
    }

    fn tip_at(&self, whisker: usize, deflection: f64) -> Vector2 {
        let same = |&&(recorded, _): &&(f64, Vector2)| recorded.total_cmp(&deflection).is_eq();
        self.recorded.whiskers[whisker]
            .tip_at
            .iter()
            .find(same)
            .map_or(Vector2::new(f64::NAN, f64::NAN), |&(_, tip)| tip)
    }

    fn contour_at(&self, whisker: usize, back: f64, quantity: ContourVector) -> Vector2 {
        assert!(quantity == ContourVector::Tangent && back.total_cmp(&BACK).is_eq(), "nothing else was recorded");
        self.vector(self.recorded.whiskers[whisker].way)
    }

    fn loop_closed(&self, _: usize, _: f64, _: f64) -> bool {
        false
    }

    fn record(&mut self, _: usize) {}

    fn record_position(&mut self, _: usize, _: Vector2) {}
}
