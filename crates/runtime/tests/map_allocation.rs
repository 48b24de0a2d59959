//! A map allocates its memory when it is created, at most 4 MB for 5 m × 5 m, and nothing in a tick.
#![allow(clippy::unwrap_used, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an own world")]

#[path = "../../../tests/common/allocator.rs"]
mod allocator;
#[path = "map/world.rs"]
#[allow(dead_code, reason = "every test program uses a part of it")]
mod world;

use allocator::{allocations, held};
use vibrissa_runtime::geometry::{Point2, Pose, Vector2};
use vibrissa_runtime::machine::{ContactEstimatorKind, Senses};
use vibrissa_runtime::map::{Map, MapSettings};
use vibrissa_runtime::percept::Perception;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::Command;

use world::{Object, World};

/// The most bytes of a map of 5 m × 5 m.
const MOST_BYTES: isize = 4_000_000;

#[test]
fn a_map_has_its_memory_from_the_start() {
    let mut rig = Rig::default();
    rig.sensing.make_real();
    let whiskers = [Some(0), Some(1)];
    let mut perception = Perception::new(&rig, &whiskers, &[ContactEstimatorKind::Sliding; 2]).unwrap();
    let before = held();
    let mut map = Map::new(&rig, &whiskers, MapSettings::default()).unwrap();
    assert!(held() - before <= MOST_BYTES, "{} bytes", held() - before);

    // A body that goes to and fro between a disk on its left and a wall that stops it.
    let wall = [(0.3, -0.3), (0.4, -0.3), (0.4, 0.1), (0.3, 0.1)].map(|(x, y)| Point2::new(x, y));
    let objects = vec![Object::Disk(Point2::new(0.15, 0.19), 0.08), Object::Polygon(wall.to_vec())];
    let mut world = World::new(&rig, objects, Pose::default(), 1);
    let (mut touches, mut stopped, mut targets, mut found) = (0, 0, 0, 0);
    for tick in 0..1500 {
        let there = tick % 300 < 200;
        let speed = if there { 0.05 } else { -0.08 };
        let command = Command { velocity_world: Vector2::new(speed, 0.0), yaw_rate: 0.1 * speed.signum() };
        let samples = world.advance(command);
        perception.update(&samples);
        perception.record(1);
        let before = allocations();
        map.update(&perception, perception.pose(), command);
        let _ = map.at(Point2::new(0.1, 0.1));
        if let Some(target) = map.next_target() {
            map.seek_route(Some(target.pose));
            targets += 1;
        }
        found += usize::from(!map.route().is_empty());
        if tick % 200 == 199 {
            map.fail_target();
        }
        assert_eq!(allocations() - before, 0, "tick {tick}");
        touches += usize::from(perception.is_touching(1));
        stopped += usize::from(perception.is_blocked());
        perception.command(command);
    }
    assert!(touches > 50 && stopped > 50, "{touches} touches, {stopped} ticks against the wall");
    assert!(targets > 500 && found > 100, "{targets} ticks with a target, {found} with a route");
    assert!(map.free_area() > 0.05, "{} m²", map.free_area());
}
