//! Perception: from samples to the values that policies read.

mod senses;

use std::sync::Arc;

use nalgebra::Vector3;

use crate::geometry::{Frame, Point2, Pose};
use crate::machine::{ContactEstimatorKind, Keypoints, Mark, PositionContour};
use crate::math;
use crate::rig::{Platform, Rig, Vibration, Whisker};
use crate::signal::{Command, Sample};

use super::contact::Contact;
use super::contact_estimator::ContactEstimator;
use super::disturbance::Disturbance;
use super::inertia::{MeasuredAcceleration, sway};
use super::loop_watch::LoopWatch;
use super::low_pass::{CutoffError, LowPass};
use super::moment_and_shear::MomentAndShear;
use super::motions::Motions;
use super::offsets::{FreeReading, Offsets};
use super::one_channel::OneChannel;
use super::recorded_contour::RecordedContour;
use super::recursive::{self, Recursive};
use super::sliding::Sliding;
use super::tip_curve::{TipCurve, TipCurveError};
use super::tip_table::TipTable;
use super::truth::Truth;
use super::whisker::PerceivedWhisker;

use ContactEstimatorKind as Kind;

/// The longest decay of a vibration (s). A whisker without damping never comes to rest, and policies read finite numbers.
const LONGEST_DECAY: f64 = 1e3;

/// Perception of a rig with the whiskers that a policy binds.
#[derive(Debug, Clone)]
pub struct Perception {
    /// Time of the newest sample (s).
    time: f64,
    /// Pose of the body in this tick, and that at which the next command takes effect, or unknown.
    body: Pose,
    at_effect: Pose,
    platform: Platform,
    /// Flexibility of the first whisker that the policy binds.
    flexibility: f64,
    /// Time (s) in which it comes nearer to rest by a factor e.
    decay: f64,
    /// Ratio of its base angle by inertia and that of the reference whisker.
    sway: f64,
    /// The whiskers in the order of the policy.
    whiskers: Vec<PerceivedWhisker>,
    /// For each whisker, its index in the rig and in samples. `None` if the rig lacks it.
    in_sample: Vec<Option<usize>>,
    /// The contours through positions, in the order of the policy.
    contours: Vec<RecordedContour>,
    /// For each whisker, the detection of a closed loop from the tips that it recorded.
    loops: Vec<LoopWatch>,
    disturbance: Disturbance,
    /// Offsets of the readings of all whiskers of the rig, if they are estimated.
    offsets: Option<Offsets>,
    acceleration: MeasuredAcceleration,
    /// Delays and errors of poses and commands, if they are estimated.
    motions: Option<Box<Motions>>,
    /// Pose by the newest sample, or unknown.
    measured: Pose,
    /// Time (s) since the last tick with a pose. It is infinite before the first one.
    pose_silent_for: f64,
    /// Time (s) over which values are kept in ticks without a valid sample.
    kept_for: f64,
    /// Period of a tick (s) according to the rig.
    tick: f64,
    /// Time constants of the servos (s) according to the rig: x, y, yaw.
    servos: Vector3<f64>,
}

/// An error of constructing the perception of a rig.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PerceptionError {
    /// A whisker has no tip curve.
    #[error(transparent)]
    ContactEstimator(#[from] TipCurveError),
    /// A contact estimator needs forces that the rig does not measure.
    #[error(
        "the policy uses the contact estimator moment_and_shear for whisker `{whisker}`, but the rig measures no forces; \
         set `sensing: {{forces: true}}`, or use sliding"
    )]
    NoForces {
        /// The whisker.
        whisker: String,
    },
    /// The mechanics of a whisker give too few positions for the polynomial of an estimator.
    #[error(
        "whisker {whisker}: its mechanics give too few contact positions for the contact estimator {}; calibrate it, or use \
         sliding", estimator.name()
    )]
    NoSurface {
        /// The whisker.
        whisker: String,
        /// The contact estimator.
        estimator: ContactEstimatorKind,
    },
    /// The rig samples too slowly for the filter.
    #[error(transparent)]
    Cutoff(#[from] CutoffError),
}

