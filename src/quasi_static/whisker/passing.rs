//! That whiskers go past things, and not through them.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use proptest::prelude::*;

use super::*;
use crate::geometry::{circle, polygon};
use crate::solid::Solid;
use vibrissa_runtime::rig::Rig;

/// Period (s) of samples.
const PERIOD: f64 = 1.0 / 300.0;
/// The nearest (m) that a base comes to anything.
const NEAR: f64 = 13e-3;

/// A thing with a corner, or something as small, at the origin.
#[derive(Debug, Clone, Copy)]
enum Thing {
    /// With so much (rad) between its sides.
    Wedge(f64),
    /// So thick (m).
    Blade(f64),
    /// With this radius (m).
    Pin(f64),
    /// With so much (rad) between its sides, outside of it.
    InnerCorner(f64),
}

impl Thing {
    /// The corners of its outline, if that is a polygon.
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

    /// Whether a whisker's axis goes through a side of it.
    fn is_crossed(self, follower: &Follower) -> bool {
        let corners = self.corners();
        let sides = || corners.iter().zip(corners.iter().cycle().skip(1));
        let side_of = |from: &Point2, to: &Point2, point: &Point2| (to - from).perp(&(point - from));
        let parts = |a: &Point2, b: &Point2, c: &Point2, d: &Point2| side_of(a, b, c) * side_of(a, b, d) < 0.0;
        let ends = ends(follower);
        ends.windows(2).any(|link| {
            sides().any(|(from, to)| parts(&link[0], &link[1], from, to) && parts(from, to, &link[0], &link[1]))
        })
    }
}

fn things() -> impl Strategy<Value = Thing> {
    prop_oneof![
        5 => (0.1..3.0_f64).prop_map(Thing::Wedge),
        2 => (2e-3..10e-3_f64).prop_map(Thing::Blade),
        1 => (0.5e-3..10e-3_f64).prop_map(Thing::Pin),
        1 => (0.3..2.6_f64).prop_map(Thing::InnerCorner),
    ]
}

/// The way of a base that moves and turns evenly.
#[derive(Debug, Clone)]
struct Way {
    /// At the time 0 (rad).
    heading: f64,
    /// Where (m) the tip would be then if the whisker were straight: near the origin.
    tip: Vector2,
    velocity: Vector2,
    yaw_rate: f64,
}

impl Way {
    /// The base at a time (s), of a whisker so long (m).
    fn at(&self, time: f64, length: f64) -> Pose {
        let position = Point2::from(self.tip - length * unit(self.heading) + time * self.velocity);
        Pose { position, heading: self.heading + time * self.yaw_rate }
    }
}

