//! A whisker does not feel the seams between the parts of a wall: dragged along many of them, its tip is where it is on the
//! exact wall.

use std::f64::consts::{FRAC_PI_2, PI};

use vibrissa::geometry::{Contour, Path, Point2, Pose, Side, Strip, Vector2, rotate, unit};
use vibrissa::mujoco::MujocoWorld;
use vibrissa::physics::Physics;
use vibrissa::solid::Solid;
use vibrissa::world::World;
use vibrissa_runtime::mechanics::ShaftChain;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{Command, Sample};

/// How far (m) the tip may be from where it would be on the exact wall, judged by the base angle: the tip itself stays within a
/// fifth of this, but the angle also feels how the force on the tip turns.
const TOLERANCE: f64 = 1e-4;

/// How deep (m) the tip of a whisker sinks into a wall at these deflections, a single solid or many.
const DEPTH: f64 = 4.7e-5;

/// How far (m) the platform's middle is from the wall that it goes along: the unbent right whisker reaches 127 mm.
const ASIDE: f64 = 0.102;

/// How far (m) it goes until it is there.
const APPROACH: f64 = 0.3;

/// How far it is from the wall at a distance (m) along: it begins clear of it.
fn aside(along: f64) -> f64 {
    ASIDE + 0.02 * (1.0 + (PI * (along / APPROACH).min(1.0)).cos())
}

/// Samples of a platform that goes along a line (its right whisker to the wall) at 50 mm/s: its pose at a distance along.
fn drag(wall: &[Solid], length: f64, pose: impl Fn(f64) -> Pose) -> Vec<Sample> {
    let mut rig = Rig::default();
    rig.whiskers.truncate(1);
    // Servos that hardly lag, so that the way is the one that is asked for.
    rig.platform.servo = 0.01;
    let mut world = MujocoWorld::new(&rig, &Physics::default(), wall, pose(0.0), 0).unwrap();
    let period = 1.0 / rig.sensing.control_rate;
    let mut samples = Vec::new();
    let ticks = (length / 0.05 / period).floor();
    let mut tick = 0.0;
    while tick < ticks {
        let (now, next) = (pose(0.05 * period * tick), pose(0.05 * period * (tick + 1.0)));
        let velocity_world = (next.position - now.position) / period;
        let command = Command { velocity_world, yaw_rate: (next.heading - now.heading) / period };
        samples.extend_from_slice(world.advance(&command).unwrap());
        tick += 1.0;
    }
    samples
}

/// The greatest distance of the tip from where it would touch the exact `face` with the base angle and pose of a sample.
fn greatest_error(samples: &[Sample], face: &Contour) -> f64 {
    let rig = Rig::default();
    let whisker = &rig.whiskers[0];
    let chain = ShaftChain::new(whisker);
    let error = |sample: &Sample| {
        let angle = sample.whiskers[0].base_angle;
        let base = sample.body.point_to_world(whisker.base_body);
        let shaft = sample.body.heading + whisker.direction_body;
        let mirror = |vector: Vector2| if angle < 0.0 { Vector2::new(vector.x, -vector.y) } else { vector };
        // The force is square to the face where the tip is, which depends on the force.
        let mut tip = base + 0.09 * unit(shaft);
        for _ in 0..8 {
            let nearest = face.nearest(tip);
            let away = Vector2::new(-nearest.tangent.y, nearest.tangent.x);
            let away = away * away.dot(&(base - nearest.point)).signum();
            let force = mirror(rotate(away, -shaft));
            let mut found = chain.at_rest();
            for share in 1..=10 {
                let share = f64::from(share) / 10.0;
                found.force = found.force.max(1e-4 * share);
                found = chain.solve(share * angle.abs(), force.y.atan2(force.x), &found).unwrap();
            }
            tip = base + rotate(mirror(found.tip_base), shaft);
        }
        (face.nearest(tip).distance - (whisker.shaft.radius - DEPTH)).abs()
    };
    samples.iter().map(error).fold(0.0, f64::max)
}

/// The samples of a drag once the platform goes along the wall.
fn settled(samples: &[Sample]) -> &[Sample] {
    &samples[samples.len() / 2..]
}

