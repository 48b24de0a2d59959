//! The perception of one whisker.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use crate::geometry::{Frame, Point2, Pose, Vector2, rotate, wrap};
use crate::machine::{ContourVector, Keypoints, Mark};
use crate::math;
use crate::rig::{Sensing, Whisker};
use crate::signal::Reading;

use super::base_angle::{MODEL_DEVIATION, NOISE_THRESHOLD};
use super::contact::Contact;
use super::contact_estimator::ContactEstimator;
use super::creep::Creep;
use super::filtered_base_angle::{FilteredBaseAngle, GREATEST_ANGLE};
use super::inertia::{Acceleration, Inertia};
use super::low_pass::LowPass;
use super::measured_noise::MeasuredNoise;
use super::offsets::FreeReading;
use super::pose_delay::Misfit;
use super::pose_noise::PoseDeviation;
use super::recorded_contour::RecordedContour;
use super::tip_curve::TipCurve;

/// The perception of one whisker: its pose, base angle, contact and local contour.
#[derive(Debug, Clone)]
pub(super) struct PerceivedWhisker {
    /// Position of the base (m, body frame).
    base_body: Vector2,
    /// Direction of the undeflected shaft (rad, body frame).
    direction_body: f64,
    /// −1 for a whisker on the right, +1 for one on the left.
    pub(super) side: f64,
    /// Length of the shaft (m).
    pub(super) length: f64,
    /// Reading in the air (rad), as the calibration has it.
    offset: f64,
    base_angle: FilteredBaseAngle,
    /// The bend of a shaft whose material creeps. `None` for one that follows at once.
    creep: Option<Creep>,
    estimator: Box<dyn ContactEstimator>,
    /// The estimated contact, if there is one in this tick.
    contact: Option<Contact>,
    /// The tip position that is used without an estimate.
    curve: Arc<TipCurve>,
    /// Contact threshold (rad).
    contact_threshold: f64,
    /// Standard deviation of the filtered base angle (rad).
    base_angle_deviation: f64,
    /// Standard deviation (m) of a surface about its outline.
    surface_roughness: f64,
    /// Noise of the readings in free air, and its standard deviation (rad) in use.
    noise: MeasuredNoise,
    used_noise: f64,
    /// Number of successive lost readings, and the largest one after which the contact is kept.
    lost: usize,
    bridged: usize,
    /// Sums of the readings of this tick (rad) with and without their offset, and their number.
    sum: f64,
    corrected_sum: f64,
    count: usize,
    /// True if a reading of this tick is lost.
    has_lost: bool,
    /// Largest magnitude of a base angle (rad) in this tick.
    largest: f64,
    /// Number of readings in ticks since the whisker touched, and the number after which it is at rest.
    free_for: usize,
    settled_after: usize,
    inertia: Inertia,
    sensing: Sensing,
    /// Position of the base (m, world frame).
    base_world: Point2,
    /// Direction of the undeflected shaft (rad, world frame).
    yaw: f64,
    /// Position of the base and direction of the undeflected shaft when the next command takes effect.
    pub(super) base_at_effect: Pose,
    /// Local contour behind the tip.
    pub(super) contour: RecordedContour,
    /// The marks of this tick, in order.
    pub(super) marks: [Option<Mark>; Mark::ALL.len()],
}

impl PerceivedWhisker {
    /// Creates the perception of `whisker` with its filter, tip curve and contact estimator.
    pub(super) fn new(
        whisker: &Whisker,
        filter: LowPass,
        curve: Arc<TipCurve>,
        estimator: Box<dyn ContactEstimator>,
        sensing: &Sensing,
    ) -> Self {
        let base_angle_deviation = filtered_deviation(sensing, sensing.angle_noise);
        Self {
            base_body: whisker.base_body.coords,
            direction_body: whisker.direction_body,
            side: whisker.side(),
            length: whisker.shaft.length,
            offset: offset(whisker),
            base_angle: FilteredBaseAngle::new(filter),
            creep: Creep::new(whisker, sensing),
            estimator,
            contact: None,
            curve,
            contact_threshold: contact_threshold(sensing, base_angle_deviation),
            surface_roughness: sensing.surface_roughness,
            base_angle_deviation,
            noise: MeasuredNoise::new(sensing),
            used_noise: sensing.reading_deviation(),
            lost: 0,
            bridged: if sensing.estimation.lost_readings { samples(BRIDGED, sensing) } else { 0 },
            sum: 0.0,
            corrected_sum: 0.0,
            count: 0,
            has_lost: false,
            largest: 0.0,
            free_for: samples(SETTLED, sensing),
            settled_after: samples(SETTLED, sensing),
            inertia: Inertia::new(whisker),
            sensing: sensing.clone(),
            base_world: Point2::origin(),
            yaw: 0.0,
            base_at_effect: Pose::default(),
            contour: RecordedContour::new(Keypoints::default()),
            marks: Default::default(),
        }
    }

