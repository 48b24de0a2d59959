//! One whisker as perceived.

use crate::geometry::{Point2, Pose, Vector2, rotate};
use crate::rig::Whisker;

use super::local_contour::LocalContour;
use super::low_pass::LowPass;
use super::tip_model::TipModel;

/// One whisker as perceived: where it is, how it bends, what it has touched.
#[derive(Debug, Clone)]
pub(super) struct PerceivedWhisker {
    base_body: Vector2,
    direction_body: f64,
    pub(super) side: f64,
    pub(super) length: f64,
    filter: LowPass,
    pub(super) model: TipModel,
    contact_threshold: f64,
    pub(super) deflection: f64,
    pub(super) base_world: Point2,
    pub(super) yaw: f64,
    pub(super) contour: LocalContour,
    /// Whether this tick's tip was recorded, and the last one's was.
    pub(super) recorded: bool,
    recorded_before: bool,
}

impl PerceivedWhisker {
    pub(super) fn new(whisker: &Whisker, filter: LowPass, model: TipModel, contact_threshold: f64) -> Self {
        Self {
            base_body: whisker.base_body.coords,
            direction_body: whisker.direction_body,
            side: whisker.side(),
            length: whisker.shaft.length,
            filter,
            model,
            contact_threshold,
            deflection: 0.0,
            base_world: Point2::origin(),
            yaw: 0.0,
            contour: LocalContour::default(),
            recorded: false,
            recorded_before: false,
        }
    }

    /// Takes one base angle (rad).
    pub(super) fn filter(&mut self, base_angle: f64) {
        self.deflection = self.filter.next(base_angle);
    }

    /// Begins a tick with the platform at `body`.
    pub(super) fn place(&mut self, body: Pose) {
        self.base_world = body.point_to_world(self.base_body.into());
        self.yaw = body.heading + self.direction_body;
        self.recorded_before = self.recorded;
        self.recorded = false;
    }

    pub(super) fn touches(&self) -> bool {
        self.deflection.abs() > self.contact_threshold
    }

    /// Where the tip touches, in the frame of the base (m).
    pub(super) fn tip_base(&self) -> Vector2 {
        self.model.contact_base(self.deflection)
    }

    /// Where the tip touches, in the world frame (m).
    pub(super) fn tip_world(&self) -> Point2 {
        self.base_world + rotate(self.tip_base(), self.yaw)
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
        if self.touches() {
            self.contour.add(self.tip_world());
        }
    }
}
