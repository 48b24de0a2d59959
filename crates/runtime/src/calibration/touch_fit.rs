//! The fit of a whisker's parameters to touches of a known object.

use std::cmp::Ordering;

use nalgebra::Matrix2;

use crate::geometry::{Pose, Vector2};
use crate::math;
use crate::mechanics::{Obstacle, Touch, TouchMechanics};
use crate::rig::Whisker;

use super::measured_whisker::MeasuredWhisker;
use super::parameters::{self, COUNT, Parameter, ParameterCovariance, Parameters};
use super::workspace::Workspace;

/// A touch of a known object: the pose of the platform at rest, and the reading of one whisker.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TouchReading {
    /// Pose of the platform.
    pub body: Pose,
    /// The touched part of the object (world frame).
    pub obstacle: Obstacle,
    /// False for a face whose position is known only to some millimetres and degrees. The fit then determines it too.
    /// All such touches are of the same face.
    pub is_known: bool,
    /// +1 if the object bends the whisker to the left, −1 if to the right.
    pub side: f64,
    /// Mean base angle (rad).
    pub base_angle: f64,
    /// Mean reading in the air, before or after the touch (rad).
    pub in_air: f64,
    /// Standard deviation of the difference of the two (rad), from the scatter of the readings.
    pub deviation: f64,
}

/// What is uncertain in a touch, apart from the readings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TouchNoise {
    /// Standard deviation of the position of the platform relative to the object (m), in each direction. It includes
    /// that of the model.
    pub position: f64,
    /// Standard deviation of the heading of the platform (rad).
    pub heading: f64,
}

impl Default for TouchNoise {
    fn default() -> Self {
        Self { position: 5e-5, heading: 3.5e-4 }
    }
}

/// The result of a fit.
#[derive(Debug, Clone, PartialEq)]
pub struct TouchFit {
    /// The whisker of the rig.
    pub(super) whisker: Whisker,
    /// The parameters, as differences from the rig.
    pub parameters: Parameters,
    /// Their covariance.
    pub covariance: ParameterCovariance,
    /// Sum of the squares of the residuals over their standard deviations, with that of the differences from the
    /// prior. It has as many degrees of freedom as there are touches.
    pub chi_square: f64,
    /// The residual of every touch in standard deviations.
    pub residuals: Vec<f64>,
    /// Coefficient of friction of the whisker when it slides, and its standard deviation.
    pub sliding_friction: [f64; 2],
}

/// Readings of a whisker while the object slides along it to its tip, and while it slides back over nearly the same place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    /// Mean reading while it slides to the tip.
    pub outwards: TouchReading,
    /// Mean reading while it slides back.
    pub back: TouchReading,
    /// Velocity of the platform (m/s, world frame) while it slides outwards. It slides back at the opposite one.
    pub velocity_world: Vector2,
}

/// The assumptions of a fit: the parameters before any touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Prior {
    pub(super) mean: Parameters,
    pub(super) deviation: Parameters,
}

impl Prior {
    /// The tolerances of manufacture. The position of the touched face is known exactly, or very roughly if a reading
    /// says so.
    pub(super) fn of(readings: &[TouchReading]) -> Self {
        let mut deviation = parameters::tolerances();
        if readings.iter().any(|reading| !reading.is_known) {
            deviation[Parameter::FaceHeight.index()] = FACE_HEIGHT;
            deviation[Parameter::FaceTurn.index()] = FACE_TURN;
        }
        Self { mean: Parameters::zeros(), deviation }
    }

    /// True if the position of the face is to be determined.
    fn has_unknown_face(&self) -> bool {
        self.deviation[Parameter::FaceHeight.index()] >= FACE_HEIGHT
    }
}

/// Standard deviations of the position of a face (m) and of its direction (rad) that are known roughly.
const FACE_HEIGHT: f64 = 10e-3;
const FACE_TURN: f64 = 0.1;
/// Step of the heights (m) that are tried as the start of the fit, and their number to either side.
const HEIGHT_STEP: f64 = 1e-3;
const HEIGHTS: i32 = 20;
/// Maximum number of steps of the Levenberg-Marquardt method.
const STEPS: usize = 40;
/// Change of the parameters, in standard deviations, at which it has converged.
const SETTLED: f64 = 1e-4;
/// Residual, in standard deviations, of a touch without an equilibrium.
const UNREACHED: f64 = 30.0;