impl Perception {
    /// Computes and caches the slowest part of [`new`](Self::new), so that a caller can do it in parallel with other
    /// work.
    pub fn prepare(rig: &Rig, contact_estimators: &[ContactEstimatorKind]) {
        if contact_estimators.iter().any(|kind| matches!(kind, Kind::Sliding | Kind::Recursive)) {
            for whisker in &rig.whiskers {
                let perceived = whisker.perceived();
                drop(TipTable::shared(&perceived));
                drop(TipTable::shared(&perceived.mirrored()));
            }
        }
    }

    /// Creates the perception of `rig` for the whiskers with these indices. Missing entries of `contact_estimators` are
    /// the default kind.
    ///
    /// A whisker that the rig lacks (`None`) is treated as one without any contact, mounted at the body's centre of
    /// mass along the heading.
    ///
    /// # Errors
    /// [`PerceptionError`] if an estimator or a filter does not exist for this rig.
    ///
    /// # Panics
    /// If the rig has no whisker with such an index.
    pub fn new(
        rig: &Rig,
        whiskers: &[Option<usize>],
        contact_estimators: &[ContactEstimatorKind],
    ) -> Result<Self, PerceptionError> {
        let sensing = &rig.sensing;
        let perceived = whiskers
            .iter()
            .zip(contact_estimators.iter().copied().chain(std::iter::repeat(ContactEstimatorKind::default())));
        let perceived = perceived.map(|(&index, kind)| {
            // A whisker that is never in contact gets the cheapest estimator.
            let (whisker, kind) = match index {
                Some(index) => (rig.whiskers[index].perceived(), kind),
                None => (Whisker::unfitted(), Kind::OneChannel),
            };
            let filter = LowPass::new(sensing.filter_cutoff, sensing.sample_rate)?;
            let calibration = whisker.calibration.as_ref();
            let (length, bend_sign) = (whisker.shaft.length, whisker.side());
            // A whisker without contacts has no friction either.
            let friction = index.map_or(0.0, |_| whisker.friction(sensing));
            let mechanics = || TipCurve::shared(&whisker, friction);
            let too_few = || PerceptionError::NoSurface { whisker: whisker.name.clone(), estimator: kind };
            let curve = match kind {
                Kind::Polynomial => match calibration.and_then(|calibration| calibration.polynomial.as_ref()) {
                    Some(measured) => Arc::new(TipCurve::by_polynomial(measured, bend_sign)),
                    None => Arc::new(mechanics()?.to_polynomial(length, bend_sign).ok_or_else(too_few)?),
                },
                _ => match calibration.and_then(|calibration| calibration.one_channel.as_ref()) {
                    Some(measured) => Arc::new(TipCurve::calibrated(measured)),
                    None => mechanics()?,
                },
            };
            let estimator: Box<dyn ContactEstimator> = match kind {
                Kind::OneChannel | Kind::Polynomial => Box::new(OneChannel::new(Arc::clone(&curve), sensing, length)),
                Kind::Sliding => Box::new(Sliding::new(&whisker, sensing)),
                Kind::MomentAndShear if sensing.forces => Box::new(MomentAndShear::new(&whisker, sensing)),
                Kind::MomentAndShear => return Err(PerceptionError::NoForces { whisker: whisker.name }),
                Kind::Recursive => {
                    let surface = match calibration.and_then(|calibration| calibration.recursive.clone()) {
                        Some(measured) => measured,
                        None => recursive::surface(&whisker, &TipTable::shared(&whisker)).ok_or_else(too_few)?,
                    };
                    Box::new(Recursive::new(&whisker, Arc::new(surface), Arc::clone(&curve), sensing))
                }
                Kind::Truth => Box::new(Truth::new(Arc::clone(&curve), length)),
            };
            Ok(PerceivedWhisker::new(&whisker, filter, curve, estimator, sensing))
        });
        let perceived = perceived.collect::<Result<_, PerceptionError>>()?;
        let first = whiskers.iter().flatten().next().map(|&first| &rig.whiskers[first]);
        Ok(Self {
            time: 0.0,
            body: Pose::default(),
            at_effect: Pose::default(),
            platform: rig.platform.clone(),
            flexibility: first.map_or(1.0, Whisker::flexibility),
            decay: first.map_or(0.0, |first| math::min(Vibration::of(&first.perceived()).relaxation(), LONGEST_DECAY)),
            sway: first.map_or(1.0, |first| sway(&first.perceived())),
            whiskers: perceived,
            in_sample: whiskers.to_vec(),
            contours: Vec::new(),
            loops: vec![LoopWatch::default(); whiskers.len()],
            disturbance: Disturbance::new(rig),
            motions: (sensing.estimation.delay || sensing.estimation.pose_noise).then(|| Box::new(Motions::new(rig))),
            acceleration: MeasuredAcceleration::new(),
            measured: Pose::default(),
            pose_silent_for: f64::INFINITY,
            kept_for: 0.0,
            tick: sensing.control_rate.recip(),
            servos: rig.platform.servos(),
            offsets: sensing.estimation.offset.then(|| Offsets::new(rig.whiskers.len())),
        })
    }

