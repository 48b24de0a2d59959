//! A small exact world of its own: static disks and convex polygons, a body, and whiskers that are statically bent.
//!
//! It shares no code with the map. A shaft remains on one side of an object until its tip slips around it. It reads the
//! *least* base angle of a shaft that is displaced to this side: that of a load at the tip, which displaces a shaft most.
//! A tip that is stopped head-on yields to either side. So no real contact is harder to notice.

use vibrissa_runtime::geometry::{Point2, Pose, Vector2, unit};
use vibrissa_runtime::rig::{Rig, Whisker};
use vibrissa_runtime::signal::{Command, MAX_WHISKERS, Reading, Sample};

/// A linear congruential generator (Knuth, The Art of Computer Programming 2, 3.3.4).
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        let mut random = Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15));
        for _ in 0..4 {
            random.within(0.0, 1.0);
        }
        random
    }

    pub(crate) fn within(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * f64::from((self.0 >> 32) as u32) / f64::from(u32::MAX)
    }

    pub(crate) fn below(&mut self, count: usize) -> usize {
        (self.within(0.0, count as f64) as usize).min(count - 1)
    }

    /// A normal number, as the sum of twelve uniform ones.
    pub(crate) fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.within(-0.5, 0.5)).sum()
    }
}

#[derive(Debug, Clone)]
pub(crate) enum Object {
    Disk(Point2, f64),
    /// Counter-clockwise.
    Polygon(Vec<Point2>),
}

impl Object {
    pub(crate) fn random(random: &mut Random, centre: Point2) -> Self {
        // Poles of 1 mm and walls that are longer than the array.
        let size = 10.0_f64.powf(random.within(-3.0, -0.8));
        if random.below(2) == 0 {
            return Self::Disk(centre, size);
        }
        let (count, start, flat) = (3 + random.below(4), random.within(0.0, 6.3), random.within(0.05, 1.0));
        let turn = random.within(0.0, 6.3);
        let corner = |index: usize| {
            let on_circle = unit(start + std::f64::consts::TAU * index as f64 / count as f64) * size;
            let (sin, cos) = turn.sin_cos();
            let (x, y) = (on_circle.x, on_circle.y * flat);
            centre + Vector2::new(cos * x - sin * y, sin * x + cos * y)
        };
        Self::Polygon((0..count).map(corner).collect())
    }

    /// Distance (m) of a point inside from the surface, negative outside. Outside of a polygon it is a bound.
    pub(crate) fn depth(&self, point: Point2) -> f64 {
        match self {
            Self::Disk(centre, radius) => radius - (point - centre).norm(),
            Self::Polygon(corners) => {
                edges(corners).map(|(a, b)| (b - a).normalize().perp(&(point - a))).fold(f64::INFINITY, f64::min)
            }
        }
    }

    /// The object in the frame of a base pose.
    fn in_frame(&self, base: Pose) -> Self {
        match self {
            Self::Disk(centre, radius) => Self::Disk(base.point_from_world(*centre), *radius),
            Self::Polygon(corners) => {
                Self::Polygon(corners.iter().map(|corner| base.point_from_world(*corner)).collect())
            }
        }
    }

    /// Range of x in which the line `y = 0` is inside.
    fn overlap(&self) -> Option<(f64, f64)> {
        match self {
            Self::Disk(centre, radius) => {
                let half = (radius * radius - centre.y * centre.y).sqrt();
                half.is_finite().then_some((centre.x - half, centre.x + half))
            }
            Self::Polygon(corners) => {
                let crossings = edges(corners).filter(|(a, b)| a.y * b.y <= 0.0 && (a.y - b.y).abs() > 0.0);
                let (low, high) = crossings
                    .map(|(a, b)| a.x - a.y * (b.x - a.x) / (b.y - a.y))
                    .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
                (low <= high).then_some((low, high))
            }
        }
    }