/// Number of Newton steps for a coefficient of friction, the difference for its derivative, and its largest magnitude.
const FRICTION_STEPS: usize = 3;
const FRICTION_STEP: f64 = 0.02;
const LAG_STEP: f64 = 2e-3;
/// Standard deviation (s) of the lag of readings behind poses, or of poses behind readings, that is expected.
const READING_LAG: f64 = 0.03;
const MOST_FRICTION: f64 = 1.0;

/// A touch with the derivatives of its reading.
#[derive(Debug, Clone, Copy)]
pub(super) struct Predicted {
    /// Reading (rad).
    pub(super) reading: f64,
    /// Its derivatives by the parameters.
    pub(super) slope: Parameters,
    /// Its variance (rad²) due to the pose of the platform.
    pub(super) pose_variance: f64,
}

impl Predicted {
    /// The prediction for a touch. `obstacle` is in the body frame.
    pub(super) fn of(
        whisker: &Whisker,
        at: &Parameters,
        obstacle: &Obstacle,
        touch: &Touch,
        side: f64,
        noise: &TouchNoise,
    ) -> Option<Self> {
        let mut slope = Parameters::zeros();
        for index in 0..COUNT {
            let (sides, difference) = parameters::beside(at, index);
            let [(low, seen), (high, also_seen)] =
                sides.map(|beside| parameters::mechanics(whisker, &beside, obstacle));
            slope[index] = TouchMechanics::change(touch, [(&low, &seen), (&high, &also_seen)])? / difference;
        }
        slope[Parameter::Offset.index()] = 1.0;
        slope[Parameter::Play.index()] = side;
        let base = parameters::with_parameters(whisker, at).base_body;
        let [x, y] = [Parameter::BaseX, Parameter::BaseY].map(|parameter| slope[parameter.index()]);
        // A rotation of the platform rotates the whisker about its base and moves the base.
        let turn = slope[Parameter::Direction.index()] - base.y * x + base.x * y;
        let pose_variance = math::square(noise.position) * (x * x + y * y) + math::square(noise.heading * turn);
        let offset = at[Parameter::Offset.index()] + side * at[Parameter::Play.index()];
        Some(Self { reading: touch.base_angle + offset, slope, pose_variance })
    }
}

/// The state of the method: parameters, cost, and the normal equations.
struct Linearised {
    cost: f64,
    matrix: ParameterCovariance,
    gradient: Parameters,
    residuals: Vec<f64>,
    touches: Vec<Option<Touch>>,
}

impl Linearised {
    /// True if the state is at least as good as `other`. Far from an unknown face, a touch without an equilibrium costs less
    /// than one with a wrong reading. Then the touches with an equilibrium count first.
    fn is_better_than(&self, other: &Self, prior: &Prior) -> bool {
        let reached = |state: &Self| state.touches.iter().flatten().count();
        match reached(self).cmp(&reached(other)) {
            Ordering::Less if prior.has_unknown_face() => false,
            Ordering::Greater if prior.has_unknown_face() => true,
            _ => self.cost <= other.cost,
        }
    }
}

impl TouchFit {
    /// What is known before any touch: the rig with the tolerances of manufacture.
    #[must_use]
    pub fn untouched(whisker: &Whisker) -> Self {
        let deviations = parameters::tolerances();
        Self {
            whisker: whisker.clone(),
            parameters: Parameters::zeros(),
            covariance: ParameterCovariance::from_diagonal(&deviations.component_mul(&deviations)),
            chi_square: 0.0,
            residuals: Vec::new(),
            sliding_friction: unknown_friction(),
        }
    }

    /// Fits the parameters of a whisker to touches, from the tolerances of manufacture. `friction` is the expected
    /// coefficient. `None` if the mechanics have no equilibrium for the rig's whisker in most touches.
    #[must_use]
    pub fn new(whisker: &Whisker, touches: &[TouchReading], noise: &TouchNoise) -> Option<Self> {
        Self::with_prior(whisker, touches, noise, &Prior::of(touches))
    }

    /// The same for touches that no parameters near those of the rig explain.
    pub(super) fn unreached(mut self, readings: &[TouchReading]) -> Self {
        self.residuals = vec![UNREACHED; readings.len()];
        self.chi_square = UNREACHED * UNREACHED * readings.len() as f64;
        self
    }