    /// Sets the keypoints of the whiskers' contours, and adds contours through positions. Without a call, the keypoints
    /// are the default.
    #[must_use]
    pub fn with_contours(mut self, keypoints: Keypoints, contours: &[PositionContour]) -> Self {
        for whisker in &mut self.whiskers {
            whisker.contour = RecordedContour::new(keypoints);
        }
        self.contours = contours.iter().map(|contour| RecordedContour::new(contour.keypoints)).collect();
        self
    }

    /// Keeps base angles and the pose over ticks without a valid one, for at most this time (s). Otherwise they are NaN in
    /// every such tick. A tick with a kept value has no contact, so it records no tip.
    pub fn keep_for(&mut self, time: f64) {
        self.kept_for = time;
        for whisker in &mut self.whiskers {
            whisker.keep_for(time);
        }
    }

    /// Replaces the contact estimator of a whisker, by its index in the policy. It allows an estimator that no
    /// [`ContactEstimatorKind`] names. Replace estimators before the first [`update`](Self::update).
    ///
    /// # Panics
    /// If the policy has no such whisker.
    pub fn set_contact_estimator(&mut self, whisker: usize, estimator: Box<dyn ContactEstimator>) {
        self.whiskers[whisker].set_estimator(estimator);
    }

    /// Begins a tick with the samples since the last one, oldest first.
    ///
    /// Non-finite values and base angles beyond half a rotation are ignored. The newest valid value counts. A value
    /// without any valid sample in the tick is NaN: base angle and tip of a whisker, or the pose and everything that
    /// depends on it. With [`keep_for`](Self::keep_for) it has its last value for some time. The time keeps its last value.
    pub fn update(&mut self, samples: &[Sample]) {
        for index in 0..self.loops.len() {
            // A whisker that the rig lacks records no tip.
            if self.in_sample[index].is_none() {
                continue;
            }
            let tip_world = self.recorded_tip(index);
            self.loops[index].update(self.time, tip_world, self.body.position);
        }
        for (whisker, _) in fitted(&mut self.whiskers, &self.in_sample) {
            whisker.begin();
        }
        let before = self.time;
        if let Some(time) = samples.iter().map(|sample| sample.time).rfind(|time| time.is_finite()) {
            self.time = time;
        }
        let period = self.time - before;
        if let Some(motions) = &mut self.motions
            && period > 0.0
        {
            motions.begin(period);
        }
        let (last_body, last_at_effect) = (self.body, self.at_effect);
        (self.body, self.measured) = (Pose::UNKNOWN, Pose::UNKNOWN);
        for sample in samples {
            let ago = math::max(self.time - sample.time, 0.0);
            let body = Frame::new(self.motions.as_ref().map_or(sample.body, |motions| motions.pose(sample, ago)));
            for (whisker, index) in fitted(&mut self.whiskers, &self.in_sample) {
                let offset = self.offsets.as_ref().map_or(0.0, |offsets| offsets.value(index));
                let misfit = whisker.take(&sample.whiskers[index], offset, &body);
                if let Some((motions, misfit)) = self.motions.as_mut().zip(misfit) {
                    motions.add(&misfit);
                }
            }
            if sample.body.is_finite() {
                (self.body, self.measured) = (body.pose, sample.body);
            }
        }
        let pose_deviation = self.motions.as_deref().map(Motions::pose_deviation).unwrap_or_default();
        self.at_effect = self.motions.as_ref().map_or(self.body, |motions| motions.at_effect(self.measured));
        let is_measured = self.measured.is_finite();
        // Without any sample the time stands still, but values must not be kept for ever.
        let waited = math::max(period, self.tick);
        self.pose_silent_for = if is_measured { 0.0 } else { self.pose_silent_for + waited };
        if !is_measured && self.kept_for > 0.0 && self.pose_silent_for <= self.kept_for {
            (self.body, self.at_effect) = (last_body, last_at_effect);
        }
        let body = Frame::new(self.body);
        let is_same = self.at_effect.heading.to_bits() == self.body.heading.to_bits();
        let at_effect = if is_same { Frame { pose: self.at_effect, ..body } } else { Frame::new(self.at_effect) };
        // Whiskers that the rig lacks are all alike.
        let mut first_lacking: Option<usize> = None;
        for index in 0..self.whiskers.len() {
            let is_lacking = self.in_sample[index].is_none();
            let (before, rest) = self.whiskers.split_at_mut(index);
            let Some(whisker) = rest.first_mut() else { break };
            match first_lacking {
                Some(first) if is_lacking => whisker.update_like(&before[first]),
                _ => {
                    whisker.end(waited);
                    whisker.update(&body, &at_effect, is_measured, pose_deviation);
                }
            }
            if is_lacking && first_lacking.is_none() {
                first_lacking = Some(index);
            }
        }
        for contour in &mut self.contours {
            contour.begin();
        }
        self.update_offsets(period);
        if let Some(motions) = &mut self.motions {
            motions.end(self.measured);
        }
        let expected = self.motions.as_ref().and_then(|motions| motions.expected(period));
        self.disturbance.update(samples, self.time, self.measured, expected);
    }

