//! A whisker's shaft as a chain of links in the plane.

use crate::geometry::{BoundingBox, Point2, Pose, Vector2, perpendicular, unit};
use vibrissa_runtime::rig::Whisker;

/// What does not change of a whisker's chain: the very links and springs that MuJoCo's world and the tip models have.
#[derive(Debug)]
pub(super) struct Wire {
    /// Length of a link (m).
    pub(super) link: f64,
    /// Stiffness (N m/rad) of the hinge at the base and the root of the shaft, one behind the other, and of the joints.
    pub(super) stiffnesses: Vec<f64>,
    /// What the springs give the matrix of the energy: its diagonal, and what is beside it.
    pub(super) diagonal: Vec<f64>,
    pub(super) beside: Vec<f64>,
    /// The hinge's share of the angle of the first link.
    pub(super) hinge_share: f64,
    /// Radius (m) at the far end of every link.
    end_radii: Vec<f64>,
    /// Mean radius (m) of every link.
    radii: Vec<f64>,
}

/// A chain, bent and in its place.
#[derive(Debug)]
pub(super) struct Shape {
    /// The base, and the direction of the undeflected shaft.
    pub(super) base: Pose,
    /// Directions of the links, from that of the undeflected shaft (rad).
    pub(super) angles: Vec<f64>,
    /// The same in the world, as unit vectors, and the angles (rad) that these have.
    pub(super) along: Vec<Vector2>,
    facing: Vec<f64>,
    /// The base and the far ends of all links (m, world frame).
    pub(super) ends: Vec<Point2>,
}

impl Wire {
    pub(super) fn new(whisker: &Whisker) -> Self {
        let (shaft, hinge) = (&whisker.shaft, whisker.hinge.stiffness);
        let mut stiffnesses: Vec<f64> = shaft.joint_stiffnesses().collect();
        let root = stiffnesses[0];
        stiffnesses[0] = hinge * root / (hinge + root);
        let behind = stiffnesses[1..].iter().copied().chain([0.0]);
        Self {
            diagonal: stiffnesses.iter().zip(behind).map(|(stiffness, behind)| stiffness + behind).collect(),
            beside: stiffnesses[1..].iter().map(|stiffness| -stiffness).collect(),
            link: shaft.link_length(),
            hinge_share: root / (hinge + root),
            end_radii: (1..=shaft.links).map(|end| shaft.radius_at(end as f64 / shaft.links as f64)).collect(),
            radii: (0..shaft.links).map(|link| shaft.link_radius(link)).collect(),
            stiffnesses,
        }
    }

    pub(super) fn links(&self) -> usize {
        self.stiffnesses.len()
    }

    /// Length (m).
    pub(super) fn length(&self) -> f64 {
        self.link * self.links() as f64
    }

    /// Radius (m) at the far end of a link.
    pub(super) fn end_radius(&self, link: usize) -> f64 {
        self.end_radii[link]
    }

    /// Radius (m) of a link.
    pub(super) fn radius(&self, link: usize) -> f64 {
        self.radii[link]
    }

    /// Angle of the hinge at the base in equilibrium (rad).
    pub(super) fn base_angle(&self, shape: &Shape) -> f64 {
        self.hinge_share * shape.angles[0]
    }
}

impl Shape {
    /// The straight chain.
    pub(super) fn straight(wire: &Wire, base: Pose) -> Self {
        let links = wire.links();
        let mut shape = Self {
            base,
            angles: vec![0.0; links],
            along: vec![Vector2::x(); links],
            facing: vec![0.0; links],
            ends: vec![base.position; links + 1],
        };
        shape.place(wire, base);
        shape
    }

    /// Puts the chain on a base, as it is bent.
    pub(super) fn place(&mut self, wire: &Wire, base: Pose) {
        self.base = base;
        let mut end = base.position;
        self.ends[0] = end;
        let links = self.angles.iter().zip(&mut self.along).zip(&mut self.facing);
        for (((angle, along), facing), place) in links.zip(&mut self.ends[1..]) {
            let aim = base.heading + angle;
            *along = turned(*along, aim - *facing).unwrap_or_else(|| unit(aim));
            *facing = aim;
            end += wire.link * *along;
            *place = end;
        }
    }

    /// Whether it is not bent at all.
    pub(super) fn is_straight(&self) -> bool {
        self.angles.iter().all(|&angle| angle == 0.0)
    }

    /// The direction to the left of a link, a unit vector.
    pub(super) fn left(&self, link: usize) -> Vector2 {
        perpendicular(self.along[link])
    }

    /// The box around it, without its thickness.
    pub(super) fn bounds(&self) -> BoundingBox {
        let bounds = BoundingBox::around(self.ends[0], self.ends[0]);
        self.ends.iter().fold(bounds, |bounds, &end| bounds.union(&BoundingBox::around(end, end)))
    }
}

/// A unit vector turned by a small angle (rad), by a few terms of the series of sine and cosine, which are exact to the last digit
/// below this angle; `None` above.
fn turned(vector: Vector2, angle: f64) -> Option<Vector2> {
    const SMALL: f64 = 1e-3;
    let square = angle * angle;
    let (sin, cos) = (angle * (1.0 - square / 6.0 * (1.0 - square / 20.0)), 1.0 - square / 2.0 * (1.0 - square / 12.0));
    // Rounding lets the length walk off by 1e-16 a turn, in a year of simulated time by 1e-11.
    (angle.abs() < SMALL).then(|| Vector2::new(cos * vector.x - sin * vector.y, sin * vector.x + cos * vector.y))
}