fn wall_on_the_right(line: &Contour) -> (Strip, Solid) {
    let strip = Strip::new(line, 0.02).unwrap();
    let solid = Solid::wall(&strip, Side::Left).unwrap();
    (strip, solid)
}

fn straight_line(runs: usize) -> Contour {
    let start = Pose { position: Point2::new(ASIDE + 0.01, -0.5), heading: FRAC_PI_2 };
    let path = (0..runs).fold(Path::from(start), |path, _| path.straight(1.5 / runs as f64));
    path.open().unwrap()
}

#[test]
fn twenty_parts_in_a_line_feel_like_one() {
    let along = |s: f64| Pose { position: Point2::new(ASIDE - aside(s), s), heading: FRAC_PI_2 };
    let [one, many] = [1, 20].map(|runs| {
        let (strip, solid) = wall_on_the_right(&straight_line(runs));
        assert_eq!(solid.parts().unwrap().len(), runs);
        // A second solid, far off: both are simulated by the same means.
        let far = vibrissa::geometry::circle(Point2::new(50.0, 0.0), 0.1).unwrap();
        let samples = drag(&[solid, Solid::inside(far).unwrap()], 0.9, along);
        let error = greatest_error(settled(&samples), strip.side(Side::Left));
        assert!(error < TOLERANCE, "{runs} parts: {error} m");
        samples
    });
    // The tip moves by some 170 m/rad with the base angle.
    let apart = settled(&one).iter().zip(settled(&many));
    let apart = apart.map(|(a, b)| (a.whiskers[0].base_angle - b.whiskers[0].base_angle).abs());
    let apart = apart.fold(0.0, f64::max);
    assert!(apart * 170.0 < TOLERANCE, "{apart} rad apart");
}

#[test]
fn one_part_with_masks_is_one_part_with_pairs() {
    let along = |s: f64| Pose { position: Point2::new(ASIDE - aside(s), s), heading: FRAC_PI_2 };
    let (_, solid) = wall_on_the_right(&straight_line(1));
    let pairs = drag(std::slice::from_ref(&solid), 0.9, along);
    let far = vibrissa::geometry::circle(Point2::new(50.0, 0.0), 0.1).unwrap();
    let masks = drag(&[solid, Solid::inside(far).unwrap()], 0.9, along);
    for (a, b) in pairs.iter().zip(&masks) {
        assert!((a.whiskers[0].base_angle - b.whiskers[0].base_angle).abs() < 1e-9);
    }
}

/// A wall along an arc about (0, 0), and a platform that goes round beside it with the wall on its right.
fn round_wall(radius: f64, way: f64) -> (Strip, Solid, impl Fn(f64) -> Pose) {
    let inner = radius + way * 0.01;
    let start = Pose { position: Point2::from(inner * unit(-0.5 * way)), heading: -0.5 * way + way * FRAC_PI_2 };
    let line = Path::from(start).arc(inner, way * 1.5 * PI).open().unwrap();
    let (strip, solid) = wall_on_the_right(&line);
    let pose = move |s: f64| {
        let own = radius - way * aside(s);
        let angle = way * s / (radius - way * ASIDE);
        Pose { position: Point2::from(own * unit(angle)), heading: angle + way * FRAC_PI_2 }
    };
    (strip, solid, pose)
}

#[test]
fn the_parts_of_a_hollow_bend_and_of_a_round_one_feel_like_the_exact_arc() {
    // Inside of a ring counter-clockwise, and outside of two clockwise.
    for (radius, way, least) in [(0.4, 1.0, 200), (0.3, -1.0, 15), (0.25, -1.0, 15)] {
        let (strip, solid, pose) = round_wall(radius, way);
        assert!(solid.parts().unwrap().len() >= least, "{} parts", solid.parts().unwrap().len());
        let samples = drag(&[solid], 0.9, pose);
        let touching = settled(&samples).iter().all(|sample| sample.whiskers[0].base_angle.abs() > 5e-5);
        assert!(touching, "the whisker lost the wall");
        let error = greatest_error(settled(&samples), strip.side(Side::Left));
        assert!(error < TOLERANCE, "radius {radius} m: {error} m");
    }
}
