//! The rooms of the family `rooms`, without their rotation.

use std::collections::HashSet;
use std::f64::consts::FRAC_PI_6;

use vibrissa::diagnostic::Source;
use vibrissa::family::{Draw, Family, Values};
use vibrissa::geometry::{BoundingBox, Contour, Piece, Point2, Pose, Vector2};
use vibrissa::scenario;
use vibrissa::scene::Scene;
use vibrissa_runtime::rig::Platform;

const TRIALS: u64 = 200;
/// Distance between the nodes of a flood (m).
const CELL: f64 = 0.02;

/// A room, with every part of its walls and every object by itself.
struct Room {
    draw: Draw,
    walls: Vec<Contour>,
    objects: Vec<Contour>,
}

fn rooms() -> impl Iterator<Item = Room> {
    let family = Family::named("rooms").unwrap();
    (0..TRIALS).map(move |trial| {
        let draw = family.draw_with(7, trial, &Values::from_iter([("turn", 0.0)])).unwrap();
        let doors = draw.scene.description.split("doors of ").nth(1).unwrap().split(" and ").count();
        let count = draw.text.lines().filter(|line| line.starts_with("  - ")).count();
        let mut walls: Vec<_> = (0..count).map(|index| alone(&draw.text, index)).collect();
        let objects = walls.split_off(doors);
        Room { draw, walls, objects }
    })
}

/// The outline of the object with this index, in a scene without the others.
fn alone(text: &str, index: usize) -> Contour {
    let mut objects = 0;
    let is_kept = |line: &&str| {
        objects += usize::from(line.starts_with("  - "));
        !line.starts_with("  - ") || objects == index + 1
    };
    let text: String = text.lines().filter(is_kept).flat_map(|line| [line, "\n"]).collect();
    let scene = scenario::read(&Source::new("alone.yaml", text)).unwrap();
    scene.solids[0].outline().clone()
}

/// The diameter of the circle in which the body turns about its centre of mass (m).
fn turning_circle(platform: &Platform) -> f64 {
    2.0 * platform.outline_body().iter().map(|corner| corner.coords.norm()).fold(0.0, f64::max)
}

/// The smallest signed distance of the points of an outline from another one (m).
fn gap(one: &Contour, other: &Contour) -> f64 {
    let least = |one: &Contour, other: &Contour| {
        let points = one.sample(2e-3).into_iter().map(|sample| sample.point);
        let corners = one.pieces().iter().map(Piece::start);
        points.chain(corners).map(|point| other.signed_distance(point)).fold(f64::INFINITY, f64::min)
    };
    least(one, other).min(least(other, one))
}

/// The box around all walls.
fn frame(walls: &[Contour]) -> BoundingBox {
    walls.iter().map(Contour::bounding_box).reduce(|one, other| one.union(&other)).unwrap()
}

#[test]
fn rooms_have_3_to_8_objects_inside_of_their_walls_with_gaps_that_are_closed_or_let_the_body_turn() {
    for Room { draw, walls, objects } in rooms() {
        let text = &draw.text;
        assert!((1..=2).contains(&walls.len()) && (3..=8).contains(&objects.len()), "{text}");
        let frame = frame(&walls);
        let sides = frame.max - frame.min;
        assert!((1.54..3.13).contains(&sides.x) && (1.54..3.13).contains(&sides.y), "{sides}: {text}");
        let passage = turning_circle(&draw.scene.rig.platform);
        for (index, object) in objects.iter().enumerate() {
            let bounds = object.bounding_box();
            assert!(frame.min < bounds.min && bounds.max < frame.max, "object {index} is outside: {text}");
            for other in walls.iter().chain(&objects[..index]) {
                let gap = gap(object, other);
                // What touches overlaps by 1 cm at most.
                assert!((-0.0101..0.0).contains(&gap) || gap > passage - 1e-5, "object {index}, {gap} m: {text}");
            }
        }
    }
}

#[test]
fn doors_are_at_least_1_3_times_as_wide_as_the_body() {
    let mut counts = [0; 3];
    for Room { draw, walls, .. } in rooms() {
        let least = 1.3 * draw.scene.rig.platform.tail_width - 1e-5;
        counts[walls.len()] += 1;
        match walls.as_slice() {
            // A parallel at half of the width of a door would close it, and enclose the room.
            [wall] => assert_eq!(wall.offset(0.5 * least).unwrap().len(), 1, "{}", draw.text),
            [one, other] => assert!(gap(one, other) > least, "{}", draw.text),
            _ => panic!("{}", draw.text),
        }
    }
    assert!(counts[1] > 50 && counts[2] > 50, "{counts:?}");
}