    /// Estimates the offsets after `period` (s).
    fn update_offsets(&mut self, period: f64) {
        let Some(offsets) = &mut self.offsets else { return };
        if period > 0.0 {
            offsets.predict(period);
        }
        let Some(acceleration) = self.acceleration.take(self.measured, period) else { return };
        for (whisker, index) in fitted(&mut self.whiskers, &self.in_sample) {
            let free = whisker.free_reading(&acceleration);
            offsets.add(index, free);
            whisker.set_offset_deviation(offsets.deviation(index));
            if let Some((motions, FreeReading { reading, deviation, .. })) = self.motions.as_mut().zip(free) {
                let offset = offsets.value(index);
                motions.add_free(reading - offset, deviation, |acceleration| whisker.bent_by(acceleration));
            }
        }
    }

    /// Sets the command that holds until the next tick. The detection of a blocked body uses it. The default is to
    /// stand still.
    pub fn command(&mut self, command: Command) {
        self.disturbance.command(command);
        if let Some(motions) = &mut self.motions {
            motions.command(command);
        }
    }

    /// The fitted whiskers: the index of each in the policy and in the rig.
    pub fn fitted(&self) -> impl Iterator<Item = (usize, usize)> {
        self.in_sample.iter().enumerate().filter_map(|(whisker, index)| index.map(|index| (whisker, index)))
    }

    /// Time of the newest sample (s).
    #[must_use]
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Pose of the platform's centre of mass, or [`Pose::UNKNOWN`] in a tick without a pose.
    #[must_use]
    pub fn pose(&self) -> Pose {
        self.body
    }

    /// Pose at which the next command takes effect, or [`Pose::UNKNOWN`] in a tick without a pose. Without a measured
    /// delay of commands it is [`pose`](Self::pose).
    #[must_use]
    pub fn pose_at_effect(&self) -> Pose {
        self.at_effect
    }

    /// Measured time constants (s) of the servos, or those of the rig: x, y, yaw.
    #[must_use]
    pub fn servos(&self) -> Vector3<f64> {
        self.motions.as_deref().and_then(Motions::servos).unwrap_or(self.servos)
    }

    /// Filtered base angle (rad) of a whisker, or NaN in a tick without a valid reading.
    #[must_use]
    pub fn base_angle(&self, whisker: usize) -> f64 {
        self.whiskers[whisker].base_angle()
    }

