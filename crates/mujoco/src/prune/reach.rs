//! The reach of a rig.

use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

use vibrissa_runtime::rig::{Platform, Rig, Whisker};
use vibrissa_runtime::signal::Command;
use vibrissa_world::geometry::{ContourSet, Point2, Pose, TreePoint, Vector2, unit};
use vibrissa_world::solid::{Part, PartsError, Solid, convex_parts};

/// With more parts than this, a model contains only those near the platform.
const MANY_PARTS: usize = 12;
/// The distance (m) that the platform may move before the nearby parts are searched again.
const WINDOW: f64 = 0.2;
/// Tolerance (m) for the deviation of parts from the exact outlines, and for the length of a chain.
const TOLERANCE: f64 = 2e-4;
/// A whisker at rest becomes rigid if its clearance exceeds its length by more than this (m).
const RIGID: f64 = 20e-3;
/// A rigid whisker becomes flexible if its clearance exceeds its length by less than this (m).
const FLEXIBLE: f64 = 10e-3;
/// The share of the contact threshold that the inertia of a rigid whisker may cause.
const INERTIAL_SHARE: f64 = 0.25;

/// The reach of a rig in any pose: distances from exact outlines, and a tree of the bounding boxes of parts.
///
/// A whisker does not stretch. However it bends, no point of it is farther from its base than its length.
#[derive(Debug)]
pub struct Reach {
    surfaces: Option<ContourSet>,
    boxes: RTree<GeomWithData<Rectangle<TreePoint>, usize>>,
    parts: Vec<Part>,
    /// The distance (m) of the farthest point of the rig from the platform's centre of mass.
    extent: f64,
}

impl Reach {
    /// Creates the search structures for `rig` and `solids`.
    ///
    /// # Errors
    /// [`PartsError`] if a solid is too large for MuJoCo.
    pub fn new(rig: &Rig, solids: &[Solid]) -> Result<Self, PartsError> {
        let boxed = |(index, part): (usize, &Part)| {
            let (low, high) = part.bounds();
            GeomWithData::new(Rectangle::from_corners((low.x, low.y), (high.x, high.y)), index)
        };
        let parts = convex_parts(solids)?;
        let boxes = RTree::bulk_load(parts.iter().enumerate().map(boxed).collect());
        let corners = rig.platform.outline_body().map(|corner| corner.coords.norm());
        let tips = rig.whiskers.iter().map(|whisker| whisker.base_body.coords.norm() + whisker.shaft.length);
        let extent = corners.into_iter().chain(tips).fold(0.0, f64::max) + TOLERANCE;
        let surfaces = ContourSet::new(solids.iter().map(|solid| solid.surface().clone()));
        Ok(Self { surfaces, boxes, parts, extent })
    }

    /// The convex parts of all solids, in order.
    pub(crate) fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// True if a model contains only the parts near the platform.
    #[must_use]
    pub(crate) fn is_windowed(&self) -> bool {
        self.boxes.size() > MANY_PARTS
    }

    /// The indices of the parts in reach while the platform's centre of mass is in the window about `centre`,
    /// ascending.
    #[must_use]
    pub(crate) fn parts_about(&self, centre: Point2) -> Vec<usize> {
        self.boxes_near([centre], self.extent + WINDOW)
    }

    /// The centre of the next window for a platform at `position` with the commanded `velocity` (m/s).
    #[must_use]
    pub fn window_ahead(&self, position: Point2, velocity: Vector2) -> Point2 {
        position + velocity.try_normalize(1e-6).map_or(Vector2::zeros(), |ahead| 0.8 * WINDOW * ahead)
    }

    /// True if a platform at `position` remains in the window about `centre` for a motion of `travel` (m).
    #[must_use]
    pub fn is_within(&self, position: Point2, centre: Point2, travel: f64) -> bool {
        (position - centre).norm() + travel <= WINDOW
    }

    /// The distance (m) of a whisker's base from the nearest solid, infinite without solids.
    #[must_use]
    pub fn clearance(&self, whisker: &Whisker, body: &Pose) -> f64 {
        self.distance(body.point_to_world(whisker.base_body))
    }

    /// The distance (m) of a point from the nearest solid, 0 inside of a solid, infinite without solids.
    fn distance(&self, place: Point2) -> f64 {
        if self.parts_near([place], 0.0).is_empty() {
            self.surfaces.as_ref().map_or(f64::INFINITY, |surfaces| surfaces.distance(place))
        } else {
            0.0
        }
    }

