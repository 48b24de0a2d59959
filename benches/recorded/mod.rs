//! What a policy felt in one tick of a run.

use vibrissa::geometry::Vector2;
use vibrissa::machine::{BodyScalar, ContourVector, Senses, WhiskerScalar, WhiskerVector};
use vibrissa::run::Control;

/// All that can be asked of a whisker, each in the place that its own number names, as in [`Recorded`].
const SCALARS: [WhiskerScalar; 8] = [
    WhiskerScalar::Deflection,
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

/// What the thesis's policy felt in one tick, taken down so that reading it costs next to nothing.
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

impl Senses for &Recorded {
    fn time(&self) -> f64 {
        self.time
    }

    fn body(&self, quantity: BodyScalar) -> f64 {
        match quantity {
            BodyScalar::Yaw => self.yaw,
        }
    }

    fn body_position(&self) -> Vector2 {
        self.position
    }

    fn whisker(&self, whisker: usize, quantity: WhiskerScalar) -> f64 {
        self.whiskers[whisker].scalars[quantity as usize]
    }

    fn whisker_vector(&self, whisker: usize, quantity: WhiskerVector) -> Vector2 {
        self.whiskers[whisker].vectors[quantity as usize]
    }

    fn tip_at(&self, whisker: usize, deflection: f64) -> Vector2 {
        let same = |&&(recorded, _): &&(f64, Vector2)| recorded.total_cmp(&deflection).is_eq();
        self.whiskers[whisker].tip_at.iter().find(same).map_or(Vector2::new(f64::NAN, f64::NAN), |&(_, tip)| tip)
    }

    fn contour_at(&self, _: usize, _: f64, _: ContourVector) -> Vector2 {
        Vector2::new(f64::NAN, f64::NAN)
    }

    fn record(&mut self, _: usize) {}
}