fn ways() -> impl Strategy<Value = Way> {
    (0.0..TAU, (0.0..4e-3_f64, 0.0..TAU), (0.02..0.1_f64, 0.0..TAU), -2.5..2.5_f64).prop_map(
        |(heading, (off, side), (speed, course), yaw_rate)| Way {
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

/// The base and the far ends of all links (m).
fn ends(follower: &Follower) -> Vec<Point2> {
    // Of a straight whisker in the air the links are not kept in their places.
    let mut shape = Shape::straight(&follower.wire, follower.shape.base);
    shape.angles.clone_from(&follower.shape.angles);
    shape.place(&follower.wire, follower.shape.base);
    shape.ends
}

/// How deep (m) in a solid the deepest of a whisker's axis is, of eight places a link.
fn depth(follower: &Follower, surfaces: &Surfaces) -> f64 {
    let ends = ends(follower);
    let places =
        ends.windows(2).flat_map(|ends| (1..=8).map(|step| ends[0] + f64::from(step) / 8.0 * (ends[1] - ends[0])));
    places.map(|place| surfaces.depth(place)).fold(f64::NEG_INFINITY, f64::max)
}

/// The last sample, from a second before on, at which the whisker, straight, stands clear of the thing. `None` if there is none, or if
/// the base comes too near after that.
fn beginning(way: &Way, whisker: &Whisker, surfaces: &Surfaces) -> Option<i32> {
    let is_clear = |&sample: &i32| {
        let follower = Follower::new(whisker, way.at(f64::from(sample) * PERIOD, whisker.shaft.length));
        depth(&follower, surfaces) < -2e-3
    };
    let first = (-300..=0).rev().find(is_clear)?;
    let base = |sample: i32| way.at(f64::from(sample) * PERIOD, whisker.shaft.length).position;
    (first..=0).all(|sample| surfaces.depth(base(sample)) < -NEAR).then_some(first)
}

/// A thing, a way past it, and since when the whisker is on that.
fn passes() -> impl Strategy<Value = (Thing, Way, i32)> {
    (things(), ways()).prop_filter_map("does not begin clear of the thing", |(thing, way)| {
        let beginning = beginning(&way, &whisker(), &thing.surfaces())?;
        Some((thing, way, beginning))
    })
}

/// Lets a whisker go past a thing; whether it touched that. The base comes no nearer than two links, for so near it the whisker cannot
/// give way.
fn pass(thing: Thing, way: &Way, beginning: i32) -> Result<bool, String> {
    let (whisker, surfaces) = (whisker(), thing.surfaces());
    let place = |sample: i32| way.at(f64::from(sample) * PERIOD, whisker.shaft.length);
    let mut follower = Follower::new(&whisker, place(beginning));
    let mut touched = false;
    for base in (beginning..200).map(place).take_while(|base| surfaces.depth(base.position) < -NEAR) {
        if let Err(lost) = follower.follow(base, PERIOD, &surfaces, 3e-3) {
            return Err(format!("{lost:?} at {base:?}"));
        }
        touched |= follower.force != Vector2::zeros();
        let (depth, is_at_rest) = (depth(&follower, &surfaces), follower.restless == 0);
        // On its way from one equilibrium to the next it may be in something by about its thickness.
        let most = if is_at_rest { -0.9 * whisker.shaft.radius } else { 3e-4 };
        if depth > most || is_at_rest && thing.is_crossed(&follower) {
            return Err(format!("{depth} m inside at {base:?}"));
        }
    }
    Ok(touched)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1_000))]

    #[test]
    fn no_whisker_passes_through_a_thing((thing, way, beginning) in passes()) {
        let passed = pass(thing, &way, beginning);
        prop_assert!(passed.is_ok(), "{}", passed.unwrap_err());
    }
}

/// Ways that chance found, each when something was not kept in mind.
#[test]
fn nor_does_one_that_did() {
    let way = |heading, tip: [f64; 2], velocity: [f64; 2], yaw_rate| Way {
        heading,
        tip: tip.into(),
        velocity: velocity.into(),
        yaw_rate,
    };
    let ways = [
        // On which side a corner is when the end has come off a facet over it.
        (Thing::Wedge(1.738), way(0.7568, [0.1327e-3, 1.107e-3], [0.083_54, 0.046_80], -2.144), -4),
        (Thing::Blade(2e-3), way(5.693, [0.9993e-3, 0.2149e-3], [0.074_55, -0.059_94], -2.425), -5),
        // That, from one survey to the next.
        (Thing::Wedge(2.914), way(0.5542, [-0.2956e-3, 0.1887e-3], [0.057_12, 0.032_85], 1.206), -5),
        // On which side of a facet an end is that is not yet beside it.
        (Thing::Wedge(2.904), way(2.286, [0.12e-3, 0.0], [0.011_74, 0.016_19], -2.202), -4),
        // The facet on which an end bears.
        (Thing::InnerCorner(0.405_107_8), way(4.343_851, [2.894_060e-3, 0.0], [0.02, 0.0], -1.592_759), -280),
        // The next corner, sharp or blunt.
        (Thing::Wedge(0.1), way(2.85, [0.039_35e-3, 0.0], [-0.016_64, 0.057_24], -0.6925), -5),
        (Thing::Wedge(2.959_426), way(1.508_286, [0.1049e-3, 0.1840e-3], [0.046_74, 0.076_66], -2.479_81), -6),
    ];
    for (thing, way, beginning) in ways {
        assert_eq!(pass(thing, &way, beginning), Ok(true), "{thing:?} {way:?}");
    }
}