    pub(super) fn with_prior(
        whisker: &Whisker,
        readings: &[TouchReading],
        noise: &TouchNoise,
        prior: &Prior,
    ) -> Option<Self> {
        let prior = with_offset(readings, prior);
        let mut here = prior.mean;
        let none = vec![None; readings.len()];
        let start = |at: &Parameters| linearised(whisker, at, readings, noise, &prior, &none);
        let mut state = start(&here);
        if prior.has_unknown_face() {
            // At a wrong height, most touches have no equilibrium and so no derivatives.
            for step in -HEIGHTS..=HEIGHTS {
                let mut at = prior.mean;
                at[Parameter::FaceHeight.index()] = HEIGHT_STEP * f64::from(step);
                let found = start(&at);
                if found.is_better_than(&state, &prior) {
                    (here, state) = (at, found);
                }
            }
        }
        let mut damping = 1e-3;
        for _ in 0..STEPS {
            let mut matrix = state.matrix;
            for index in 0..COUNT {
                matrix[(index, index)] *= 1.0 + damping;
            }
            let step = matrix.cholesky()?.solve(&state.gradient);
            let next = here - step;
            let found = linearised(whisker, &next, readings, noise, &prior, &state.touches);
            if found.is_better_than(&state, &prior) {
                let size = step.dot(&(state.matrix * step));
                (here, state, damping) = (next, found, 0.1 * damping);
                if size < SETTLED * SETTLED {
                    break;
                }
            } else {
                damping *= 10.0;
                if damping > 1e8 {
                    break;
                }
            }
        }
        if 2 * state.touches.iter().flatten().count() < readings.len() {
            return None;
        }
        let covariance = state.matrix.cholesky()?.inverse();
        Some(Self {
            whisker: whisker.clone(),
            parameters: here,
            covariance: 0.5 * (covariance + covariance.transpose()),
            chi_square: state.cost,
            residuals: state.residuals,
            sliding_friction: unknown_friction(),
        })
    }

    /// Measures the friction of the whisker when it slides. It turns the force outwards or back, so that the two readings
    /// of a stroke differ. Strokes without an equilibrium are left out.
    ///
    /// Readings that are late or early relative to the poses differ too, in proportion to the speed. So strokes with different speeds
    /// show both.
    #[must_use]
    pub fn with_strokes(mut self, strokes: &[Stroke], noise: &TouchNoise) -> Self {
        let deviations = Vector2::new(parameters::tolerances()[Parameter::Friction.index()], READING_LAG);
        let mut at = Vector2::zeros();
        for _ in 0..FRICTION_STEPS {
            // The friction and the lag with the least squares, linearised at the last ones.
            let mut information = Matrix2::from_diagonal(&deviations.map(|deviation| math::square(deviation).recip()));
            let mut moment = Vector2::zeros();
            for (rest, slopes, variance) in strokes.iter().filter_map(|stroke| self.linearised(stroke, at, noise)) {
                information += slopes * slopes.transpose() / variance;
                moment += slopes * ((rest + slopes.dot(&at)) / variance);
            }
            let Some(covariance) = information.try_inverse() else { return self };
            at = covariance * moment;
            at.x = at.x.clamp(-MOST_FRICTION, MOST_FRICTION);
            self.sliding_friction = [at.x, covariance.m11.sqrt()];
        }
        self
    }