    /// Range of x.
    fn range(&self) -> (f64, f64) {
        match self {
            Self::Disk(centre, radius) => (centre.x - radius, centre.x + radius),
            Self::Polygon(corners) => corners.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), corner| {
                (low.min(corner.x), high.max(corner.x))
            }),
        }
    }

    /// Values of x at which the boundary has corners.
    fn corners(&self) -> impl Iterator<Item = f64> + '_ {
        let corners: &[Point2] = if let Self::Polygon(corners) = self { corners } else { &[] };
        corners.iter().map(|corner| corner.x)
    }

    /// Range of y at x.
    fn range_at(&self, x: f64) -> Option<(f64, f64)> {
        match self {
            Self::Disk(centre, radius) => {
                let half = (radius * radius - (x - centre.x).powi(2)).sqrt();
                half.is_finite().then_some((centre.y - half, centre.y + half))
            }
            Self::Polygon(corners) => {
                let crossings = edges(corners).filter(|(a, b)| (a.x - x) * (b.x - x) <= 0.0 && (a.x - b.x).abs() > 0.0);
                let (low, high) = crossings
                    .map(|(a, b)| a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x))
                    .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y)));
                (low <= high).then_some((low, high))
            }
        }
    }

    /// True if a convex polygon overlaps the object.
    pub(crate) fn overlaps(&self, body: &[Point2]) -> bool {
        match self {
            Self::Disk(centre, radius) => {
                let inside = edges(body).all(|(a, b)| (b - a).perp(&(centre - a)) >= 0.0);
                inside || edges(body).any(|(a, b)| distance(*centre, a, b) < *radius)
            }
            Self::Polygon(corners) => {
                let separates =
                    |(a, b): (Point2, Point2), of: &[Point2]| of.iter().all(|p| (b - a).perp(&(p - a)) < 0.0);
                !edges(body).any(|edge| separates(edge, corners)) && !edges(corners).any(|edge| separates(edge, body))
            }
        }
    }
}

fn edges(corners: &[Point2]) -> impl Iterator<Item = (Point2, Point2)> {
    (0..corners.len()).map(|index| (corners[index], corners[(index + 1) % corners.len()]))
}

