//! Closed loops.

use vibrissa::geometry::{Point2, Vector2, perpendicular, polygon, rotate, unit};
use vibrissa_runtime::percept::LoopWatch;

/// Distance (m) and time (s) of a closed loop.
const WITHIN: f64 = 0.005;
const AFTER: f64 = 2.0;

/// The time at which tips on a circle of 0.1 m close the loop. The angles are given tick by tick, and the platform
/// is outside.
fn closing_time(angles: impl Iterator<Item = f64>) -> Option<f64> {
    closing_time_after(AFTER, angles)
}

fn closing_time_after(after: f64, angles: impl Iterator<Item = f64>) -> Option<f64> {
    let mut watch = LoopWatch::default();
    let mut timed = angles.enumerate().map(|(tick, angle)| (tick as f64 * 0.1, unit(angle)));
    let closes = |&(time, outwards): &(f64, Vector2)| {
        watch.update(time, Some(Point2::from(0.1 * outwards)), Point2::from(0.2 * outwards));
        watch.is_closed(WITHIN, after)
    };
    timed.find(closes).map(|(time, _)| time)
}

#[test]
fn a_tip_that_goes_round_closes_the_loop_either_way() {
    for direction in [1.0, -1.0] {
        let closing = closing_time((0..100).map(|tick| direction * 0.1 * f64::from(tick)));
        assert_eq!(closing.map(|time| (time * 10.0).round()), Some(63.0), "at a whole turn");
    }
}

/// Tips along a polygon, several times around, from 2 mm behind its first corner on. The platform is 0.1 m away,
/// perpendicular to the outline except for a lean (rad) that depends on the distance along the path (m).
fn round(corners: &[Point2], lean: impl Fn(f64) -> f64) -> impl Iterator<Item = (Point2, Point2)> {
    let contour = polygon(corners).unwrap();
    (0..1200).map(move |tick| {
        let distance = 0.0015 * f64::from(tick);
        let along = (0.002 + distance) % contour.length();
        let (tip, tangent) = (contour.point_at(along), contour.tangent_at(along));
        (tip, tip - 0.1 * rotate(perpendicular(tangent), lean(distance)))
    })
}

/// The distance along the path (m) after which these tips close the loop.
fn closing_distance(corners: &[Point2], lean: impl Fn(f64) -> f64) -> Option<f64> {
    let mut watch = LoopWatch::default();
    let mut ticks = round(corners, lean).zip(0_u32..);
    let closing = ticks.find(|&((tip, platform), tick)| {
        watch.update(0.1 * f64::from(tick), Some(tip), platform);
        watch.is_closed(WITHIN, AFTER)
    });
    closing.map(|(_, tick)| 0.0015 * f64::from(tick))
}

/// A wall 0.4 m long, its outline from the middle of one side on.
fn wall(thickness: f64) -> [Point2; 5] {
    [(0.2, 0.0), (0.4, 0.0), (0.4, thickness), (0.0, thickness), (0.0, 0.0)].map(|(x, y)| Point2::new(x, y))
}

#[test]
fn a_loop_that_begins_right_behind_a_sharp_corner_closes() {
    for degrees in [20.0_f64, 50.0, 70.0, 90.0, 120.0, 170.0] {
        // A rhombus with sides of 0.1 m and a corner of this angle.
        let (a, b) = (0.1 * unit(0.0), 0.1 * unit(degrees.to_radians()));
        let corners = [Point2::origin(), Point2::from(a), Point2::from(a + b), Point2::from(b)];
        let distance = closing_distance(&corners, |_| 0.0);
        assert!(distance.is_some_and(|distance| (distance - 0.4).abs() < 2.0 * WITHIN), "{degrees} deg: {distance:?}");
    }
}

#[test]
fn a_tip_behind_a_thin_wall_does_not_close_the_loop_and_one_that_comes_round_it_does() {
    for thickness in [0.0005, 0.002, 0.0045] {
        let distance = closing_distance(&wall(thickness), |_| 0.0);
        assert!(distance.is_some_and(|distance| (distance - 0.8).abs() < 3.0 * WITHIN), "{thickness} m: {distance:?}");
    }
}

#[test]
fn behind_a_thin_wall_no_lean_of_the_platform_closes_the_loop() {
    for lean in [0.4, 0.6, -0.6] {
        // With a lean to one side at first and to the other from then on, the platform rotates by up to 250 deg on
        // the way to the other side.
        let distance = closing_distance(&wall(0.002), |distance| if distance < 0.01 { -lean } else { lean });
        assert!(distance.is_some_and(|distance| (distance - 0.8).abs() < 3.0 * WITHIN), "{lean} rad: {distance:?}");
    }
}

#[test]
fn a_start_at_the_end_of_a_thin_wall_has_first_tips_on_both_sides() {
    // From 12 mm before the end on, so that the first 20 mm of the outline go round it.
    let [_, near, far, back, front] = wall(0.003);
    let distance = closing_distance(&[Point2::new(0.388, 0.0), near, far, back, front], |_| 0.0);
    assert!(distance.is_some_and(|distance| (distance - 0.806).abs() < 3.0 * WITHIN), "{distance:?}");
}

#[test]
fn a_loop_closes_though_the_first_tip_was_wrong_by_centimetres() {
    let wrong = std::iter::once(-0.3);
    assert!(closing_time(wrong.chain((0..100).map(|tick| 0.1 * f64::from(tick)))).is_some());
}

#[test]
fn a_tip_that_comes_back_the_way_it_went_does_not() {
    assert_eq!(closing_time((0..100).map(|tick| (0.1 * f64::from(tick)).sin())), None);
}

#[test]
fn a_tip_that_stays_does_not() {
    assert_eq!(closing_time((0..100).map(|tick| 0.01 * (0.7 * f64::from(tick)).sin())), None);
}

#[test]
fn a_tip_that_came_back_and_then_goes_round_does() {
    let back = (0..32).map(|tick| (0.1 * f64::from(tick)).sin());
    let closing = closing_time(back.chain((0..200).map(|tick| 0.1 * f64::from(tick))));
    assert!(closing.is_some_and(|time| time > 9.0), "{closing:?}");
}

#[test]
fn a_loop_that_closes_too_early_goes_on_to_the_next_time_round() {
    let after = 10.0;
    let closing = closing_time_after(after, (0..300).map(|tick| 0.09 * f64::from(tick)));
    assert!(closing.is_some_and(|time| time >= after), "{closing:?}");
}

#[test]
fn a_tip_that_stands_still_or_creeps_needs_no_more_memory_and_still_closes() {
    // 20 000 ticks around a circle of 0.1 m, with long halts: as many as would fill any list.
    let angles =
        (0..20_000_u32).map(|tick| if tick < 4000 { 1e-7 * f64::from(tick) } else { 4e-4 * f64::from(tick - 4000) });
    assert!(closing_time(angles).is_some());
}

#[test]
fn a_tick_without_a_pose_does_no_harm() {
    let mut watch = LoopWatch::default();
    let mut closed = false;
    for tick in 0..80_u32 {
        let outwards = unit(0.1 * f64::from(tick));
        let platform = if tick % 10 == 5 { Point2::new(f64::NAN, 0.0) } else { Point2::from(0.2 * outwards) };
        watch.update(0.1 * f64::from(tick), Some(Point2::from(0.1 * outwards)), platform);
        closed |= watch.is_closed(WITHIN, AFTER);
    }
    assert!(closed);
}
