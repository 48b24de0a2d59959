//! One whisker as perceived.

use crate::geometry::{Point2, Pose, Vector2, rotate};
use crate::machine::{ContourVector, Mark};
use crate::rig::{Sensing, Whisker};

use super::deflection::{Deflection, GREATEST_ANGLE};
use super::local_contour::LocalContour;
use super::low_pass::LowPass;
use super::sliding::{Contact, Sliding};
use super::tip_model::TipModel;

/// One whisker as perceived: where it is, how it bends, what it has touched.
#[derive(Debug, Clone)]
pub(super) struct PerceivedWhisker {
    base_body: Vector2,
    direction_body: f64,
    pub(super) side: f64,
    pub(super) length: f64,
    pub(super) deflection: Deflection,
    pub(super) model: TipModel,
    pub(super) sliding: Option<Sliding>,
    contact_threshold: f64,
    /// Standard deviation of the deflection (rad).
    deflection_spread: f64,
    pub(super) base_world: Point2,
    pub(super) yaw: f64,
    pub(super) contour: LocalContour,
    /// Where the base was when the contour was last added to.
    recorded_from: Point2,
    /// Whether this tick's tip was recorded, and the last one's was.
    pub(super) recorded: bool,
    recorded_before: bool,
    /// The marks that this tick made, in their order.
    pub(super) marks: [Option<Mark>; Mark::ALL.len()],
}

impl PerceivedWhisker {
    pub(super) fn new(
        whisker: &Whisker,
        filter: LowPass,
        model: TipModel,
        sliding: Option<Sliding>,
        sensing: &Sensing,
    ) -> Self {
        // Noise is filtered; that a reading is rounded is not, while the whisker is at rest.
        let noise = sensing.angle_noise * LowPass::noise_gain(sensing.filter_cutoff, sensing.sample_rate);
        let rounding = sensing.angle_resolution / 12.0_f64.sqrt();
        Self {
            base_body: whisker.base_body.coords,
            direction_body: whisker.direction_body,
            side: whisker.side(),
            length: whisker.shaft.length,
            deflection: Deflection::new(filter),
            model,
            sliding,
            contact_threshold: sensing.contact_threshold,
            deflection_spread: noise.hypot(rounding),
            base_world: Point2::origin(),
            yaw: 0.0,
            contour: LocalContour::default(),
            recorded_from: Point2::origin(),
            recorded: false,
            recorded_before: false,
            marks: Default::default(),
        }
    }

    /// Filtered base angle (rad); not a number where the tick has brought no valid reading.
    pub(super) fn deflection(&self) -> f64 {
        self.deflection.value()
    }

    /// Takes a base angle (rad), sampled with the platform at `body`.
    pub(super) fn take(&mut self, base_angle: f64, body: Pose) {
        self.deflection.take(base_angle);
        if let Some(sliding) = &mut self.sliding {
            if base_angle.abs() <= GREATEST_ANGLE && body.is_finite() {
                let position = body.point_to_world(self.base_body.into());
                sliding.take(base_angle, Pose { position, heading: body.heading + self.direction_body });
            } else {
                sliding.interrupt();
            }
        }
    }

    /// Goes where it is with the platform at `body`.
    pub(super) fn place(&mut self, body: Pose) {
        self.base_world = body.point_to_world(self.base_body.into());
        self.yaw = body.heading + self.direction_body;
        self.recorded_before = self.recorded;
        self.recorded = false;
        self.marks = Default::default();
    }

    /// Notes a mark, once a tick.
    pub(super) fn mark(&mut self, mark: Mark) {
        if !self.marks.contains(&Some(mark))
            && let Some(free) = self.marks.iter_mut().find(|free| free.is_none())
        {
            *free = Some(mark);
        }
    }

    pub(super) fn touches(&self) -> bool {
        self.deflection().abs() > self.contact_threshold
    }

    /// Where the tip touches, in the frame of the base (m).
    pub(super) fn tip_base(&self) -> Vector2 {
        match self.contact() {
            Some((sliding, contact)) => rotate(sliding.touched(contact) - self.base_world, -self.yaw),
            None => self.model.contact_base(self.deflection()),
        }
    }

    /// Where the tip would touch at another deflection, in the frame of the base (m): the surface turned as it is now, or, where
    /// nothing is known of it, parallel to the heading.
    pub(super) fn tip_at(&self, deflection: f64) -> Vector2 {
        let sliding = self.contact().and_then(|(sliding, contact)| sliding.tip_at(contact, deflection, self.yaw));
        sliding.unwrap_or_else(|| self.model.contact_base(deflection))
    }

    /// The contact of the tip, if it slides and the tick has brought a valid reading.
    fn contact(&self) -> Option<(&Sliding, &Contact)> {
        let sliding = self.sliding.as_ref()?;
        if self.deflection().is_nan() { None } else { Some((sliding, sliding.contact()?)) }
    }

    /// Whether the whisker touches what can be told: with a tip that slides, if that is how it is perceived.
    pub(super) fn is_felt(&self) -> bool {
        self.touches() && (self.sliding.is_none() || self.contact().is_some())
    }

    /// Where the tip touches, in the world frame (m).
    pub(super) fn tip_world(&self) -> Point2 {
        match self.contact() {
            Some((sliding, contact)) => sliding.touched(contact),
            None => self.base_world + rotate(self.tip_base(), self.yaw),
        }
    }

    /// How far off the tip may be (m): a standard deviation.
    pub(super) fn tip_spread(&self) -> f64 {
        match self.contact() {
            Some((_, contact)) => contact.place_spread(),
            None => self.model.spread(self.deflection(), self.deflection_spread),
        }
    }

    /// A vector of the contour (world frame) at the distance `back` (m) behind its end, once it is ready.
    pub(super) fn contour_at(&self, back: f64, quantity: ContourVector) -> Option<Vector2> {
        let tangent = self.contour.tangent_at(back)?;
        match quantity {
            ContourVector::Point => self.contour.point_at(back).map(|point| point.coords),
            ContourVector::Tangent => Some(tangent),
            ContourVector::Normal => {
                let left = Vector2::new(-tangent.y, tangent.x);
                let side = left.dot(&(self.recorded_from - self.contour.newest()?));
                Some(if side < 0.0 { -left } else { left })
            }
        }
    }

    /// Takes the tip as a point of the contour if it touches. A contour that was left off begins anew.
    pub(super) fn record(&mut self) {
        if self.recorded {
            return;
        }
        if !self.recorded_before {
            self.contour.clear();
        }
        self.recorded = true;
        let tip_world = self.tip_world();
        if self.is_felt() && tip_world.coords.iter().all(|coordinate| coordinate.is_finite()) {
            self.contour.add(tip_world);
            self.recorded_from = self.base_world;
        }
    }
}
