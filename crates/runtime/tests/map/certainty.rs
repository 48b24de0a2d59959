//! No cell that an object covers is claimed free.

use vibrissa_runtime::geometry::{Point2, Pose, Vector2};
use vibrissa_runtime::machine::ContactEstimatorKind;
use vibrissa_runtime::map::{Cell, Map, MapSettings};
use vibrissa_runtime::percept::Perception;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::Command;

use super::world::{Object, Random, World};

/// Sequences of ticks. The emulated processor of the checks is slower by an order of magnitude.
const SEQUENCES: u64 = if cfg!(target_arch = "x86_64") { 10_000 } else { 200 };
const TICKS: usize = 60;
/// Parts that run at the same time.
const PARTS: u64 = 2;
/// Depth (m) that rounding and the chords between keyframes explain.
const TOLERANCE: f64 = 1e-5;
/// Bounds of the errors of poses in half of the sequences.
const POSITION: f64 = 0.5e-3;
const HEADING: f64 = 2e-3;

pub(crate) fn rigs() -> [Rig; 2] {
    [Rig::default(), Rig::thesis_array()].map(|mut rig| {
        rig.sensing.make_real();
        rig
    })
}

/// A perception without any sample. It is copied for every sequence.
pub(crate) fn perception(rig: &Rig) -> Perception {
    let whiskers: Vec<_> = (0..rig.whiskers.len()).map(Some).collect();
    Perception::new(rig, &whiskers, &vec![ContactEstimatorKind::OneChannel; whiskers.len()]).unwrap()
}

pub(crate) fn map(rig: &Rig, settings: MapSettings) -> Map {
    let whiskers: Vec<_> = (0..rig.whiskers.len()).map(Some).collect();
    Map::new(rig, &whiskers, settings).unwrap()
}

/// A command of a random walk.
fn command(random: &mut Random) -> Command {
    // Slow motions test the margins of shafts, and fast ones the time between samples.
    let slower = 10.0_f64.powf(-random.within(0.0, 1.5));
    let speed = 0.15 * slower;
    let direction = random.within(0.0, std::f64::consts::TAU);
    let yaw_rate = if random.below(3) == 0 { 0.0 } else { slower * random.within(-1.0, 1.0) };
    Command { velocity_world: Vector2::new(direction.cos(), direction.sin()) * speed, yaw_rate }
}

#[test]
fn no_covered_cell_is_ever_claimed_free() {
    std::thread::scope(|scope| {
        for part in 0..PARTS {
            scope.spawn(move || check(part * SEQUENCES / PARTS..(part + 1) * SEQUENCES / PARTS));
        }
    });
}