fn distance(point: Point2, a: Point2, b: Point2) -> f64 {
    let along = b - a;
    let share = ((point - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
    (point - (a + share * along)).norm()
}

/// Positions of an object at which the displacement is looked at. Fewer of them only reduce base angles.
const PLACES: usize = 12;
/// Share of the square of the displacement of a tip over the length by which the shaft is shorter.
const SHORTENING: f64 = 0.6;

/// A whisker among objects.
pub(crate) struct Bent {
    length: f64,
    /// Base moment (N m/rad) and bending stiffness (N m²).
    hinge: f64,
    stiffness: f64,
    /// For each object: true if it is to the left of the shaft. `None` out of reach.
    is_left: Vec<Option<bool>>,
}

impl Bent {
    /// The displacement (m) at `s` by a load at the tip, for a base angle of 1 rad.
    fn displacement(&self, s: f64) -> f64 {
        s + self.hinge * (3.0 * s * s - s * s * s / self.length) / (6.0 * self.stiffness)
    }

    /// The base angle (rad) that a tip with this overlap (m) has at least.
    fn head_on(&self, overlap: f64) -> f64 {
        (overlap.max(0.0) * self.length / SHORTENING).sqrt() / self.displacement(self.length)
    }

    /// The least base angle (rad) of the whisker with this base pose.
    fn base_angle(&mut self, objects: &[Object], base: Pose) -> f64 {
        let mut most = 0.0_f64;
        for (index, object) in objects.iter().enumerate() {
            let signed = self.by_one(&object.in_frame(base), index);
            if signed.abs() > most.abs() {
                most = signed;
            }
        }
        most.clamp(-0.01, 0.01)
    }

    /// The base angle by one object, in the frame of the base.
    fn by_one(&mut self, local: &Object, index: usize) -> f64 {
        let (near, far) = local.range();
        if far <= 0.0 || near >= self.length {
            self.is_left[index] = None;
            return 0.0;
        }
        let (low, high) = (near.max(0.0), far.min(self.length));
        // Base angles of a shaft that passes on the left, and on the right.
        let (mut left, mut right) = (0.0_f64, 0.0_f64);
        let places = (0..=PLACES).map(|place| low + (high - low) * place as f64 / PLACES as f64);
        let overlap =
            local.overlap().map(|(from, to)| (from.max(0.0), to.min(self.length))).filter(|(from, to)| from < to);
        let within = overlap
            .into_iter()
            .flat_map(|(from, to)| (0..=PLACES).map(move |place| from + (to - from) * place as f64 / PLACES as f64));
        for s in places.chain(within).chain(local.corners().filter(|s| (low..high).contains(s))) {
            let Some((below, above)) = local.range_at(s) else { continue };
            left = left.max(above / self.displacement(s).max(1e-9));
            right = right.max(-below / self.displacement(s).max(1e-9));
        }
        let is_left = self.is_left[index].unwrap_or(right <= left);
        let needed = if is_left { right } else { left };
        if overlap.is_none() && needed > self.head_on(self.length - near) {
            // The tip has slipped around it.
            self.is_left[index] = Some(!is_left);
            return 0.0;
        }
        self.is_left[index] = Some(is_left);
        let least = overlap.map_or(needed, |(from, _)| needed.min(self.head_on(self.length - from)));
        if is_left { -least } else { least }
    }
}

/// A robot in a world.
pub(crate) struct World {
    pub(crate) rig: Rig,
    pub(crate) objects: Vec<Object>,
    pub(crate) pose: Pose,
    pub(crate) time: f64,
    pub(crate) random: Random,
    /// Errors of measured poses (m, rad) are uniform within these bounds, and constant during a run.
    pub(crate) pose_error: Pose,
    bent: Vec<Bent>,
    moving: Command,
}

impl World {
    pub(crate) fn new(rig: &Rig, objects: Vec<Object>, pose: Pose, seed: u64) -> Self {
        let bent = |whisker: &Whisker| Bent {
            length: whisker.shaft.length,
            hinge: whisker.hinge.stiffness,
            stiffness: whisker.shaft.bending_stiffness(),
            is_left: vec![None; objects.len()],
        };
        let bent = rig.whiskers.iter().map(bent).collect();
        let random = Random::new(seed + 1_000_000);
        Self {
            rig: rig.clone(),
            objects,
            pose,
            time: 0.0,
            random,
            pose_error: Pose::default(),
            bent,
            moving: Command::STOP,
        }
    }

    /// Samples in a control period.
    const SAMPLES: usize = 10;

    pub(crate) fn outline(&self, pose: Pose) -> [Point2; 4] {
        self.rig.platform.outline_body().map(|corner| pose.point_to_world(corner))
    }

    pub(crate) fn is_clear(&self, pose: Pose) -> bool {
        let outline = self.outline(pose);
        !self.objects.iter().any(|object| object.overlaps(&outline))
    }

    /// The samples of one control period. A body that would touch stands still.
    pub(crate) fn advance(&mut self, command: Command) -> Vec<Sample> {
        let step = self.rig.sensing.sample_rate.recip();
        (0..Self::SAMPLES)
            .map(|_| {
                self.time += step;
                // Servos follow with a lag.
                let share = step / self.rig.platform.servo;
                self.moving.velocity_world += (command.velocity_world - self.moving.velocity_world) * share;
                self.moving.yaw_rate += (command.yaw_rate - self.moving.yaw_rate) * share;
                let next = Pose {
                    position: self.pose.position + self.moving.velocity_world * step,
                    heading: self.pose.heading + self.moving.yaw_rate * step,
                };
                if self.is_clear(next) {
                    self.pose = next;
                } else {
                    self.moving = Command::STOP;
                }
                let mut whiskers = [Reading::default(); MAX_WHISKERS];
                for ((reading, whisker), bent) in whiskers.iter_mut().zip(&self.rig.whiskers).zip(&mut self.bent) {
                    let base = Pose {
                        position: self.pose.point_to_world(whisker.base_body),
                        heading: self.pose.heading + whisker.direction_body,
                    };
                    reading.base_angle =
                        bent.base_angle(&self.objects, base) + self.rig.sensing.angle_noise * self.random.normal();
                }
                let body = Pose {
                    position: self.pose.position + self.pose_error.position.coords,
                    heading: self.pose.heading + self.pose_error.heading,
                };
                Sample { time: self.time, body, whiskers }
            })
            .collect()
    }
}