    /// An upper bound of the displacement (m) between two poses of any point that is fixed to the platform.
    #[must_use]
    pub fn motion_bound(&self, from: &Pose, to: &Pose) -> f64 {
        (to.position - from.position).norm() + (to.heading - from.heading).abs() * self.extent
    }

    /// The pairs of links and parts that may touch within a motion of `slack` (m). The links are given by their near
    /// ends (m, world frame) and directions (rad).
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
                // The centre of the next link is at most a link length away.
                skip = whole_links(clearance, length).saturating_add(link + 1);
                return None;
            }
            Some((link, self.parts_near([start, start + along], reach)))
        });
        near.flat_map(|(link, parts)| parts.into_iter().map(move |part| (link, part)))
    }

    /// The parts that the platform's body may touch within a motion of `slack` (m).
    #[must_use]
    pub fn near_body(&self, platform: &Platform, body: &Pose, slack: f64) -> Vec<usize> {
        let corners = platform.outline_body();
        let radius = corners.iter().map(|corner| corner.coords.norm()).fold(0.0, f64::max);
        if self.distance(body.position) > radius + slack + TOLERANCE {
            return Vec::new();
        }
        self.parts_near(corners.map(|corner| body.point_to_world(corner)), slack + TOLERANCE)
    }

    /// The parts within `reach` (m) of the convex hull of these points, ascending. The result may contain more parts.
    fn parts_near<const N: usize>(&self, points: [Point2; N], reach: f64) -> Vec<usize> {
        let mut parts = self.boxes_near(points, reach);
        parts.retain(|part| self.parts.get(*part).is_none_or(|part| !part.is_farther_than(&points, reach)));
        parts
    }

    /// The parts whose bounding boxes are within `reach` (m) of the bounding box of these points, ascending.
    fn boxes_near<const N: usize>(&self, points: [Point2; N], reach: f64) -> Vec<usize> {
        let nowhere = (Point2::from(Vector2::repeat(f64::INFINITY)), Point2::from(Vector2::repeat(f64::NEG_INFINITY)));
        let (low, high) = points.iter().fold(nowhere, |(low, high), point| (low.inf(point), high.sup(point)));
        let (low, high) = (low - Vector2::repeat(reach), high + Vector2::repeat(reach));
        let window = AABB::from_corners((low.x, low.y), (high.x, high.y));
        let mut parts: Vec<usize> = self.boxes.locate_in_envelope_intersecting(window).map(|part| part.data).collect();
        parts.sort_unstable();
        parts
    }
}

/// The number of links of this length (m) that fit into a distance (m).
fn whole_links(way: f64, length: f64) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates: more links than there are")]
    let links = (way / length) as usize;
    links
}

/// True if a whisker may become or remain rigid. A curved one may not, because a rigid whisker is straight. `clearance` is the distance (m) of its base from all solids, `travel`
/// the motion in the next tick (m).
#[must_use]
pub fn may_be_rigid(whisker: &Whisker, clearance: f64, travel: f64, is_rigid: bool) -> bool {
    whisker.shaft.curvature == 0.0
        && clearance - travel - whisker.shaft.length > if is_rigid { FLEXIBLE } else { RIGID }
}

/// True if a command changes the velocities (m/s, rad/s) so little that a whisker without contact reads nothing of it.
///
/// A servo starts with the acceleration `a = Δv / T` and the angular acceleration `α`, here with the faster of both servos. The base has the distance `r`
/// from the centre of mass. A whisker of mass `m` and length `L` exerts at most the moment `m L (a + α (r + L)) / 2` on
/// its hinge, and twice that while it swings.
#[must_use]
pub fn is_gentle(rig: &Rig, whisker: &Whisker, command: &Command, velocity: Vector2, yaw_rate: f64) -> bool {
    let shaft = &whisker.shaft;
    let mass: f64 = (0..shaft.links).map(|link| shaft.link_mass(link)).sum();
    let radius = whisker.base_body.coords.norm() + shaft.length;
    let change = (command.velocity_world - velocity).norm() + radius * (command.yaw_rate - yaw_rate).abs();
    let moment = mass * shaft.length * change / rig.platform.servos().min();
    moment <= INERTIAL_SHARE * rig.sensing.contact_threshold * whisker.hinge.stiffness
}