    /// Replaces the contact estimator.
    pub(super) fn set_estimator(&mut self, estimator: Box<dyn ContactEstimator>) {
        self.estimator = estimator;
    }

    /// Keeps the base angle over ticks without a valid reading, for at most this time (s).
    pub(super) fn keep_for(&mut self, time: f64) {
        self.base_angle.keep_for(time);
    }

    /// Filtered base angle (rad), or NaN if there is no valid reading.
    pub(super) fn base_angle(&self) -> f64 {
        self.base_angle.value()
    }

    /// Standard deviation (rad) of the filtered base angle, from noise and from effects outside of the model.
    pub(super) fn base_angle_deviation(&self) -> f64 {
        math::hypot(MODEL_DEVIATION, self.base_angle_deviation)
    }

    /// Begins a tick. Its readings follow.
    pub(super) fn begin(&mut self) {
        self.base_angle.begin();
        (self.sum, self.corrected_sum, self.count, self.largest, self.has_lost) = (0.0, 0.0, 0, 0.0, false);
    }

    /// Adds a reading with this `offset` (rad) beyond that of the calibration, sampled with the platform at `body`.
    /// Returns its misfit with an expected contact.
    pub(super) fn take(&mut self, reading: &Reading, offset: f64, body: &Frame) -> Option<Misfit> {
        let measured = reading.base_angle - self.offset;
        let base_angle = measured - offset;
        self.base_angle.take(base_angle);
        let is_valid = base_angle.abs() <= GREATEST_ANGLE;
        if is_valid {
            self.sum += measured;
            self.corrected_sum += base_angle;
            self.count += 1;
            self.largest = math::max(self.largest, base_angle.abs());
        }
        if !is_valid || self.free_for == 0 {
            self.noise.interrupt();
        } else if self.sensing.estimation.noise {
            self.noise.take(reading.base_angle);
        }
        if is_valid && body.pose.is_finite() {
            self.lost = 0;
            let base_angle = self.static_base_angle(base_angle);
            self.estimator.take(&Reading { base_angle, ..*reading }, self.base(body));
            return self.estimator.misfit();
        }
        self.has_lost = true;
        self.lost = self.lost.saturating_add(1);
        if self.lost > self.bridged {
            self.estimator.interrupt();
        }
        None
    }

    /// The base angle (rad) at rest for the bend at a reading (rad). A whisker without a force has no contact, even while it creeps back.
    fn static_base_angle(&mut self, reading: f64) -> f64 {
        let Some(creep) = &mut self.creep else { return reading };
        let base_angle = creep.take(reading);
        if reading.abs() < self.contact_threshold { reading } else { base_angle }
    }

    /// Largest magnitude (rad) of the readings of this tick, without the filter. `None` if one of them is lost or there is
    /// none.
    pub(super) fn largest_reading(&self) -> Option<f64> {
        (self.count > 0 && !self.has_lost).then_some(self.largest)
    }

    /// Mean reading (rad) of this tick, without the filter. `None` if there is none.
    pub(super) fn mean_reading(&self) -> Option<f64> {
        (self.count > 0).then(|| self.corrected_sum / self.count as f64)
    }

    /// Standard deviation (rad) of the noise of a reading.
    pub(super) fn reading_deviation(&self) -> f64 {
        self.used_noise
    }