    /// Largest magnitude (rad) of the base angles of a whisker in the samples of this tick, without the filter. `None` if one
    /// of them is lost or has no pose, or if there is none.
    #[must_use]
    pub fn largest_reading(&self, whisker: usize) -> Option<f64> {
        self.whiskers[whisker].largest_reading()
    }

    /// Mean base angle (rad) of a whisker over the samples of this tick, without the filter. `None` if there is none.
    #[must_use]
    pub fn mean_reading(&self, whisker: usize) -> Option<f64> {
        self.whiskers[whisker].mean_reading()
    }

    /// Standard deviation (rad) of the noise of one reading of a whisker: the stated one, or the measured one if it is
    /// significantly larger.
    #[must_use]
    pub fn reading_deviation(&self, whisker: usize) -> f64 {
        self.whiskers[whisker].reading_deviation()
    }

    /// Standard deviations of the error of a measured pose: of each coordinate (m) and of the heading (rad). They are 0
    /// unless they are significant or if they are not estimated.
    #[must_use]
    pub fn pose_deviation(&self) -> (f64, f64) {
        let deviation = self.motions.as_deref().map(Motions::pose_deviation).unwrap_or_default();
        (deviation.position, deviation.heading)
    }

    /// True if this tick has a measured pose, and not one that is kept from an earlier tick.
    #[must_use]
    pub fn has_measured_pose(&self) -> bool {
        self.measured.is_finite()
    }

    /// True if something other than the whiskers prevents the body from following its commands.
    #[must_use]
    pub fn is_blocked(&self) -> bool {
        self.disturbance.is_blocked()
    }

    /// True if the filtered base angle of a whisker exceeds the contact threshold.
    #[must_use]
    pub fn is_touching(&self, whisker: usize) -> bool {
        self.whiskers[whisker].is_touching()
    }

    /// The estimated contact of a whisker, if its contact estimator has one in this tick.
    #[must_use]
    pub fn contact(&self, whisker: usize) -> Option<&Contact> {
        self.whiskers[whisker].contact()
    }

    /// The inclination of a whisker (rad): the angle between the shaft at its base and the surface that it follows. It is π/2
    /// for a shaft that is perpendicular to the surface, and less for one that is swept back against the bend.
    /// [`out_of_plane_margin`](crate::mechanics::out_of_plane_margin) tells whether the whisker stays in the plane.
    /// `None` unless the whisker touches and records a contour.
    #[must_use]
    pub fn inclination(&self, whisker: usize) -> Option<f64> {
        self.whiskers[whisker].inclination()
    }

    /// The tip of a whisker (m, world frame), if this tick recorded it during a contact.
    #[must_use]
    pub fn recorded_tip(&self, whisker: usize) -> Option<Point2> {
        let whisker = &self.whiskers[whisker];
        (whisker.contour.is_recorded() && whisker.has_contact() && whisker.is_recordable()).then(|| whisker.tip_world())
    }

    /// Standard deviation (m) of the recorded tip of a whisker.
    #[must_use]
    pub fn recorded_deviation(&self, whisker: usize) -> f64 {
        self.whiskers[whisker].recorded_deviation()
    }

    /// The contour with this index: that of a whisker, or after these one through positions.
    fn contour(&self, index: usize) -> &RecordedContour {
        match index.checked_sub(self.whiskers.len()) {
            Some(index) => &self.contours[index],
            None => &self.whiskers[index].contour,
        }
    }

    /// The marks of a whisker in this tick, in order, with the position of its tip (m, world frame).
    pub fn marks(&self, whisker: usize) -> impl Iterator<Item = (Mark, Point2)> {
        let whisker = &self.whiskers[whisker];
        whisker.marks.iter().flatten().map(|&mark| (mark, whisker.tip_world()))
    }
}

/// The fitted whiskers, each with its index in the rig.
fn fitted<'p>(
    whiskers: &'p mut [PerceivedWhisker],
    in_sample: &'p [Option<usize>],
) -> impl Iterator<Item = (&'p mut PerceivedWhisker, usize)> {
    whiskers.iter_mut().zip(in_sample).filter_map(|(whisker, index)| index.map(|index| (whisker, index)))
}
