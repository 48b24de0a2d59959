//! A local contour and the ticks in which it was recorded.

use crate::geometry::{Point2, Vector2};
use crate::machine::{ContourVector, Keypoints};

use super::local_contour::LocalContour;

/// A local contour that restarts when it is recorded again after a tick without a recording.
#[derive(Debug, Clone)]
pub(super) struct RecordedContour {
    local: LocalContour,
    /// The position that determines the side of the normal (m, world frame). `None` for the left side.
    viewpoint: Option<Point2>,
    /// True if this tick recorded the contour, and if the previous one did.
    is_recorded: bool,
    was_recorded: bool,
}

impl RecordedContour {
    /// Creates a contour without points.
    pub(super) fn new(keypoints: Keypoints) -> Self {
        Self { local: LocalContour::new(keypoints), viewpoint: None, is_recorded: false, was_recorded: false }
    }

    /// Begins a tick.
    pub(super) fn begin(&mut self) {
        self.was_recorded = std::mem::replace(&mut self.is_recorded, false);
    }

    /// True if this tick recorded the contour.
    pub(super) fn is_recorded(&self) -> bool {
        self.is_recorded
    }

    /// Records the contour once in a tick, with a point if there is one. An interrupted contour restarts. `viewpoint`
    /// is on the side to which the normal points.
    pub(super) fn record(&mut self, point: Option<Point2>, viewpoint: Option<Point2>) {
        if self.is_recorded {
            return;
        }
        if !self.was_recorded {
            self.local.clear();
        }
        self.is_recorded = true;
        if let Some(point) = point.filter(|point| point.coords.iter().all(|coordinate| coordinate.is_finite())) {
            self.local.add(point);
            self.viewpoint = viewpoint;
        }
    }

    /// True if there is a curve and this tick or the previous one recorded it.
    ///
    /// An interrupted contour restarts when it is recorded again. It is already not ready in the tick after the
    /// interruption, so that no state mistakes it for the new one.
    pub(super) fn is_current(&self) -> bool {
        (self.is_recorded || self.was_recorded) && self.local.is_ready()
    }

    /// The curve through the newest points.
    pub(super) fn local(&self) -> &LocalContour {
        &self.local
    }

    /// A vector of the contour (world frame) at the distance `back` (m) behind its end. `None` until there is a curve.
    pub(super) fn at(&self, back: f64, quantity: ContourVector) -> Option<Vector2> {
        let tangent = self.local.tangent_at(back)?;
        match quantity {
            ContourVector::Point => self.local.point_at(back).map(|point| point.coords),
            ContourVector::Tangent => Some(tangent),
            ContourVector::Normal => {
                let left = Vector2::new(-tangent.y, tangent.x);
                let Some(viewpoint) = self.viewpoint else { return Some(left) };
                Some(if left.dot(&(viewpoint - self.local.newest()?)) < 0.0 { -left } else { left })
            }
        }
    }
}
