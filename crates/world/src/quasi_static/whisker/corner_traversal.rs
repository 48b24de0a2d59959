//! Tests of whiskers that traverse corners: no whisker passes through an obstacle.
//!
//! Why: docs/decisions/quasi-static.md#corner-traversal-remembers-the-side-of-a-shaft.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use proptest::prelude::*;

use super::*;
use crate::geometry::{circle, polygon, regular_polygon, unit};
use crate::solid::Solid;
use vibrissa_runtime::rig::Rig;

/// The sample period (s).
const PERIOD: f64 = 1.0 / 300.0;
/// The smallest distance (m) between the base and the obstacle.
const NEAR: f64 = 13e-3;

/// An obstacle with a corner, or a small obstacle, at the origin.
#[derive(Debug, Clone, Copy)]
enum Obstacle {
    /// A wedge with this interior angle (rad).
    Wedge(f64),
    /// A blade of this thickness (m).
    Blade(f64),
    /// A cylinder of this radius (m).
    Pin(f64),
    /// A concave corner with this exterior angle (rad).
    InnerCorner(f64),
}

impl Obstacle {
    /// The corners of the outline, empty for a circle.
    fn corners(self) -> Vec<Point2> {
        let at = |radius: f64, angle: f64| Point2::from(radius * unit(angle));
        match self {
            Self::Wedge(inside) => vec![Point2::origin(), at(0.4, 0.0), at(0.4, inside)],
            Self::Blade(thickness) => {
                let [along, across] = [at(0.3, 0.0).coords, at(thickness, FRAC_PI_2).coords];
                [Vector2::zeros(), along, along + across, across].map(Point2::from).to_vec()
            }
            Self::Pin(_) => Vec::new(),
            Self::InnerCorner(outside) => {
                vec![Point2::origin(), at(0.12, outside), at(0.3, 0.5 * outside + PI), at(0.12, 0.0)]
            }
        }
    }

    fn surfaces(self) -> Surfaces {
        let outline = match self {
            Self::Pin(radius) => circle(Point2::origin(), radius),
            _ => polygon(&self.corners()),
        };
        Surfaces::new(&[Solid::inside(outline.unwrap()).unwrap()])
    }

    /// True if the axis of a whisker intersects a side of the obstacle.
    fn is_crossed(self, chain: &QuasiStaticWhisker) -> bool {
        let corners = self.corners();
        let sides = || corners.iter().zip(corners.iter().cycle().skip(1));
        let side_of = |from: &Point2, to: &Point2, point: &Point2| (to - from).perp(&(point - from));
        let parts = |a: &Point2, b: &Point2, c: &Point2, d: &Point2| side_of(a, b, c) * side_of(a, b, d) < 0.0;
        let ends = ends(chain);
        ends.windows(2).any(|link| {
            sides().any(|(from, to)| parts(&link[0], &link[1], from, to) && parts(from, to, &link[0], &link[1]))
        })
    }
}

fn obstacles() -> impl Strategy<Value = Obstacle> {
    prop_oneof![
        5 => (0.1..3.0_f64).prop_map(Obstacle::Wedge),
        2 => (3.0..PI - 1e-3).prop_map(Obstacle::Wedge),
        2 => (2e-3..10e-3_f64).prop_map(Obstacle::Blade),
        1 => (0.5e-3..10e-3_f64).prop_map(Obstacle::Pin),
        1 => (0.3..2.6_f64).prop_map(Obstacle::InnerCorner),
    ]
}

/// The path of a base with constant velocity and yaw rate.
#[derive(Debug, Clone)]
struct BasePath {
    /// The heading at time 0 (rad).
    heading: f64,
    /// The position (m) of the undeflected tip at time 0, near the origin.
    tip: Vector2,
    velocity: Vector2,
    yaw_rate: f64,
}

impl BasePath {
    /// The pose of the base at a time (s), for a whisker of this length (m).
    fn at(&self, time: f64, length: f64) -> Pose {
        let position = Point2::from(self.tip - length * unit(self.heading) + time * self.velocity);
        Pose { position, heading: self.heading + time * self.yaw_rate }
    }
}

fn paths() -> impl Strategy<Value = BasePath> {
    (0.0..TAU, (0.0..4e-3_f64, 0.0..TAU), (0.02..0.1_f64, 0.0..TAU), -2.5..2.5_f64).prop_map(
        |(heading, (off, side), (speed, course), yaw_rate)| BasePath {
            heading,
            tip: off * unit(side),
            velocity: speed * unit(course),
            yaw_rate,
        },
    )
}

fn whisker() -> Whisker {
    Rig::default().whiskers.swap_remove(0)
}

/// The base and the far ends of all links (m, world frame).
fn ends(chain: &QuasiStaticWhisker) -> Vec<Point2> {
    // The link ends of a whisker at rest are not updated.
    let mut shape = Shape::at_rest(&chain.rod, chain.shape.base);
    shape.angles.clone_from(&chain.shape.angles);
    shape.place(&chain.rod, chain.shape.base);
    shape.ends
}

/// The largest penetration depth (m) of a whisker's axis, from eight points per link.
fn depth(chain: &QuasiStaticWhisker, surfaces: &Surfaces) -> f64 {
    let ends = ends(chain);
    let places =
        ends.windows(2).flat_map(|ends| (1..=8).map(|step| ends[0] + f64::from(step) / 8.0 * (ends[1] - ends[0])));
    places.map(|place| surfaces.depth(place)).fold(f64::NEG_INFINITY, f64::max)
}