    /// The difference between the two readings of a stroke that a friction and a lag (s) of readings behind poses do not explain, its
    /// slopes by both, and its variance.
    fn linearised(&self, stroke: &Stroke, at: Vector2, noise: &TouchNoise) -> Option<(f64, Vector2, f64)> {
        // The base angle of a contact with this friction, and its variance due to the pose of the platform.
        let predicted = |reading: &TouchReading, friction: f64, moved: Vector2| {
            let mut body = reading.body;
            body.position += moved;
            let obstacle = reading.obstacle.seen_from(body);
            let mut at = self.parameters;
            at[Parameter::Friction.index()] = friction;
            let (mechanics, seen) = parameters::mechanics(&self.whisker, &at, &obstacle);
            let touch = mechanics.press(&seen, reading.side)?;
            let predicted = Predicted::of(&self.whisker, &at, &obstacle, &touch, reading.side, noise)?;
            Some((predicted.reading, predicted.pose_variance))
        };
        let difference = |friction: f64, lag: f64| {
            let behind = -lag * stroke.velocity_world;
            let (outwards, one) = predicted(&stroke.outwards, friction, behind)?;
            let (back, other) = predicted(&stroke.back, -friction, -behind)?;
            Some((outwards - back, one + other))
        };
        let contact = |reading: &TouchReading| reading.base_angle - reading.in_air;
        let measured = contact(&stroke.outwards) - contact(&stroke.back);
        let variance = math::square(stroke.outwards.deviation) + math::square(stroke.back.deviation);
        let (here, pose_variance) = difference(at.x, at.y)?;
        let by_friction = (difference(at.x + FRICTION_STEP, at.y)?.0 - here) / FRICTION_STEP;
        let by_lag = (difference(at.x, at.y + LAG_STEP)?.0 - here) / LAG_STEP;
        let linear = (measured - here, Vector2::new(by_friction, by_lag), variance + pose_variance);
        (linear.0.is_finite() && linear.1.norm().is_finite() && linear.2 > 0.0).then_some(linear)
    }

    /// Standard deviation of tips (m, along the normal of the surface) that the errors of the parameters cause: the root
    /// mean square over the contacts of contour following.
    #[must_use]
    pub fn tip_deviation(&self) -> f64 {
        Workspace::new(&self.whisker, &Parameters::zeros()).deviation(&self.covariance)
    }

    /// The whisker as perception should model it.
    #[must_use]
    pub fn measured(&self) -> MeasuredWhisker {
        parameters::measured(&self.whisker, &self.parameters, &self.covariance, self.sliding_friction)
    }
}

/// The friction before any stroke.
fn unknown_friction() -> [f64; 2] {
    [0.0, parameters::tolerances()[Parameter::Friction.index()]]
}

/// The prior with the offset that the newest reading in the air shows.
fn with_offset(readings: &[TouchReading], prior: &Prior) -> Prior {
    let mut prior = *prior;
    if let Some(newest) = readings.last() {
        prior.mean[Parameter::Offset.index()] = newest.in_air;
        prior.deviation[Parameter::Offset.index()] = newest.deviation;
    }
    prior
}

/// The cost at some parameters, with its derivatives to first order.
fn linearised(
    whisker: &Whisker,
    at: &Parameters,
    readings: &[TouchReading],
    noise: &TouchNoise,
    prior: &Prior,
    before: &[Option<Touch>],
) -> Linearised {
    let mut state = Linearised {
        cost: 0.0,
        matrix: ParameterCovariance::zeros(),
        gradient: Parameters::zeros(),
        residuals: Vec::with_capacity(readings.len()),
        touches: Vec::with_capacity(readings.len()),
    };
    for index in 0..COUNT {
        let weight = math::square(prior.deviation[index]).recip();
        let off = at[index] - prior.mean[index];
        state.cost += weight * off * off;
        state.matrix[(index, index)] += weight;
        state.gradient[index] += weight * off;
    }
    for (reading, before) in readings.iter().zip(before) {
        let obstacle = reading.obstacle.seen_from(reading.body);
        let (mechanics, seen) = parameters::mechanics(whisker, at, &obstacle);
        let near = before.and_then(|touch| mechanics.near(&seen, &touch));
        let touch = near.or_else(|| mechanics.press(&seen, reading.side));
        let predicted = touch.and_then(|touch| Predicted::of(whisker, at, &obstacle, &touch, reading.side, noise));
        state.touches.push(touch);
        let Some(predicted) = predicted else {
            state.cost += UNREACHED * UNREACHED;
            state.residuals.push(UNREACHED);
            continue;
        };
        // The offset at the time of the touch is known from the air. It may drift until the newest one.
        let mut slope = predicted.slope;
        slope[Parameter::Offset.index()] = 0.0;
        let contact = predicted.reading - at[Parameter::Offset.index()];
        let variance = math::square(reading.deviation) + predicted.pose_variance;
        let off = contact - (reading.base_angle - reading.in_air);
        state.cost += off * off / variance;
        state.residuals.push(off / variance.sqrt());
        state.matrix += slope * slope.transpose() / variance;
        state.gradient += slope * (off / variance);
    }
    state
}
