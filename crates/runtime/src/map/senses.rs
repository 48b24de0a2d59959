//! What policies read of perception together with a map.

use crate::geometry::{Point2, Pose, Vector2};
use crate::machine::{
    BodyScalar, ContourVector, MapQuestion, MapScalar, MapVector, Mark, Senses, WhiskerScalar, WhiskerVector,
};
use crate::percept::Perception;

use super::route::RouteStatus;
use super::targets::TargetKind;
use super::touch_map::Map;

/// Perception with a map, as a machine sees both. The map is as the last tick left it, apart from what this tick tells it.
#[derive(Debug)]
pub struct MappedPerception<'c> {
    /// Perception after the newest samples.
    pub perception: &'c mut Perception,
    /// The map.
    pub map: &'c mut Map,
}

/// Distance (m) from a recorded point at which a position counts as traced. It is that at which a contour goes on.
const TRACED: f64 = 10e-3;
/// A vector of a target or a route that does not exist.
const UNDEFINED: Vector2 = Vector2::new(f64::NAN, f64::NAN);

fn truth(truth: bool) -> f64 {
    f64::from(u8::from(truth))
}

impl Senses for MappedPerception<'_> {
    fn time(&self) -> f64 {
        self.perception.time()
    }

    fn body(&self, quantity: BodyScalar) -> f64 {
        self.perception.body(quantity)
    }

    fn body_position(&self) -> Vector2 {
        self.perception.body_position()
    }

    fn whisker(&self, whisker: usize, quantity: WhiskerScalar) -> f64 {
        self.perception.whisker(whisker, quantity)
    }

    fn whisker_vector(&self, whisker: usize, quantity: WhiskerVector) -> Vector2 {
        self.perception.whisker_vector(whisker, quantity)
    }

    fn tip_at(&self, whisker: usize, base_angle: f64) -> Vector2 {
        self.perception.tip_at(whisker, base_angle)
    }

    fn loop_closed(&self, whisker: usize, within: f64, after: f64) -> bool {
        self.perception.loop_closed(whisker, within, after)
    }

    fn contour_at(&self, contour: usize, back: f64, quantity: ContourVector) -> Vector2 {
        self.perception.contour_at(contour, back, quantity)
    }

    fn record(&mut self, whisker: usize) {
        self.perception.record(whisker);
    }

    fn record_position(&mut self, contour: usize, position: Vector2) {
        self.perception.record_position(contour, position);
    }

    fn mark(&mut self, whisker: usize, mark: Mark) {
        self.perception.mark(whisker, mark);
    }

    fn map(&self, quantity: MapScalar) -> f64 {
        let map = &*self.map;
        let next = map.next_target();
        match quantity {
            MapScalar::Unknown => map.unknown_area(),
            MapScalar::IsComplete => truth(map.is_complete()),
            MapScalar::HasNext => truth(next.is_some()),
            MapScalar::NextIsSurface => truth(next.is_some_and(|next| next.kind != TargetKind::Frontier)),
            MapScalar::NextSide => {
                next.map_or(f64::NAN, |next| self.perception.whisker(next.whisker, WhiskerScalar::Side))
            }
            MapScalar::NextHeading => next.map_or(f64::NAN, |next| next.pose.heading),
            MapScalar::RouteSpeed => map.route_motion().speed,
            MapScalar::RouteYawRate => map.route_motion().yaw_rate,
            MapScalar::RouteIsDone => truth(map.is_at_goal()),
            MapScalar::RouteIsLost => truth(matches!(map.route_status(), RouteStatus::Failed(_))),
        }
    }

    fn map_vector(&self, quantity: MapVector) -> Vector2 {
        let next = self.map.next_target();
        match quantity {
            MapVector::NextPlace => next.map_or(UNDEFINED, |next| next.place.coords),
            MapVector::NextNormal => next.map_or(UNDEFINED, |next| next.normal),
            MapVector::NextPosition => next.map_or(UNDEFINED, |next| next.pose.position.coords),
            MapVector::RouteDirection => self.map.route_motion().direction_world,
        }
    }

    fn map_holds(&self, question: MapQuestion, position: Vector2, heading: f64) -> bool {
        let position = Point2::from(position);
        match question {
            MapQuestion::IsFree => self.map.is_free(position),
            MapQuestion::IsClear => {
                let pose = Pose { position, heading };
                pose.is_finite() && self.map.clear(pose)
            }
            MapQuestion::IsTraced => self.map.is_traced(position, TRACED),
        }
    }

    fn go_to(&mut self, position: Vector2, heading: f64) {
        let goal = Pose { position: position.into(), heading };
        self.map.seek_route(goal.is_finite().then_some(goal));
    }

    fn give_up(&mut self) {
        self.map.fail_target();
    }

    fn felt(&mut self, position: Vector2, normal: Vector2) {
        self.map.feel(position.into(), normal);
    }
}
