//! What a rig can reach.

use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

use crate::geometry::{ContourSet, Point2, Pose, Vector2, unit};
use crate::solid::{Part, Solid};
use vibrissa_runtime::rig::{Platform, Rig, Whisker};
use vibrissa_runtime::signal::Command;

/// With so many parts a model holds those alone that are near.
const MANY_PARTS: usize = 12;
/// How far (m) the platform may go before the parts near it are looked up anew.
const WINDOW: f64 = 0.2;
/// How far (m) parts may lie outside of the exact outlines, and a tip from where its chain would reach.
const TOLERANCE: f64 = 2e-4;
/// A whisker at rest becomes rigid farther from everything than this (m) beyond its length.
const RIGID: f64 = 20e-3;
/// A rigid one bends again nearer than this (m).
const FLEXIBLE: f64 = 10e-3;
/// The share of the contact threshold that the inertia of a rigid whisker may amount to.
const INERTIAL_SHARE: f64 = 0.25;

/// What the parts of a rig can reach, wherever it is: distances from exact outlines, and a tree of the parts' boxes.
///
/// A whisker does not stretch: nothing of it, however it bends, is farther from its base than its length.
#[derive(Debug)]
pub struct Reach {
    surfaces: Option<ContourSet>,
    boxes: RTree<GeomWithData<Rectangle<[f64; 2]>, usize>>,
    parts: Vec<Part>,
    /// The farthest (m) that anything of the rig is from the platform's centre of mass.
    extent: f64,
}

impl Reach {
    /// What `rig` can reach of `solids`.
    #[must_use]
    pub fn new(rig: &Rig, solids: &[Solid]) -> Self {
        let boxed = |(index, part): (usize, &Part)| {
            let (low, high) = part.bounds();
            GeomWithData::new(Rectangle::from_corners([low.x, low.y], [high.x, high.y]), index)
        };
        let parts: Vec<Part> = solids.iter().flat_map(Solid::parts).cloned().collect();
        let boxes = RTree::bulk_load(parts.iter().enumerate().map(boxed).collect());
        let corners = rig.platform.outline_body().map(|corner| corner.coords.norm());
        let tips = rig.whiskers.iter().map(|whisker| whisker.base_body.coords.norm() + whisker.shaft.length);
        let extent = corners.into_iter().chain(tips).fold(0.0, f64::max) + TOLERANCE;
        let surfaces = ContourSet::new(solids.iter().map(|solid| solid.outline().clone()));
        Self { surfaces, boxes, parts, extent }
    }

    /// Whether a model holds only the parts near the platform, because there are many.
    #[must_use]
    pub fn is_windowed(&self) -> bool {
        self.boxes.size() > MANY_PARTS
    }

    /// The parts, by their indices, ascending, that the rig can reach while the platform's centre of mass is in the window about
    /// `centre`.
    #[must_use]
    pub fn parts_about(&self, centre: Point2) -> Vec<usize> {
        self.boxes_near([centre], self.extent + WINDOW)
    }

    /// The centre of the next window of a platform that is at `position` and is told to go on with `velocity` (m/s).
    #[must_use]
    pub fn window_ahead(&self, position: Point2, velocity: Vector2) -> Point2 {
        position + velocity.try_normalize(1e-6).map_or(Vector2::zeros(), |ahead| 0.8 * WINDOW * ahead)
    }

    /// Whether a platform at `position` stays in the window about `centre` while it goes as far as `travel` (m).
    #[must_use]
    pub fn is_within(&self, position: Point2, centre: Point2, travel: f64) -> bool {
        (position - centre).norm() + travel <= WINDOW
    }

    /// Distance (m) of a whisker's base from what is nearest; infinite where there is nothing.
    #[must_use]
    pub fn clearance(&self, whisker: &Whisker, body: &Pose) -> f64 {
        self.distance(body.point_to_world(whisker.base_body))
    }

    /// Distance (m) of a place from what is nearest; 0 within a solid, and infinite where there is nothing.
    fn distance(&self, place: Point2) -> f64 {
        if self.parts_near([place], 0.0).is_empty() {
            self.surfaces.as_ref().map_or(f64::INFINITY, |surfaces| surfaces.distance(place))
        } else {
            0.0
        }
    }

    /// A bound on how far (m) anything of the rig that is fixed to the platform went from one pose to another.
    #[must_use]
    pub fn way(&self, from: &Pose, to: &Pose) -> f64 {
        (to.position - from.position).norm() + (to.heading - from.heading).abs() * self.extent
    }