/// The last sample, at most one second before time 0, at which the undeflected whisker is clear of the obstacle. `None`
/// if there is none, or if the base later comes too near.
fn beginning(path: &BasePath, whisker: &Whisker, surfaces: &Surfaces) -> Option<i32> {
    let is_clear = |&sample: &i32| {
        let chain = QuasiStaticWhisker::new(whisker, 0.0, path.at(f64::from(sample) * PERIOD, whisker.shaft.length));
        depth(&chain, surfaces) < -2e-3
    };
    let first = (-300..=0).rev().find(is_clear)?;
    let base = |sample: i32| path.at(f64::from(sample) * PERIOD, whisker.shaft.length).position;
    (first..=0).all(|sample| surfaces.depth(base(sample)) < -NEAR).then_some(first)
}

/// An obstacle, a path, and the sample at which the path begins.
fn passes() -> impl Strategy<Value = (Obstacle, BasePath, i32)> {
    (obstacles(), paths()).prop_filter_map("does not begin clear of the obstacle", |(obstacle, path)| {
        let beginning = beginning(&path, &whisker(), &obstacle.surfaces())?;
        Some((obstacle, path, beginning))
    })
}

/// Moves a whisker along a path. Returns true if it touched the obstacle. The path ends before the base comes nearer
/// than two links, because the whisker cannot bend there.
fn pass(obstacle: Obstacle, path: &BasePath, beginning: i32) -> Result<bool, String> {
    let (whisker, surfaces) = (whisker(), obstacle.surfaces());
    let place = |sample: i32| path.at(f64::from(sample) * PERIOD, whisker.shaft.length);
    let mut chain = QuasiStaticWhisker::new(&whisker, 0.0, place(beginning));
    let mut touched = false;
    for base in (beginning..200).map(place).take_while(|base| surfaces.depth(base.position) < -NEAR) {
        if let Err(error) = chain.follow(base, PERIOD, &surfaces, 3e-3) {
            return Err(format!("{error:?} at {base:?}"));
        }
        touched |= chain.force != Vector2::zeros();
        let (depth, is_at_rest) = (depth(&chain, &surfaces), chain.unsettled_samples == 0);
        // Between two equilibria, the whisker may penetrate by about its thickness.
        let most = if is_at_rest { -0.9 * whisker.shaft.radius } else { 3e-4 };
        if depth > most || is_at_rest && obstacle.is_crossed(&chain) {
            return Err(format!("{depth} m inside at {base:?}"));
        }
    }
    Ok(touched)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1_000))]

    #[test]
    fn no_whisker_passes_through_a_thing((obstacle, path, beginning) in passes()) {
        let passed = pass(obstacle, &path, beginning);
        prop_assert!(passed.is_ok(), "{}", passed.unwrap_err());
    }
}

/// Paths that proptest found. Each failed before a part of the contact state was kept.
#[test]
fn nor_does_one_that_did() {
    let path = |heading, tip: [f64; 2], velocity: [f64; 2], yaw_rate| BasePath {
        heading,
        tip: tip.into(),
        velocity: velocity.into(),
        yaw_rate,
    };
    let paths = [
        // The side of a corner after the end has moved from a facet over it.
        (Obstacle::Wedge(1.738), path(0.7568, [0.1327e-3, 1.107e-3], [0.083_54, 0.046_80], -2.144), -4),
        (Obstacle::Blade(2e-3), path(5.693, [0.9993e-3, 0.2149e-3], [0.074_55, -0.059_94], -2.425), -5),
        // The same, kept through the broad phase.
        (Obstacle::Wedge(2.914), path(0.5542, [-0.2956e-3, 0.1887e-3], [0.057_12, 0.032_85], 1.206), -5),
        // The side of a facet on which an end is before it faces the facet.
        (Obstacle::Wedge(2.904), path(2.286, [0.12e-3, 0.0], [0.011_74, 0.016_19], -2.202), -4),
        // The facet on which an end exerts a force.
        (Obstacle::InnerCorner(0.405_107_8), path(4.343_851, [2.894_060e-3, 0.0], [0.02, 0.0], -1.592_759), -280),
        // The next corner, sharp or blunt.
        (Obstacle::Wedge(0.1), path(2.85, [0.039_35e-3, 0.0], [-0.016_64, 0.057_24], -0.6925), -5),
        (Obstacle::Wedge(2.959_426), path(1.508_286, [0.1049e-3, 0.1840e-3], [0.046_74, 0.076_66], -2.479_81), -6),
    ];
    for (obstacle, path, beginning) in paths {
        assert_eq!(pass(obstacle, &path, beginning), Ok(true), "{obstacle:?} {path:?}");
    }
}

/// A whisker that meets a polygon steeply, and is swept over a blunt corner by the rotation of the platform.
#[test]
fn a_steep_whisker_passes_a_blunt_corner_without_a_sample_off_balance() {
    let rig = Rig::default();
    let whisker = &rig.whiskers[0];
    for sides in [60, 72, 80, 100, 150, 300] {
        let outline = regular_polygon(Point2::new(0.4, 0.4), 0.3, sides, 0.0).unwrap();
        let surfaces = Surfaces::new(&[Solid::inside(outline).unwrap()]);
        let base = |sample: u32| {
            let body = Pose {
                position: Point2::new(0.0, 0.2677),
                heading: 115_f64.to_radians() - FRAC_PI_2 * f64::from(sample) * PERIOD,
            };
            Pose { position: body.point_to_world(whisker.base_body), heading: body.heading + whisker.direction_body }
        };
        let mut chain = QuasiStaticWhisker::new(whisker, 0.0, base(0));
        for sample in 1..60 {
            let followed = chain.follow(base(sample), PERIOD, &surfaces, 1e-3);
            assert_eq!((followed, chain.unsettled_samples), (Ok(()), 0), "{sides} sides, sample {sample}");
        }
        assert!(chain.force != Vector2::zeros());
    }
}
