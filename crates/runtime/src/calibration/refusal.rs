//! Why touches do not calibrate a whisker.

use crate::math;
use crate::rig::Whisker;

use super::parameters::{self, Parameter, Parameters};
use super::touch_fit::{Prior, TouchFit, TouchNoise, TouchReading};

/// Why touches do not calibrate a whisker.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TouchRefusal {
    /// There are fewer different touches than parameters of interest.
    #[error("{count} different touches are too few; at least {MIN_TOUCHES} are needed")]
    TooFew {
        /// Number of touches, of which those at one pose of the body and one place of the object count once.
        count: usize,
    },
    /// The readings belong to another whisker, or the whisker is another one.
    #[error(
        "the whisker is swapped: {reason}; check which sensor belongs to `{name}`, and which shaft is mounted there"
    )]
    Swapped {
        /// Name of the whisker.
        name: String,
        /// What shows it.
        reason: String,
    },
    /// The hinge has play.
    #[error("the whisker is loose: its base angle has a play of {play_urad:.1} urad; fix it at its base, then repeat")]
    Loose {
        /// Play of the base angle to one side (µrad).
        play_urad: f64,
    },
    /// The shaft is bent at rest.
    #[error("the whisker is bent: at rest its tip is {aside_mm:.1} mm aside; straighten or replace it")]
    Bent {
        /// Distance of the tip from the straight shaft (mm, positive to the left).
        aside_mm: f64,
    },
    /// The object is elsewhere, or has another size.
    #[error(
        "the object is not where it was said to be: the whisker would be off by {off_mm:.1} mm; measure its position and \
         its size"
    )]
    Displaced {
        /// Distance of the fitted base from that of the rig (mm).
        off_mm: f64,
    },
    /// The touches say hardly more than the tolerances of manufacture.
    #[error(
        "the touches hardly determine the whisker: tips would be uncertain by {tip_mm:.2} mm, and by {untouched_mm:.2} mm \
         without any touch; touch at more heights and directions, or measure the readings and the poses more exactly"
    )]
    Undetermined {
        /// Standard deviation of tips (mm) that the errors of the fit cause.
        tip_mm: f64,
        /// The same without any touch.
        untouched_mm: f64,
    },
    /// No touches could say more than the tolerances of manufacture.
    #[error(
        "no touches determine the whisker: after {touches} of them, tips would still be uncertain by {tip_mm:.2} mm, and by \
         {untouched_mm:.2} mm without any; its base angles are too small beside the noise, so use a shaft with a stiffer tip, or a softer hinge"
    )]
    Hopeless {
        /// Number of touches.
        touches: usize,
        /// Standard deviation of tips (mm) after so many touches.
        tip_mm: f64,
        /// The same without any touch.
        untouched_mm: f64,
    },
    /// The whisker has no contact by which a fit could be judged.
    #[error(
        "the tip of the whisker of the rig can touch no surface as in contour following; check its length and direction"
    )]
    NoContact,
    /// Nothing explains the residuals.
    #[error(
        "the residuals do not match the noise: chi-square {chi_square:.0}, at most {limit:.0} is expected; likely causes \
         are a kink in the shaft, a moved object, or more noise of the pose than was given"
    )]
    Unexplained {
        /// Chi-square of the fit.
        chi_square: f64,
        /// Limit of chi-square.
        limit: f64,
    },
}

/// Fewest touches of a calibration.
const MIN_TOUCHES: usize = 6;
/// Standard normal quantile of the probability 99.9 %.
const QUANTILE: f64 = 3.09;
/// Scatter of the readings in the air (rad) that a firm hinge may have beyond the noise.
const FIRM: f64 = 1e-6;
/// Share of the expected base angle below which a whisker has not responded.
const NO_RESPONSE: f64 = 0.1;
/// Differences from the rig, in standard deviations of the tolerances, that a whisker may have.
const TOLERATED: f64 = 3.0;
/// Share of the uncertainty without any touch that touches must leave at most.
pub(super) const DETERMINED: f64 = 0.5;
/// Standard deviations of the parameters for other explanations: play (rad), curvature (1/m), base (m).
const PLAY: f64 = 2e-5;
const CURVATURE: f64 = 5.0;
const ELSEWHERE: f64 = 2e-2;