    /// The mean reading of this tick, with the base angle that is calculated for this `acceleration` of the platform.
    /// `None` unless the whisker is at rest in free air.
    pub(super) fn free_reading(&self, acceleration: &Acceleration) -> Option<FreeReading> {
        let is_at_rest = self.count > 0 && self.free_for >= self.settled_after;
        let count = self.count as f64;
        is_at_rest.then(|| FreeReading {
            reading: self.sum / count,
            bent: self.inertia.base_angle(acceleration),
            deviation: self.used_noise / count.sqrt(),
        })
    }

    /// The base angle (rad) in free air on a platform that accelerates.
    pub(super) fn bent_by(&self, acceleration: &Acceleration) -> f64 {
        self.inertia.base_angle(acceleration)
    }

    /// The position of the base and the direction of the undeflected shaft, with the platform at `body`.
    fn base(&self, body: &Frame) -> Pose {
        let position = body.point_to_world(self.base_body.into());
        Pose { position, heading: body.pose.heading + self.direction_body }
    }

    /// Ends a tick of this `period` (s), after its readings.
    pub(super) fn end(&mut self, period: f64) {
        self.base_angle.end(period);
    }

    /// Updates pose and contact of the whisker, with the platform at `body` and these errors of poses. The platform is at
    /// `at_effect` when the next command takes effect. A tick without a valid reading, or without a measured pose, has no
    /// contact.
    pub(super) fn update(&mut self, body: &Frame, at_effect: &Frame, is_measured: bool, pose_deviation: PoseDeviation) {
        let base = self.base(body);
        self.base_at_effect = self.base(at_effect);
        (self.base_world, self.yaw) = (base.position, base.heading);
        let has_reading = is_measured && self.base_angle.has_reading();
        let bend = self.creep.filter(|_| self.is_touching()).map_or(self.base_angle(), |creep| creep.base_angle());
        self.contact = if has_reading { self.estimator.contact(bend, base) } else { None };
        self.contour.begin();
        if pose_deviation != PoseDeviation::default()
            && let Some(contact) = &mut self.contact
        {
            contact.add_pose_errors(body.pose, pose_deviation);
        }
        self.update_noise();
        let is_free = self.contact.is_none() && !self.is_touching() && self.largest < self.contact_threshold;
        self.free_for = if is_free { self.free_for.saturating_add(self.count) } else { 0 };
        self.marks = Default::default();
    }

    /// Updates a whisker that the rig lacks from `other`, which it lacks too and which is updated.
    pub(super) fn update_like(&mut self, other: &Self) {
        (self.base_world, self.yaw, self.base_at_effect) = (other.base_world, other.yaw, other.base_at_effect);
        self.contact = other.contact;
        self.contour.begin();
        self.marks = Default::default();
    }

    /// Uses the measured noise if it has changed.
    fn update_noise(&mut self) {
        let noise = self.noise.value();
        if (noise - self.used_noise).abs() > NOISE_STEP * noise {
            self.used_noise = noise;
            self.estimator.set_noise(noise);
            self.base_angle_deviation = filtered_deviation(&self.sensing, noise);
            self.contact_threshold = contact_threshold(&self.sensing, self.base_angle_deviation);
        }
    }

    /// Sets the standard deviation (rad) of the offset of the readings.
    pub(super) fn set_offset_deviation(&mut self, deviation: f64) {
        self.estimator.set_offset_deviation(deviation);
    }

    /// Records a mark, at most once per tick.
    pub(super) fn mark(&mut self, mark: Mark) {
        if !self.marks.contains(&Some(mark))
            && let Some(free) = self.marks.iter_mut().find(|free| free.is_none())
        {
            *free = Some(mark);
        }
    }

    /// True if the filtered base angle exceeds the contact threshold.
    pub(super) fn is_touching(&self) -> bool {
        self.base_angle().abs() > self.contact_threshold
    }

    /// The estimated contact, if there is one in this tick.
    pub(super) fn contact(&self) -> Option<&Contact> {
        self.contact.as_ref()
    }

    /// Contact position of the tip (m, frame of the base).
    pub(super) fn tip_base(&self) -> Vector2 {
        match &self.contact {
            Some(contact) => rotate(contact.point_world - self.base_world, -self.yaw),
            None => self.curve.contact_base(self.base_angle()),
        }
    }

