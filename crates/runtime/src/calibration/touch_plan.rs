//! The choice of the next touch of a known pin.

use crate::geometry::Point2;
use crate::math;
use crate::mechanics::Obstacle;
use crate::rig::Whisker;

use super::parameters::{self, Parameter, ParameterCovariance, Parameters};
use super::refusal::{DETERMINED, TouchRefusal};
use super::touch_fit::{Predicted, TouchFit, TouchNoise};
use super::workspace::Workspace;

/// A planned touch of a pin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlannedTouch {
    /// Position of the pin's axis (m) in the frame of the base that the rig assumes. The pin comes from the straight
    /// shaft, perpendicular to it.
    pub pin_base: Point2,
    /// +1 if the pin bends the whisker to the left, −1 if to the right.
    pub side: f64,
    /// Base angle of the rig's whisker (rad).
    pub base_angle: f64,
}

/// The touches of a pin that a whisker can make, with their information about its parameters.
#[derive(Debug, Clone)]
pub struct TouchPlan {
    candidates: Vec<Candidate>,
    /// Standard deviation of a reading relative to the air (rad).
    deviation: f64,
    workspace: Workspace,
}

/// A possible touch.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    planned: PlannedTouch,
    /// Derivatives of the reading by the parameters. The offset is known from the air.
    slope: Parameters,
    /// Variance of the reading (rad²) that is due to the pose.
    variance: f64,
}

/// Positions of the pin along the shaft, as shares of its length. Beyond 1 the tip touches first.
const SHARES: [f64; 8] = [0.45, 0.55, 0.65, 0.75, 0.83, 0.9, 0.96, 1.0];
/// Positions of the pin beyond the tip, as shares of its radius.
const BEYOND: [f64; 3] = [0.2, 0.4, 0.6];
/// Depths of the pin in steps, as shares of the length of the shaft.
const DEPTH_STEP: f64 = 0.03;
const DEPTHS: u32 = 14;
/// Number of touches before the depth at which the whisker slips off that are left out.
const SLIPPERY: usize = 2;
/// Least and largest base angle of a touch, in the unit of the mechanics.
const LEVELS: (f64, f64) = (0.2, 2.4);
/// Distance (m) below which two positions of the pin are the same.
const NEAR: f64 = 1e-6;

impl TouchPlan {
    /// Lists the touches of a whisker and a pin with this `radius` (m). `deviation` (rad) is the standard deviation of a
    /// reading relative to the air.
    #[must_use]
    pub fn new(whisker: &Whisker, radius: f64, deviation: f64, noise: &TouchNoise) -> Self {
        let length = whisker.shaft.length;
        let places =
            SHARES.iter().map(|share| share * length).chain(BEYOND.iter().map(|share| length + share * radius));
        let touches = places.flat_map(|along| [(along, -1.0), (along, 1.0)]);
        let candidates = touches.flat_map(|(along, side)| touches_at(whisker, along, side, radius, noise)).collect();
        Self { candidates, deviation, workspace: Workspace::new(whisker, &Parameters::zeros()) }
    }

    /// Chooses the touch after which the standard deviation of tips is smallest (A-optimal for tips). Touches like the
    /// `missed` ones, in which the whisker slipped off, are left out. `None` if no touch is possible.
    #[must_use]
    pub fn next(&self, fit: &TouchFit, missed: &[PlannedTouch]) -> Option<PlannedTouch> {
        let possible =
            self.candidates.iter().filter(|candidate| !missed.iter().any(|missed| candidate.planned.is_beyond(missed)));
        let rated = possible.map(|candidate| {
            (self.workspace.deviation(&candidate.covariance_after(&fit.covariance, self.deviation)), candidate.planned)
        });
        rated.min_by(|(a, _), (b, _)| a.total_cmp(b)).map(|(_, planned)| planned)
    }