impl TouchFit {
    /// Fits the parameters of a whisker to touches, and checks that they are those of a firm and straight whisker within
    /// the tolerances. `others` are the other whiskers of the rig.
    ///
    /// # Errors
    /// [`TouchRefusal`] with the likely cause.
    pub fn accepted<'w>(
        whisker: &Whisker,
        readings: &[TouchReading],
        noise: &TouchNoise,
        others: impl Iterator<Item = &'w Whisker>,
    ) -> Result<Self, TouchRefusal> {
        let fit = Self::new(whisker, readings, noise).unwrap_or_else(|| Self::untouched(whisker).unreached(readings));
        fit.check(readings, noise, others)?;
        Ok(fit)
    }

    /// Checks the touches of this fit.
    pub(super) fn check<'w>(
        &self,
        readings: &[TouchReading],
        noise: &TouchNoise,
        others: impl Iterator<Item = &'w Whisker>,
    ) -> Result<(), TouchRefusal> {
        if readings.len() < MIN_TOUCHES {
            return Err(TouchRefusal::TooFew { count: readings.len() });
        }
        let (whisker, limit) = (&self.whisker, chi_square_limit(readings.len()));
        let swapped = |reason: String| TouchRefusal::Swapped { name: whisker.name.clone(), reason };
        if let Some(reason) = unresponsive(whisker, readings) {
            return Err(swapped(reason.to_owned()));
        }
        let play = scatter_in_air(readings);
        let noise_in_air = readings.iter().map(|reading| reading.deviation).fold(0.0, math::max);
        if play > FIRM + 4.0 * noise_in_air {
            return Err(TouchRefusal::Loose { play_urad: 1e6 * play });
        }
        let count = different(readings);
        if count < MIN_TOUCHES {
            return Err(TouchRefusal::TooFew { count });
        }
        let excess = self.excess();
        if self.chi_square <= limit && excess <= TOLERATED {
            return self.check_information();
        }
        let refit = |whisker: &Whisker, deviations: &[(Parameter, f64)]| {
            let mut prior = Prior::of(readings);
            for &(parameter, deviation) in deviations {
                prior.deviation[parameter.index()] = deviation;
            }
            Self::with_prior(whisker, readings, noise, &prior)
        };
        let mut causes: Vec<(f64, TouchRefusal)> = Vec::new();
        if let Some(fit) = refit(whisker, &[(Parameter::Play, PLAY)]) {
            let play = fit.parameters[Parameter::Play.index()];
            causes.push((fit.chi_square, TouchRefusal::Loose { play_urad: 1e6 * play.abs() }));
        }
        if let Some(fit) = refit(whisker, &[(Parameter::Curvature, CURVATURE)]) {
            let curvature = fit.parameters[Parameter::Curvature.index()];
            let aside_mm = 0.5e3 * curvature * math::square(whisker.shaft.length);
            causes.push((fit.chi_square, TouchRefusal::Bent { aside_mm }));
        }
        if let Some(fit) = refit(whisker, &[(Parameter::BaseX, ELSEWHERE), (Parameter::BaseY, ELSEWHERE)]) {
            let [x, y] = [Parameter::BaseX, Parameter::BaseY].map(|parameter| fit.parameters[parameter.index()]);
            causes.push((fit.chi_square, TouchRefusal::Displaced { off_mm: 1e3 * math::hypot(x, y) }));
        }
        for other in others.filter(|other| (&other.shaft, &other.hinge) != (&whisker.shaft, &whisker.hinge)) {
            let mounted = Whisker { shaft: other.shaft.clone(), hinge: other.hinge.clone(), ..whisker.clone() };
            if let Some(fit) = refit(&mounted, &[]) {
                let reason = format!("the shaft of `{}` explains the touches", other.name);
                causes.push((fit.chi_square, swapped(reason)));
            }
        }
        let best = causes.into_iter().min_by(|(a, _), (b, _)| a.total_cmp(b));
        match best {
            Some((chi_square, cause)) if chi_square <= limit => Err(cause),
            _ => Err(TouchRefusal::Unexplained { chi_square: self.chi_square, limit }),
        }
    }

    /// Checks that the touches say more about tips than the tolerances of manufacture.
    fn check_information(&self) -> Result<(), TouchRefusal> {
        let [tip, untouched] = [self, &Self::untouched(&self.whisker)].map(Self::tip_deviation);
        if untouched.is_infinite() {
            Err(TouchRefusal::NoContact)
        } else if tip < DETERMINED * untouched {
            Ok(())
        } else {
            Err(TouchRefusal::Undetermined { tip_mm: 1e3 * tip, untouched_mm: 1e3 * untouched })
        }
    }

    /// The largest difference of a parameter from the rig, in standard deviations of the tolerances.
    fn excess(&self) -> f64 {
        let tolerances = parameters::tolerances();
        let is_of_whisker = |parameter: &&Parameter| {
            !matches!(parameter, Parameter::Offset | Parameter::FaceHeight | Parameter::FaceTurn)
        };
        let of_whisker = Parameter::ALL.iter().filter(is_of_whisker);
        of_whisker
            .map(|parameter| {
                let index = parameter.index();
                (self.parameters[index] / tolerances[index]).abs()
            })
            .fold(0.0, math::max)
    }
}