    /// Contact position of the tip at another base angle (m, frame of the base). The surface keeps its estimated
    /// direction, or is parallel to the heading if the direction is unknown.
    pub(super) fn tip_at(&self, base_angle: f64) -> Vector2 {
        let touched = self.contact.and_then(|_| self.estimator.contact_at(base_angle, self.base_at_effect.heading));
        touched.unwrap_or_else(|| self.curve.contact_base(base_angle))
    }

    /// True if the contact position may be recorded.
    pub(super) fn is_recordable(&self) -> bool {
        self.contact.is_some_and(|contact| contact.is_recordable)
    }

    /// True if the whisker is in contact and the contact position is estimated.
    pub(super) fn has_contact(&self) -> bool {
        self.is_touching() && self.contact.is_some()
    }

    /// Contact position of the tip (m, world frame).
    pub(super) fn tip_world(&self) -> Point2 {
        match &self.contact {
            Some(contact) => contact.point_world,
            None if self.is_touching() => self.base_world + rotate(self.tip_base(), self.yaw),
            None => self.base_at_effect.position + rotate(self.tip_base(), self.base_at_effect.heading),
        }
    }

    /// Standard deviation of the contact position (m), without the roughness of the surface.
    pub(super) fn tip_deviation(&self) -> f64 {
        match &self.contact {
            Some(contact) => contact.deviation,
            None => self.curve.deviation(self.base_angle(), self.base_angle_deviation),
        }
    }

    /// Standard deviation of a recorded tip from the outline (m). It contains scatter, bias and the roughness of the
    /// surface.
    pub(super) fn recorded_deviation(&self) -> f64 {
        let both = |contact: Contact| match contact.bias {
            0.0 => contact.recorded_deviation,
            bias => math::hypot(contact.recorded_deviation, bias),
        };
        math::hypot(self.contact.map_or_else(|| self.tip_deviation(), both), self.surface_roughness)
    }

    /// Angle (rad) between the shaft at the base and the surface behind the tip, against the direction in which the
    /// contact bends the shaft. It is π/2 for a shaft that is perpendicular to the surface, and less for one that is
    /// swept back. `None` unless the whisker touches and records a contour.
    pub(super) fn inclination(&self) -> Option<f64> {
        if !self.is_touching() || !self.contour.is_current() {
            return None;
        }
        let normal = self.contour.at(0.0, ContourVector::Normal)?;
        let from_inwards = wrap(self.yaw + self.base_angle() - math::atan2(-normal.y, -normal.x));
        Some(FRAC_PI_2 - self.base_angle().signum() * from_inwards)
    }

    /// Records the tip as a point of the contour during a contact. An interrupted contour restarts.
    pub(super) fn record(&mut self) {
        let tip_world = self.has_contact().then(|| self.tip_world());
        self.contour.record(tip_world, Some(self.base_world));
    }
}

/// Reading of a whisker in the air (rad), or 0 if it was not measured.
fn offset(whisker: &Whisker) -> f64 {
    let measured = whisker.calibration.as_ref().and_then(|calibration| calibration.measured.as_ref());
    measured.map_or(0.0, |measured| measured.offset)
}

/// Time (s) of lost readings that a contact survives.
const BRIDGED: f64 = 0.03;
/// Time (s) after a touch in which a whisker comes to rest.
const SETTLED: f64 = 0.3;
/// Relative change of the measured noise that has an effect.
const NOISE_STEP: f64 = 0.1;

/// Number of samples in a time (s), rounded up.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
fn samples(time: f64, sensing: &Sensing) -> usize {
    (time * sensing.sample_rate).ceil() as usize
}

/// Standard deviation of a filtered base angle (rad), for this noise (rad) of a reading.
pub(super) fn filtered_deviation(sensing: &Sensing, noise: f64) -> f64 {
    // The filter reduces noise, but not the rounding error of a whisker at rest.
    let noise = noise * LowPass::noise_gain(sensing.filter_cutoff, sensing.sample_rate);
    math::hypot(noise, sensing.angle_resolution / 12.0_f64.sqrt())
}

/// Base angle (rad) above which a whisker touches: that of the rig, and no less than the noise reaches.
fn contact_threshold(sensing: &Sensing, base_angle_deviation: f64) -> f64 {
    math::max(sensing.contact_threshold, NOISE_THRESHOLD * base_angle_deviation)
}