/// The nodes that a disk of this radius (m) reaches from the start without touching anything, within a box.
fn flood(scene: &Scene, radius: f64, within: &BoundingBox) -> HashSet<(i32, i32)> {
    let place = |(x, y): (i32, i32)| scene.start.position + CELL * Vector2::new(f64::from(x), f64::from(y));
    let is_free =
        |node: (i32, i32)| within.distance(place(node)) == 0.0 && !scene.truth.surfaces.is_within(radius, place(node));
    let (mut reached, mut open) = (HashSet::from([(0, 0)]), vec![(0, 0)]);
    while let Some((x, y)) = open.pop() {
        for next in [(x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)] {
            if !reached.contains(&next) && is_free(next) {
                reached.insert(next);
                open.push(next);
            }
        }
    }
    reached
}

#[test]
fn the_body_reaches_every_object_and_the_outside() {
    for Room { draw, walls, objects } in rooms() {
        let Draw { scene, text, .. } = &draw;
        let frame = frame(&walls);
        let place = |&(x, y): &(i32, i32)| scene.start.position + CELL * Vector2::new(f64::from(x), f64::from(y));
        // Passages are as wide as the circle, which is smaller here by a node.
        let circle = 0.5 * turning_circle(&scene.rig.platform);
        let reached: Vec<Point2> = flood(scene, circle - CELL, &frame).iter().map(place).collect();
        for (index, object) in objects.iter().enumerate() {
            let nearest = reached.iter().map(|node| object.distance(*node)).fold(f64::INFINITY, f64::min);
            assert!(nearest < circle + CELL, "object {index}, {nearest} m: {text}");
        }
        let [least, most] = [(frame.min, -0.3), (frame.max, 0.3)].map(|(corner, by)| corner + Vector2::new(by, by));
        let door = 0.5 * 1.3 * scene.rig.platform.tail_width;
        let reached = flood(scene, door - CELL, &BoundingBox { min: least, max: most });
        assert!(reached.iter().any(|node| frame.distance(place(node)) > 0.1), "no way out: {text}");
    }
}

#[test]
fn the_whole_rig_stands_clear_inside_of_the_room_wherever_starts_may_be() {
    for Room { draw, walls, .. } in rooms() {
        let Draw { scene, text, .. } = &draw;
        let none = ["start_x", "start_y", "start_heading"].map(|name| (name, 0.0));
        let given: Values = none.into_iter().chain([("turn", 0.0)]).collect();
        let trial = scene.name.rsplit_once('-').unwrap().1.parse().unwrap();
        let middle = Family::named("rooms").unwrap().draw_with(7, trial, &given).unwrap().scene.start;
        assert!(frame(&walls).distance(middle.position) == 0.0, "{text}");
        for x in [-0.04, 0.0, 0.04] {
            for y in [-0.04, 0.0, 0.04] {
                for turn in [-FRAC_PI_6, 0.0, FRAC_PI_6] {
                    let position = middle.position + Vector2::new(x, y);
                    let start = Pose { position, heading: middle.heading + turn };
                    assert!(scene.is_clear_at(&start), "{x}, {y}, {turn}: {text}");
                }
            }
        }
    }
}

#[test]
fn the_time_of_a_room_is_four_to_eight_times_that_of_the_shortest_conceivable_run() {
    for Room { draw, walls, .. } in rooms() {
        let Draw { scene, speed, text } = &draw;
        let sides = frame(&walls).max - frame(&walls).min;
        let solid: f64 = scene.solids.iter().map(|solid| solid.outline().area()).sum();
        // A whisker shows what it reaches beyond the body.
        let whisker = &scene.rig.whiskers[0];
        let tip = whisker.base_body.y + whisker.shaft.length * whisker.direction_body.sin();
        let lane = tip.abs() - 0.5 * scene.rig.platform.tail_width;
        let path = ((sides.x * sides.y - solid) / lane).max(scene.truth.reference.length());
        let least = path / speed;
        assert!((4.0 * least..8.0 * least + 120.0).contains(&scene.stop.time), "{least} s: {text}");
    }
}

#[test]
fn all_kinds_of_objects_occur_free_and_in_contact() {
    let (mut disks, mut poles, mut boxes, mut others, mut free, mut in_contact) = (0, 0, 0, 0, 0, 0);
    for Room { walls, objects, .. } in rooms() {
        for (index, object) in objects.iter().enumerate() {
            let sides = object.bounding_box().max - object.bounding_box().min;
            match object.corners().len() {
                0 if sides.x > 0.07 => disks += 1,
                0 => poles += 1,
                4 => boxes += 1,
                _ => others += 1,
            }
            let rest = objects[..index].iter().chain(&objects[index + 1..]).chain(&walls);
            let is_free = rest.into_iter().all(|other| gap(object, other) > 0.0);
            *if is_free { &mut free } else { &mut in_contact } += 1;
        }
    }
    let counts = [disks, poles, boxes, others, free, in_contact];
    assert!(counts.iter().all(|count| *count > 100), "{counts:?}");
}
