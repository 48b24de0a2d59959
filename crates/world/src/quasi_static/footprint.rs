//! The collision of the platform's body with the solids.

use crate::geometry::{BoundingBox, Point2, Pose, Vector2, perpendicular};
use vibrissa_runtime::rig::Platform;

use super::platform_dynamics::Twist;
use super::surface::{Junction, Surfaces};

/// The footprint of the platform with its mass properties.
#[derive(Debug)]
pub(super) struct Footprint {
    outline_body: [Point2; 4],
    mass: f64,
    inertia: f64,
    /// A lower bound (m) of the distance between the body and all solids.
    clear: f64,
    /// The distance (m) of the farthest point of the body from its centre of mass.
    bounding_radius: f64,
    contacts: Vec<BodyContact>,
}

/// A possible contact of the body.
#[derive(Debug, Clone, Copy)]
struct BodyContact {
    /// The vector from the centre of mass to the contact point (m, world frame).
    arm: Vector2,
    /// The contact normal, a unit vector in the world frame that points away from the solid.
    normal: Vector2,
    /// The distance (m), negative if body and solid overlap.
    gap: f64,
    /// The accumulated impulse: mass times displacement for positions, momentum for velocities.
    impulse: f64,
}

/// The distance (m) around the body within which solids are searched.
const SEARCH_MARGIN: f64 = 20e-3;
/// A point that is deeper inside than this (m) belongs to another side.
const SKIN: f64 = 2e-4;
/// The number of sweeps over the contacts.
const ITERATIONS: usize = 60;

impl Footprint {
    pub(super) fn new(platform: &Platform) -> Self {
        let outline_body = platform.outline_body();
        Self {
            outline_body,
            mass: platform.mass,
            inertia: platform.inertia,
            clear: 0.0,
            bounding_radius: outline_body.iter().map(|corner| corner.coords.norm()).fold(0.0, f64::max),
            contacts: Vec::new(),
        }
    }

    /// Removes from the displacement `motion` and the velocity `speed` the components that lead into a solid. Returns
    /// the largest impact speed (m/s), or `None` without contact.
    pub(super) fn constrain(
        &mut self,
        pose: Pose,
        motion: &mut Twist,
        speed: &mut Twist,
        surfaces: &Surfaces,
    ) -> Option<f64> {
        let motion_bound = motion.linear.norm() + self.bounding_radius * motion.angular.abs();
        if self.clear > motion_bound {
            self.clear -= motion_bound;
            return None;
        }
        self.clear = self.broad_phase(pose, surfaces) - motion_bound;
        let mut impact: Option<f64> = None;
        for contact in &self.contacts {
            if contact.gap + contact.normal.dot(&motion.at(contact.arm)) < 0.0 {
                let into = -contact.normal.dot(&speed.at(contact.arm));
                impact = Some(impact.unwrap_or(0.0).max(into));
            }
        }
        if impact.is_some() {
            self.apply_impulses(motion, |contact| contact.gap);
            self.apply_impulses(speed, |contact| if contact.gap < SKIN { 0.0 } else { f64::INFINITY });
        }
        impact
    }

    /// Limits a motion at every contact to the distance that is left, by sequential impulses (projected Gauss-Seidel).
    fn apply_impulses(&mut self, twist: &mut Twist, room: impl Fn(&BodyContact) -> f64) {
        for contact in &mut self.contacts {
            contact.impulse = 0.0;
        }
        for _ in 0..ITERATIONS {
            for contact in &mut self.contacts {
                let lever = contact.arm.perp(&contact.normal);
                let missing = -(room(contact) + contact.normal.dot(&twist.at(contact.arm)));
                let wanted = contact.impulse + missing / (1.0 / self.mass + lever * lever / self.inertia);
                let change = wanted.max(0.0) - contact.impulse;
                contact.impulse += change;
                twist.linear += change / self.mass * contact.normal;
                twist.angular += change / self.inertia * lever;
            }
        }
    }

    /// Broad phase: finds all possible contacts near a pose. Returns a lower bound (m) of the distance of all solids.
    fn broad_phase(&mut self, pose: Pose, surfaces: &Surfaces) -> f64 {
        self.contacts.clear();
        let mut clear = SEARCH_MARGIN;
        let corners = self.outline_body.map(|corner| pose.point_to_world(corner));
        let bounds = corners
            .iter()
            .map(|&corner| BoundingBox::around(corner, corner))
            .reduce(|bounds, corner| bounds.union(&corner))
            .unwrap_or(BoundingBox::around(pose.position, pose.position));
        let sides = [0, 1, 2, 3].map(|side| Side::between(corners[side], corners[(side + 1) % 4]));
        let mut add = |point: Point2, normal: Vector2, gap: f64| {
            if gap > -SKIN && gap < SEARCH_MARGIN {
                clear = clear.min(gap);
                self.contacts.push(BodyContact { arm: point - pose.position, normal, gap, impulse: 0.0 });
            }
        };
        let mut nearest_corners = SEARCH_MARGIN;
        for (_, facet) in surfaces.near(bounds, SEARCH_MARGIN) {
            for corner in corners {
                if let Some(projection) = facet.project(corner) {
                    add(corner, projection.normal, projection.height);
                }
            }
            if let Junction::Convex(solids_corner) = facet.junction {
                for side in &sides {
                    if let Some(height) = side.height(solids_corner.point) {
                        add(solids_corner.point, -side.outwards, height);
                    }
                }
                let distances = corners.iter().map(|corner| (corner - solids_corner.point).norm());
                nearest_corners = distances.fold(nearest_corners, f64::min);
            }
            if let Some((centre, radius)) = facet.bulge() {
                for side in &sides {
                    if facet.spans(-side.outwards) {
                        if let Some(height) = side.height(centre) {
                            add(centre - radius * side.outwards, -side.outwards, height - radius);
                        }
                        continue;
                    }
                    // A side that is nearly parallel to a face touches the far end of that face after a small rotation.
                    for end in facet.ends {
                        if let Some(height) = side.height(end) {
                            add(end, -side.outwards, height);
                        }
                    }
                }
            }
        }
        clear.min(nearest_corners).max(0.0)
    }
}

/// A side of the footprint.
struct Side {
    start: Point2,
    along: Vector2,
    length: f64,
    outwards: Vector2,
}

impl Side {
    fn between(start: Point2, end: Point2) -> Self {
        let length = (end - start).norm();
        let along = (end - start) / length;
        Self { start, along, length, outwards: -perpendicular(along) }
    }

    /// Returns the signed distance (m) of a point from the side, positive outside. `None` if the point is beyond an end
    /// of the side.
    fn height(&self, point: Point2) -> Option<f64> {
        let from_start = point - self.start;
        let along = from_start.dot(&self.along);
        (along > 0.0 && along < self.length).then(|| from_start.dot(&self.outwards))
    }
}