fn check(seeds: std::ops::Range<u64>) {
    let sequences = seeds.end - seeds.start;
    let rigs = rigs();
    let perceptions = rigs.each_ref().map(perception);
    let settings = |has_errors: bool| MapSettings {
        extent: 0.7,
        position_bound: if has_errors { POSITION } else { 0.0 },
        heading_bound: if has_errors { HEADING } else { 0.0 },
        ..MapSettings::default()
    };
    let maps = [false, true].map(|has_errors| rigs.each_ref().map(|rig| map(rig, settings(has_errors))));
    let (mut claimed, mut near, mut stopped, mut clear) = (0, 0, 0, 0);
    for seed in seeds {
        let mut random = Random::new(seed);
        let (which, has_errors) = (random.below(2), random.below(2));
        let bound = |bound: f64| if has_errors == 1 { bound } else { 0.0 };
        let direction = random.within(0.0, std::f64::consts::TAU);
        let pose_error = Pose {
            position: Point2::from(Vector2::new(direction.cos(), direction.sin()) * bound(POSITION)),
            heading: random.within(-1.0, 1.0).signum() * bound(HEADING),
        };
        let pose = Pose { position: Point2::origin(), heading: random.within(-3.0, 3.0) };
        let objects = (0..=random.below(4))
            .map(|_| {
                let far = Point2::new(random.within(-0.25, 0.25), random.within(-0.25, 0.25));
                // Half of the objects are near a shaft.
                let whisker = &rigs[which].whiskers[random.below(rigs[which].whiskers.len())];
                let (sin, cos) = whisker.direction_body.sin_cos();
                let along = random.within(0.0, 1.1) * whisker.shaft.length;
                let near = pose.point_to_world(whisker.base_body + Vector2::new(cos, sin) * along);
                let aside = Vector2::new(random.within(-0.03, 0.03), random.within(-0.03, 0.03));
                let centre = if random.below(2) == 0 { far } else { near + aside };
                Object::random(&mut random, centre)
            })
            .collect();
        let mut world = World::new(&rigs[which], objects, pose, seed);
        world.pose_error = pose_error;
        if !world.is_clear(world.pose) {
            continue;
        }
        let (mut perception, mut map) = (perceptions[which].clone(), maps[has_errors][which].clone());
        let mut going = Command::STOP;
        let mut left = 0;
        for _ in 0..TICKS {
            if left == 0 {
                (going, left) = (command(&mut random), 4 + random.below(20));
            }
            left -= 1;
            let before = world.pose;
            perception.update(&world.advance(going));
            stopped += usize::from(before == world.pose);
            map.update(&perception, perception.pose(), going);
            perception.command(going);
        }
        // A body in ground that is proved free touches no disk that is larger than a cell.
        for _ in 0..10 {
            let aside = Vector2::new(random.within(-0.06, 0.06), random.within(-0.06, 0.06));
            let heading = world.pose.heading + random.within(-0.3, 0.3);
            let pose = Pose { position: world.pose.position + aside, heading };
            if map.clear(pose) {
                clear += 1;
                let outline = world.outline(pose);
                for object in &world.objects {
                    let is_large = matches!(object, Object::Disk(_, radius) if *radius > 4e-3);
                    assert!(!is_large || !object.overlaps(&outline), "sequence {seed}: {pose:?} overlaps {object:?}");
                }
            }
        }
        for centre in map.free_cells() {
            claimed += 1;
            for object in &world.objects {
                let depth = object.depth(centre);
                near += usize::from(depth > -5e-3);
                assert!(depth < TOLERANCE, "sequence {seed}: {centre} is {depth} m inside of {object:?}");
            }
        }
    }
    // Without these the assertion says nothing.
    assert!(claimed > 1000 * sequences, "{claimed} cells");
    // A clear pose is rare: the few sequences of an emulated processor may have none.
    assert!(sequences < 1000 || clear > sequences / 100, "{clear} clear poses");
    assert!(
        near as u64 > sequences / 20 && stopped as u64 > sequences / 20,
        "{near} cells near objects, {stopped} ticks without motion"
    );
}

/// A whisker comes slowly to a disk that touches it at a random place, in a map with fine cells.
#[test]
fn the_ground_before_a_touch_is_claimed_up_to_the_margin_and_not_beyond() {
    let rig = &rigs()[0];
    let (prototype, settings) = (perception(rig), MapSettings { extent: 0.5, cell: 0.25e-3, ..MapSettings::default() });
    let fine = map(rig, settings);
    let whisker = &rig.whiskers[1];
    for seed in 0..60 {
        let mut random = Random::new(seed);
        let (share, radius) = (random.within(0.3, 1.05), random.within(2e-3, 60e-3));
        let (sin, cos) = whisker.direction_body.sin_cos();
        let (along, left) = (Vector2::new(cos, sin), Vector2::new(-sin, cos));
        // The left whisker moves to its right, which is ahead.
        let centre = whisker.base_body + along * (share * whisker.shaft.length) - left * (radius + 8e-3);
        let mut world = World::new(rig, vec![Object::Disk(centre, radius)], Pose::default(), seed);
        let (mut perception, mut map) = (prototype.clone(), fine.clone());
        let speed = random.within(4e-3, 12e-3);
        let going = Command { velocity_world: -left * speed, yaw_rate: 0.0 };
        for _ in 0..600 {
            perception.update(&world.advance(going));
            map.update(&perception, perception.pose(), going);
            perception.command(going);
            if perception.base_angle(1).abs() > 5e-5 {
                break;
            }
        }
        let mut nearest = f64::NEG_INFINITY;
        for cell in map.free_cells() {
            let depth = world.objects[0].depth(cell);
            assert!(depth < TOLERANCE, "case {seed}: {cell} is {depth} m inside of a disk at the share {share}");
            nearest = nearest.max(depth);
        }
        // A margin at the tip is 1.1 mm. Keyframes, ticks and cells add to it.
        assert!(nearest > -2.5e-3, "case {seed}: the nearest claim is {nearest} m from a disk at the share {share}");
    }
}

