//! The perception of one whisker.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use crate::geometry::{Point2, Pose, Vector2, rotate, wrap};
use crate::machine::{ContourVector, Keypoints, Mark};
use crate::math;
use crate::rig::{Sensing, Whisker};
use crate::signal::Reading;

use super::contact::Contact;
use super::contact_estimator::ContactEstimator;
use super::filtered_base_angle::{FilteredBaseAngle, GREATEST_ANGLE};
use super::low_pass::LowPass;
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
    pub(super) base_angle: FilteredBaseAngle,
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
    /// Position of the base (m, world frame).
    pub(super) base_world: Point2,
    /// Direction of the undeflected shaft (rad, world frame).
    pub(super) yaw: f64,
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
        Self {
            base_body: whisker.base_body.coords,
            direction_body: whisker.direction_body,
            side: whisker.side(),
            length: whisker.shaft.length,
            offset: offset(whisker),
            base_angle: FilteredBaseAngle::new(filter),
            estimator,
            contact: None,
            curve,
            contact_threshold: sensing.contact_threshold,
            base_angle_deviation: base_angle_deviation(sensing),
            surface_roughness: sensing.surface_roughness,
            base_world: Point2::origin(),
            yaw: 0.0,
            contour: RecordedContour::new(Keypoints::default()),
            marks: Default::default(),
        }
    }

    /// Replaces the contact estimator.
    pub(super) fn set_estimator(&mut self, estimator: Box<dyn ContactEstimator>) {
        self.estimator = estimator;
    }

    /// Filtered base angle (rad), or NaN if the tick has no valid reading.
    pub(super) fn base_angle(&self) -> f64 {
        self.base_angle.value()
    }

    /// Adds a reading, sampled with the platform at `body`.
    pub(super) fn take(&mut self, reading: &Reading, body: Pose) {
        let reading = &Reading { base_angle: reading.base_angle - self.offset, ..*reading };
        self.base_angle.take(reading.base_angle);
        if reading.base_angle.abs() <= GREATEST_ANGLE && body.is_finite() {
            self.estimator.take(reading, self.base(body));
        } else {
            self.estimator.interrupt();
        }
    }

    /// The position of the base and the direction of the undeflected shaft, with the platform at `body`.
    fn base(&self, body: Pose) -> Pose {
        let position = body.point_to_world(self.base_body.into());
        Pose { position, heading: body.heading + self.direction_body }
    }

    /// Updates pose and contact of the whisker, with the platform at `body`.
    pub(super) fn update(&mut self, body: Pose) {
        let base = self.base(body);
        (self.base_world, self.yaw) = (base.position, base.heading);
        let base_angle = self.base_angle();
        self.contact = if base_angle.is_nan() { None } else { self.estimator.contact(base_angle, base) };
        self.contour.begin();
        self.marks = Default::default();
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
        let touched = self.contact.and_then(|_| self.estimator.contact_at(base_angle, self.yaw));
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
            None => self.base_world + rotate(self.tip_base(), self.yaw),
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

/// Standard deviation of a filtered base angle (rad).
pub(super) fn base_angle_deviation(sensing: &Sensing) -> f64 {
    // The filter reduces noise, but not the rounding error of a whisker at rest.
    let noise = sensing.angle_noise * LowPass::noise_gain(sensing.filter_cutoff, sensing.sample_rate);
    math::hypot(noise, sensing.angle_resolution / 12.0_f64.sqrt())
}