    /// Of every link of a whisker, given by their starts (m, world frame) and directions (rad), the parts that it may touch before
    /// anything of it has gone as far as `slack` (m).
    pub fn near_links<'a>(
        &'a self,
        whisker: &'a Whisker,
        links: impl Iterator<Item = (Point2, f64)> + 'a,
        slack: f64,
    ) -> impl Iterator<Item = (usize, usize)> + 'a {
        let (shaft, length) = (&whisker.shaft, whisker.shaft.link_length());
        let mut skip = 0;
        let near = links.enumerate().filter_map(move |(link, (start, direction))| {
            if link < skip {
                return None;
            }
            let along = length * unit(direction);
            let reach = shaft.link_radius(link) + slack + TOLERANCE;
            let clearance = self.distance(start + 0.5 * along) - 0.5 * length - reach;
            if clearance > 0.0 {
                // The middle of the next link is at most a link farther on.
                skip = whole_links(clearance, length).saturating_add(link + 1);
                return None;
            }
            Some((link, self.parts_near([start, start + along], reach)))
        });
        near.flat_map(|(link, parts)| parts.into_iter().map(move |part| (link, part)))
    }

    /// The parts that the platform's body at this pose may touch before anything of it has gone as far as `slack` (m).
    #[must_use]
    pub fn near_body(&self, platform: &Platform, body: &Pose, slack: f64) -> Vec<usize> {
        let corners = platform.outline_body();
        let radius = corners.iter().map(|corner| corner.coords.norm()).fold(0.0, f64::max);
        if self.distance(body.position) > radius + slack + TOLERANCE {
            return Vec::new();
        }
        self.parts_near(corners.map(|corner| body.point_to_world(corner)), slack + TOLERANCE)
    }

    /// The parts, ascending, that may come as near as `reach` (m) to what is between these points.
    fn parts_near<const N: usize>(&self, points: [Point2; N], reach: f64) -> Vec<usize> {
        let mut parts = self.boxes_near(points, reach);
        parts.retain(|part| self.parts.get(*part).is_none_or(|part| !part.is_apart(&points, reach)));
        parts
    }

    /// The parts, ascending, whose boxes come as near as `reach` (m) to the box about these points.
    fn boxes_near<const N: usize>(&self, points: [Point2; N], reach: f64) -> Vec<usize> {
        let nowhere = (Point2::from(Vector2::repeat(f64::INFINITY)), Point2::from(Vector2::repeat(f64::NEG_INFINITY)));
        let (low, high) = points.iter().fold(nowhere, |(low, high), point| (low.inf(point), high.sup(point)));
        let (low, high) = (low - Vector2::repeat(reach), high + Vector2::repeat(reach));
        let window = AABB::from_corners([low.x, low.y], [high.x, high.y]);
        let mut parts: Vec<usize> = self.boxes.locate_in_envelope_intersecting(window).map(|part| part.data).collect();
        parts.sort_unstable();
        parts
    }
}

/// How many links of this length (m) fit into a way (m).
fn whole_links(way: f64, length: f64) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates: more links than there are")]
    let links = (way / length) as usize;
    links
}

/// Whether a whisker whose base is that far (m) from everything, and goes as far as `travel` (m), stays rigid if it is, or may become so.
#[must_use]
pub fn may_be_rigid(whisker: &Whisker, clearance: f64, travel: f64, is_rigid: bool) -> bool {
    clearance - travel - whisker.shaft.length > if is_rigid { FLEXIBLE } else { RIGID }
}

/// Whether a command, given at these velocities (m/s, rad/s), moves the platform so gently that a whisker in the air reads nothing of it.
///
/// A servo begins with the acceleration `a = Δv / T`, and by `α` turns the base, which is `r` from the centre of mass. A whisker of the
/// mass `m` and the length `L` pulls at its hinge with at most `m L (a + α (r + L)) / 2`, and with twice that while it swings.
#[must_use]
pub fn is_gentle(rig: &Rig, whisker: &Whisker, command: &Command, velocity: Vector2, yaw_rate: f64) -> bool {
    let shaft = &whisker.shaft;
    let mass: f64 = (0..shaft.links).map(|link| shaft.link_mass(link)).sum();
    let radius = whisker.base_body.coords.norm() + shaft.length;
    let change = (command.velocity_world - velocity).norm() + radius * (command.yaw_rate - yaw_rate).abs();
    let moment = mass * shaft.length * change / rig.platform.servo;
    moment <= INERTIAL_SHARE * rig.sensing.contact_threshold * whisker.hinge.stiffness
}