    /// Checks that so many `touches` of the `whisker`, each the best one after those before it, can say more about tips than the
    /// tolerances of manufacture. `deviation` (rad) is the least standard deviation of a reading relative to the air.
    ///
    /// # Errors
    /// [`TouchRefusal::Hopeless`] if they cannot.
    pub fn check(&self, whisker: &Whisker, touches: usize, deviation: f64) -> Result<(), TouchRefusal> {
        let mut fit = TouchFit::untouched(whisker);
        let untouched = self.tip_deviation(&fit);
        let mut least = untouched;
        // The readings in the air tell the offset.
        let offset = Parameter::Offset.index();
        fit.covariance[(offset, offset)] = 0.0;
        for _ in 0..touches {
            let after = self.candidates.iter().map(|candidate| candidate.covariance_after(&fit.covariance, deviation));
            let rated = after.map(|covariance| (self.workspace.deviation(&covariance), covariance));
            let Some((deviation, covariance)) = rated.min_by(|(a, _), (b, _)| a.total_cmp(b)) else { break };
            (least, fit.covariance) = (deviation, covariance);
            if least < DETERMINED * untouched {
                break;
            }
        }
        // Without a contact or a possible touch, the touches themselves tell the reason.
        if self.candidates.is_empty() || untouched.is_infinite() || least < DETERMINED * untouched {
            return Ok(());
        }
        Err(TouchRefusal::Hopeless { touches, tip_mm: 1e3 * least, untouched_mm: 1e3 * untouched })
    }

    /// Standard deviation of tips (m, along the normal of the surface) that the errors of the parameters cause: the root
    /// mean square over the contacts of contour following.
    #[must_use]
    pub fn tip_deviation(&self, fit: &TouchFit) -> f64 {
        self.workspace.deviation(&fit.covariance)
    }
}

impl PlannedTouch {
    /// True for a touch that is on the same side as another one, as near to the tip, and as deep.
    fn is_beyond(&self, other: &Self) -> bool {
        let deeper = self.side * (self.pin_base.y - other.pin_base.y);
        self.side * other.side > 0.0 && self.pin_base.x > other.pin_base.x - NEAR && deeper > -NEAR
    }
}

impl Candidate {
    /// The covariance of the parameters after the touch, whose reading has a standard `deviation` (rad) relative to the air.
    fn covariance_after(&self, before: &ParameterCovariance, deviation: f64) -> ParameterCovariance {
        let gain = before * self.slope;
        before - gain * gain.transpose() / (self.variance + math::square(deviation) + self.slope.dot(&gain))
    }
}

/// The touches with the pin at one place along the shaft (m), from the lightest to the deepest one.
fn touches_at(whisker: &Whisker, along: f64, side: f64, radius: f64, noise: &TouchNoise) -> Vec<Candidate> {
    let (base, shaft, nominal) = (whisker.base_pose(), &whisker.shaft, Parameters::zeros());
    let beyond = math::max(along - shaft.length, 0.0);
    let first = -(math::square(radius + shaft.radius_at(1.0)) - beyond * beyond).sqrt();
    let mut candidates = Vec::new();
    for step in 1..=DEPTHS {
        let pin_base = Point2::new(along, side * (first + DEPTH_STEP * f64::from(step) * shaft.length));
        let obstacle = Obstacle::Pin { centre: base.point_to_world(pin_base), radius };
        let (mechanics, seen) = parameters::mechanics(whisker, &nominal, &obstacle);
        let predicted = mechanics.press(&seen, side).and_then(|touch| {
            let level = touch.base_angle.abs() / mechanics.angle_unit();
            Some((level, Predicted::of(whisker, &nominal, &obstacle, &touch, side, noise)?))
        });
        let Some((level, Predicted { reading: base_angle, mut slope, pose_variance: variance })) = predicted else {
            // The whisker slips off a pin that is deeper. Within the tolerances it may already slip off at the last touches.
            candidates.truncate(candidates.len().saturating_sub(SLIPPERY));
            break;
        };
        if level > LEVELS.1 {
            break;
        }
        slope[Parameter::Offset.index()] = 0.0;
        if level >= LEVELS.0 {
            candidates.push(Candidate { planned: PlannedTouch { pin_base, side, base_angle }, slope, variance });
        }
    }
    candidates
}
