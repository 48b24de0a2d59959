//! The rod discretisation of a whisker's shaft: a planar chain of links.

use crate::geometry::{BoundingBox, Point2, Pose, Vector2, perpendicular, unit};
use vibrissa_runtime::rig::Whisker;

/// The constant properties of the chain. MuJoCo's model and the contact estimators use the same links and springs.
#[derive(Debug)]
pub(super) struct Rod {
    /// Length of a link (m).
    pub(super) link: f64,
    /// Joint stiffnesses (N m/rad). The first combines the base hinge and the root of the shaft in series.
    pub(super) stiffnesses: Vec<f64>,
    /// The diagonal of the Hessian of the spring energy, followed by its off-diagonal (N m).
    pub(super) diagonal: Vec<f64>,
    pub(super) off_diagonal: Vec<f64>,
    /// The share of the base hinge in the angle of the first link.
    pub(super) hinge_share: f64,
    /// Radius (m) at the far end of every link.
    end_radii: Vec<f64>,
    /// Mean radius (m) of every link.
    radii: Vec<f64>,
    /// Directions of the links at rest, relative to the direction of the base (rad).
    rest: Vec<f64>,
}

/// The configuration of a chain.
#[derive(Debug)]
pub(super) struct Shape {
    /// The pose of the base, with the direction of the undeflected shaft at its base as heading.
    pub(super) base: Pose,
    /// Rotations of the links from their directions at rest (rad).
    pub(super) angles: Vec<f64>,
    /// Directions of the links in the world frame, as unit vectors, followed by their angles (rad).
    pub(super) tangents: Vec<Vector2>,
    world_angles: Vec<f64>,
    /// The base and the far ends of all links (m, world frame).
    pub(super) ends: Vec<Point2>,
}

impl Rod {
    pub(super) fn new(whisker: &Whisker) -> Self {
        let (shaft, hinge) = (&whisker.shaft, whisker.hinge.stiffness);
        let mut stiffnesses: Vec<f64> = shaft.joint_stiffnesses().collect();
        let root = stiffnesses[0];
        stiffnesses[0] = hinge * root / (hinge + root);
        let behind = stiffnesses[1..].iter().copied().chain([0.0]);
        Self {
            diagonal: stiffnesses.iter().zip(behind).map(|(stiffness, behind)| stiffness + behind).collect(),
            off_diagonal: stiffnesses[1..].iter().map(|stiffness| -stiffness).collect(),
            link: shaft.link_length(),
            hinge_share: root / (hinge + root),
            end_radii: (1..=shaft.links).map(|end| shaft.radius_at(end as f64 / shaft.links as f64)).collect(),
            radii: (0..shaft.links).map(|link| shaft.link_radius(link)).collect(),
            rest: shaft
                .rest_angles()
                .scan(0.0, |direction, turn| {
                    *direction += turn;
                    Some(*direction)
                })
                .collect(),
            stiffnesses,
        }
    }

    pub(super) fn links(&self) -> usize {
        self.stiffnesses.len()
    }

    /// Length of the shaft (m).
    pub(super) fn length(&self) -> f64 {
        self.link * self.links() as f64
    }

    /// Radius (m) at the far end of a link.
    pub(super) fn end_radius(&self, link: usize) -> f64 {
        self.end_radii[link]
    }

    /// Mean radius (m) of a link.
    pub(super) fn radius(&self, link: usize) -> f64 {
        self.radii[link]
    }

    /// The far ends of the links (m, world frame) in a shape, also if its [ends](Shape::ends) are not updated.
    pub(super) fn ends(&self, shape: &Shape) -> impl Iterator<Item = Point2> {
        let directions = shape.angles.iter().zip(&self.rest).map(|(angle, rest)| shape.base.heading + rest + angle);
        directions.scan(Vector2::zeros(), |sum, direction| {
            *sum += unit(direction);
            Some(shape.base.position + self.link * *sum)
        })
    }

    /// Angle of the base hinge in equilibrium (rad).
    pub(super) fn base_angle(&self, shape: &Shape) -> f64 {
        self.hinge_share * shape.angles[0]
    }
}

impl Shape {
    /// Creates a chain at rest.
    pub(super) fn at_rest(rod: &Rod, base: Pose) -> Self {
        let links = rod.links();
        let mut shape = Self {
            base,
            angles: vec![0.0; links],
            tangents: vec![Vector2::x(); links],
            world_angles: vec![0.0; links],
            ends: vec![base.position; links + 1],
        };
        shape.place(rod, base);
        shape
    }

    /// Moves the chain to another base without a change of its angles.
    pub(super) fn place(&mut self, rod: &Rod, base: Pose) {
        self.base = base;
        let mut end = base.position;
        self.ends[0] = end;
        let links = self.angles.iter().zip(&rod.rest).zip(&mut self.tangents).zip(&mut self.world_angles);
        for ((((angle, rest), tangent), previous_angle), place) in links.zip(&mut self.ends[1..]) {
            let world_angle = base.heading + rest + angle;
            *tangent =
                rotated_by_small_angle(*tangent, world_angle - *previous_angle).unwrap_or_else(|| unit(world_angle));
            *previous_angle = world_angle;
            end += rod.link * *tangent;
            *place = end;
        }
    }

    /// True if no link is rotated.
    pub(super) fn is_at_rest(&self) -> bool {
        self.angles.iter().all(|&angle| angle == 0.0)
    }

    /// The left normal of a link, a unit vector in the world frame.
    pub(super) fn left(&self, link: usize) -> Vector2 {
        perpendicular(self.tangents[link])
    }

    /// The direction of a link (rad, world frame).
    pub(super) fn world_angle(&self, link: usize) -> f64 {
        self.world_angles[link]
    }

    /// The bounding box of the axis of a link.
    pub(super) fn bounds_of(&self, link: usize) -> BoundingBox {
        BoundingBox::around(self.ends[link], self.ends[link + 1])
    }

    /// The bounding box of the axis, without the thickness of the shaft.
    pub(super) fn bounds(&self) -> BoundingBox {
        let bounds = BoundingBox::around(self.ends[0], self.ends[0]);
        self.ends.iter().fold(bounds, |bounds, &end| bounds.union(&BoundingBox::around(end, end)))
    }
}

/// Rotates a unit vector by a small angle (rad). Truncated series of sine and cosine are exact to the last digit in
/// this range. Returns `None` for larger angles.
fn rotated_by_small_angle(vector: Vector2, angle: f64) -> Option<Vector2> {
    const SMALL: f64 = 1e-3;
    let square = angle * angle;
    let (sin, cos) = (angle * (1.0 - square / 6.0 * (1.0 - square / 20.0)), 1.0 - square / 2.0 * (1.0 - square / 12.0));
    // Rounding changes the length by 1e-16 per rotation, or by 1e-11 in a year of simulated time.
    (angle.abs() < SMALL).then(|| Vector2::new(cos * vector.x - sin * vector.y, sin * vector.x + cos * vector.y))
}