/// Straight paths without objects. The claim is the body's path and the whiskers' paths, less stated strips.
#[test]
fn free_ground_grows_by_the_swept_width() {
    for (rig, name) in rigs().iter().zip(["reference", "thesis"]) {
        let (mut perception, mut map) =
            (perception(rig), map(rig, MapSettings { extent: 2.0, ..MapSettings::default() }));
        let mut world = World::new(rig, Vec::new(), Pose { position: Point2::origin(), heading: 0.7 }, 3);
        let going = Command { velocity_world: Vector2::new(0.7_f64.cos(), 0.7_f64.sin()) * 0.1, yaw_rate: 0.0 };
        for _ in 0..210 {
            perception.update(&world.advance(going));
            map.update(&perception, perception.pose(), going);
            perception.command(going);
        }
        // From the tips of one side to those of the other one, without the last two hundredths of the shafts.
        let tip = |length: f64| {
            let tips = rig.whiskers.iter().map(|whisker| {
                let (sin, _) = whisker.direction_body.sin_cos();
                whisker.base_body.y.abs() + sin.abs() * length * whisker.shaft.length
            });
            tips.fold(0.0_f64, f64::max)
        };
        // The whiskers lag, begin after two margins, and are swept back or forward.
        let travelled = world.pose.position.coords.norm();
        let (least, most) = (2.0 * tip(0.98) * (travelled - 0.05), 2.0 * tip(1.0) * (travelled + 0.19));
        let found = map.free_area();
        assert!((least..most).contains(&found), "{name}: {found} m² is not between {least} and {most} m²");
        // No seams: from one side to the other one, everything in the middle of the way is free.
        let body = Pose { position: Point2::from(0.5 * world.pose.position.coords), heading: 0.7 };
        for step in -1000..=1000 {
            let across = f64::from(step) * 1e-3 * (tip(0.98) - 2e-3);
            for ahead in 0..50 {
                let place = body.point_to_world(Point2::new(f64::from(ahead) * 1e-3, across));
                assert!(map.is_free(place), "{name}: {place} is {across} m aside");
            }
        }
    }
}

#[test]
fn a_body_that_is_stopped_marks_what_is_ahead() {
    let rig = &rigs()[0];
    let (mut perception, mut map) = (perception(rig), map(rig, MapSettings::default()));
    let wall = [(0.2, -0.02), (0.3, -0.02), (0.3, 0.02), (0.2, 0.02)].map(|(x, y)| Point2::new(x, y));
    let mut world = World::new(rig, vec![Object::Polygon(wall.to_vec())], Pose::default(), 3);
    let going = Command { velocity_world: Vector2::new(0.05, 0.0), yaw_rate: 0.0 };
    for _ in 0..120 {
        perception.update(&world.advance(going));
        map.update(&perception, perception.pose(), going);
        perception.command(going);
    }
    assert_eq!(map.at(Point2::new(0.203, 0.0)), Cell::Blocked);
    assert_eq!(map.at(Point2::new(0.15, 0.0)), Cell::Free);
    assert_eq!(map.at(Point2::new(0.203, 0.1)), Cell::Unknown);
    assert_eq!(map.at(Point2::new(0.215, 0.0)), Cell::Unknown);
    assert_eq!(map.at(Point2::new(f64::NAN, 0.0)), Cell::Unknown);
}