/// Number of touches that differ by more than their readings, up to [`MIN_TOUCHES`]. A repeated touch only reduces noise.
fn different(readings: &[TouchReading]) -> usize {
    let mut found: [Option<&TouchReading>; MIN_TOUCHES] = [None; MIN_TOUCHES];
    for reading in readings {
        let is_same = |other: &&TouchReading| {
            (other.body, other.obstacle, other.side) == (reading.body, reading.obstacle, reading.side)
        };
        if found.iter().flatten().any(is_same) {
            continue;
        }
        let Some(free) = found.iter_mut().find(|place| place.is_none()) else { break };
        *free = Some(reading);
    }
    found.iter().flatten().count()
}

/// A sign that the readings are not those of the touched whisker.
fn unresponsive(whisker: &Whisker, readings: &[TouchReading]) -> Option<&'static str> {
    let responses = readings.iter().filter_map(|reading| {
        let obstacle = reading.obstacle.seen_from(reading.body);
        let (mechanics, seen) = parameters::mechanics(whisker, &Parameters::zeros(), &obstacle);
        let expected = mechanics.press(&seen, reading.side)?.base_angle;
        Some((reading.base_angle - reading.in_air) / expected)
    });
    let responses: Vec<f64> = responses.collect();
    let most = |count: usize| 2 * count > responses.len();
    if most(responses.iter().filter(|response| response.abs() < NO_RESPONSE).count()) {
        return Some("its readings do not respond to the touches");
    }
    most(responses.iter().filter(|response| **response < -NO_RESPONSE).count())
        .then_some("its readings have the opposite sign")
}

/// Standard deviation (rad) of the readings in the air, without a constant drift from touch to touch.
fn scatter_in_air(readings: &[TouchReading]) -> f64 {
    let steps: Vec<f64> = readings.windows(2).map(|pair| pair[1].in_air - pair[0].in_air).collect();
    let mean = steps.iter().sum::<f64>() / steps.len() as f64;
    let square = steps.iter().map(|step| math::square(step - mean)).sum::<f64>() / (steps.len() - 1) as f64;
    (0.5 * square).sqrt()
}

/// The value that chi-square exceeds with a probability of 0.1 %, by the approximation of Wilson and Hilferty
/// (Proceedings of the National Academy of Sciences 17 (1931), 684).
fn chi_square_limit(count: usize) -> f64 {
    let count = count as f64;
    let spread = 2.0 / (9.0 * count);
    count * math::powi(1.0 - spread + QUANTILE * spread.sqrt(), 3)
}
