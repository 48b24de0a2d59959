//! What the rig cannot get to, in scenes where geometry tells that.

use proptest::prelude::*;
use vibrissa::geometry::{Contour, Point2, Pose, circle, polygon};
use vibrissa::scene::Truth;
use vibrissa::score::{Estimate, out_of_reach};
use vibrissa_runtime::rig::Rig;

use crate::runs::run_with;

/// The length (m) that is out of reach of a rig that has recorded these tips.
fn unreached(contour: Contour, rig: &Rig, tips: Vec<Option<Point2>>) -> f64 {
    unreached_from(None, contour, rig, tips)
}

/// The same for a platform that starts at a position.
fn unreached_from(start: Option<Point2>, contour: Contour, rig: &Rig, tips: Vec<Option<Point2>>) -> f64 {
    let start = start.map(|position| Pose { position, heading: 1.0 });
    out_of_reach(&Estimate::new(&run_with(&[tips]).trace), &Truth::from(contour), rig, start)
}

/// A square room with an inner side, walls of 3 cm and a door (m) in the middle of its lower wall.
fn room(side: f64, door: f64) -> Contour {
    let (wall, left, right) = (0.03, 0.5 * (side - door), 0.5 * (side + door));
    let far = side + wall;
    let outside = [(right, -wall), (far, -wall), (far, far), (-wall, far), (-wall, -wall), (left, -wall)];
    let inside = [(left, 0.0), (0.0, 0.0), (0.0, side), (side, side), (side, 0.0), (right, 0.0)];
    let corners: Vec<_> = outside.into_iter().chain(inside).map(|(x, y)| Point2::new(x, y)).collect();
    polygon(&corners).unwrap()
}

/// A hook with walls of 3 cm, open at its top, that is so wide and so deep (m) inside.
fn hook(width: f64, depth: f64) -> Contour {
    let (wall, right, top) = (0.03, 0.03 + width, 0.03 + depth);
    let corners = [
        (0.0, 0.0),
        (right + wall, 0.0),
        (right + wall, top),
        (right, top),
        (right, wall),
        (wall, wall),
        (wall, top + 0.2),
        (0.0, top + 0.2),
    ];
    polygon(&corners.map(|(x, y)| Point2::new(x, y))).unwrap()
}

#[test]
fn all_of_a_convex_object_is_in_reach() {
    let disk = circle(Point2::new(0.4, 0.4), 0.1).unwrap();
    let plate = polygon(&[(0.0, 0.0), (0.3, 0.0), (0.3, 0.002), (0.0, 0.002)].map(|(x, y)| Point2::new(x, y))).unwrap();
    for outline in [disk, plate] {
        assert!(unreached(outline, &Rig::default(), Vec::new()) < 1e-12);
    }
}

#[test]
fn the_end_of_a_deep_hook_is_out_of_reach() {
    // The nose comes in as far as the body is narrower than the hook, and a whisker reaches on from its base.
    let platform = Rig::default().platform;
    for (width, depth) in [(0.06, 0.2), (0.08, 0.2), (0.1, 0.3)] {
        let taper = (platform.tail_width - platform.nose_width) / platform.length;
        let (nose, base) = ((width - platform.nose_width) / taper, 0.055);
        let deepest = nose - base + Rig::default().whiskers[0].shaft.length;
        let found = unreached(hook(width, depth), &Rig::default(), Vec::new());
        let exact = 2.0 * (depth - deepest) + width;
        assert!(found <= exact && found >= exact - 0.12, "{width} m: {found} m of {exact} m");
    }
}

#[test]
fn all_of_a_wide_hook_is_in_reach() {
    assert!(unreached(hook(0.3, 0.2), &Rig::default(), Vec::new()) < 1e-12);
}

#[test]
fn the_outside_of_a_room_is_out_of_reach_from_its_inside() {
    let (side, door, rig) = (0.6, 0.02, Rig::default());
    let found = unreached_from(Some(Point2::new(0.3, 0.3)), room(side, door), &rig, Vec::new());
    // A whisker reaches out by the door, and along the outer wall on both sides of it.
    let exact = 4.0 * (side + 0.06) - door;
    let through = 2.0 * rig.whiskers[0].shaft.length;
    assert!(found <= exact + 0.06 && found >= exact - through, "{found} m of {exact} m");
}

#[test]
fn all_of_a_room_is_in_reach_by_a_door_that_the_body_passes() {
    let rig = Rig::default();
    for start in [Point2::new(0.3, 0.3), Point2::new(0.3, -0.4)] {
        let found = unreached_from(Some(start), room(0.6, 1.1 * rig.platform.tail_width), &rig, Vec::new());
        assert!(found < 1e-12, "{found} m");
    }
}

#[test]
fn a_start_in_the_open_or_inside_of_an_object_limits_nothing() {
    let rig = Rig::default();
    for (outline, x, y) in [(room(0.6, 0.02), 2.0, 2.0), (room(0.6, 0.02), -0.015, 0.3), (hook(0.08, 0.2), -0.3, 0.1)] {
        let free = unreached(outline.clone(), &rig, Vec::new());
        assert_eq!(unreached_from(Some(Point2::new(x, y)), outline, &rig, Vec::new()).to_bits(), free.to_bits());
    }
}

#[test]
fn all_slots_of_a_long_comb_are_searched() {
    // A comb: slots of 5 cm by 30 cm between walls of 5 cm.
    let comb = |slots: u32| {
        let slot = |index: u32| {
            let left = 0.05 + 0.1 * f64::from(index);
            [(left + 0.05, 0.3), (left + 0.05, 0.0), (left, 0.0), (left, 0.3)]
        };
        let right = 0.05 + 0.1 * f64::from(slots);
        let outside = [(0.0, 0.3), (0.0, -0.05), (right, -0.05), (right, 0.3)];
        let corners = outside.into_iter().chain((0..slots).rev().flat_map(slot));
        let corners: Vec<Point2> = corners.map(|(x, y)| Point2::new(x, y)).collect();
        polygon(&corners).unwrap()
    };
    let [one, many] = [1, 20].map(|slots| unreached(comb(slots), &Rig::default(), Vec::new()));
    assert!(one > 0.2, "{one} m");
    assert!((many - 20.0 * one).abs() < one, "{many} m, {one} m of one slot");
}

#[test]
fn what_was_traced_is_in_reach() {
    let outline = hook(0.08, 0.2);
    let count = 1500;
    let tips = (0..=count).map(|index| outline.point_at(f64::from(index) / f64::from(count) * outline.length()));
    let tips: Vec<_> = tips.map(Some).collect();
    assert!(unreached(outline, &Rig::default(), tips) < 1e-12);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]

    #[test]
    fn longer_whiskers_reach_no_less(width in 0.04..0.1_f64, longer in 1.1..2.0_f64) {
        let rig = Rig::default();
        let mut long = rig.clone();
        long.whiskers.iter_mut().for_each(|whisker| whisker.shaft.length *= longer);
        let [short, long] = [&rig, &long].map(|rig| unreached(hook(width, 0.25), rig, Vec::new()));
        prop_assert!(long <= short, "{long} m of {short} m");
    }
}
