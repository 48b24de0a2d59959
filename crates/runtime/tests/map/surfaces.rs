//! Recorded contours in a map, from perception's own tips.

use vibrissa_runtime::geometry::{Point2, Pose, Vector2};
use vibrissa_runtime::machine::{ContactEstimatorKind, Senses};
use vibrissa_runtime::map::{Cell, EndKind, Map, MapSettings, TargetKind};
use vibrissa_runtime::percept::Perception;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{Command, MAX_WHISKERS, Reading, Sample, TrueTip};

use super::certainty::map;

/// Distance (m) of the reported tip ahead of the body, about that of the tip of the straight whisker.
const AHEAD: f64 = 0.03;

/// A perception with true tips.
fn told(rig: &Rig) -> Perception {
    let kinds = [ContactEstimatorKind::Truth; 2];
    Perception::new(rig, &[Some(0), Some(1)], &kinds).unwrap()
}

/// A body that goes along the x axis for `ticks`. Its right whisker follows a surface, with its tip reported
/// by the place of the body (m).
fn follow(map: &mut Map, rig: &Rig, ticks: u32, tip: impl Fn(f64) -> Option<Point2>) {
    let mut perception = told(rig);
    let going = Command { velocity_world: Vector2::new(0.05, 0.0), yaw_rate: 0.0 };
    for tick in 0..ticks {
        let samples: Vec<_> = (0..10)
            .map(|index| {
                let time = f64::from(tick * 10 + index) / 300.0;
                let body = Pose { position: Point2::new(0.05 * time, 0.0), heading: 0.0 };
                let mut whiskers = [Reading::default(); MAX_WHISKERS];
                if let Some(point_world) = tip(body.position.x) {
                    whiskers[0].base_angle = 3e-4;
                    whiskers[0].true_tip = Some(TrueTip { point_world, touches: true });
                }
                Sample { time, body, whiskers }
            })
            .collect();
        perception.update(&samples);
        perception.record(0);
        map.update(&perception, perception.pose(), going);
        perception.command(going);
    }
}

#[test]
fn a_wall_becomes_a_contour_with_two_open_ends_and_blocked_ground_behind() {
    let rig = Rig::default();
    let mut map = map(&rig, MapSettings::default());
    follow(&mut map, &rig, 240, |x| (0.1..0.3).contains(&x).then(|| Point2::new(x + AHEAD, -0.1)));
    assert!((map.contour_length() - 0.2).abs() < 5e-3, "{} m", map.contour_length());
    let ends: Vec<_> = map.contour_ends().collect();
    assert_eq!(ends.len(), 2);
    for (end, (x, outwards)) in ends.iter().zip([(0.1 + AHEAD, -1.0), (0.3 + AHEAD, 1.0)]) {
        assert_eq!(end.kind, EndKind::Open);
        assert!((end.place - Point2::new(x, -0.1)).norm() < 5e-3, "{}", end.place);
        assert!((end.outwards - Vector2::new(outwards, 0.0)).norm() < 1e-3);
        assert!((end.normal - Vector2::new(0.0, 1.0)).norm() < 1e-3);
    }
    for step in 0..180 {
        let x = 0.11 + AHEAD + 1e-3 * f64::from(step);
        assert_eq!(map.at(Point2::new(x, -0.1025)), Cell::Blocked, "{x}");
    }
    assert_eq!(map.at(Point2::new(0.2, -0.15)), Cell::Unknown);
}

/// Where a body stands beside the wall of these tests.
const BESIDE: Pose = Pose { position: Point2::new(0.4, 0.0), heading: 0.0 };

/// A body that stands still until the targets are chosen again.
fn stand(map: &mut Map, rig: &Rig, body: Pose) {
    let mut perception = told(rig);
    for tick in 0..60 {
        let sample = Sample { time: 8.0 + f64::from(tick) / 30.0, body, whiskers: [Reading::default(); MAX_WHISKERS] };
        perception.update(&[sample]);
        map.update(&perception, perception.pose(), Command::STOP);
    }
}

#[test]
fn a_target_to_which_the_body_comes_three_times_is_closed() {
    let rig = Rig::default();
    let mut map = map(&rig, MapSettings { extent: 2.0, ..MapSettings::default() });
    follow(&mut map, &rig, 240, |x| (0.1..0.3).contains(&x).then(|| Point2::new(x + AHEAD, -0.1)));
    stand(&mut map, &rig, BESIDE);
    let first = map.next_target().unwrap();
    for visit in 0..3 {
        let target = map.next_target().unwrap();
        assert!((target.place - first.place).norm() < 1e-9, "visit {visit}: {target:?}");
        map.seek_route(Some(target.pose));
        stand(&mut map, &rig, target.pose);
        stand(&mut map, &rig, BESIDE);
    }
    assert!((map.next_target().unwrap().place - first.place).norm() > 0.1);
}

#[test]
fn giving_up_counts_for_the_target_that_the_body_goes_to() {
    let rig = Rig::default();
    let mut map = map(&rig, MapSettings { extent: 2.0, ..MapSettings::default() });
    follow(&mut map, &rig, 240, |x| (0.1..0.3).contains(&x).then(|| Point2::new(x + AHEAD, -0.1)));
    let (mut sought_far, mut others) = (0, 0);
    for round in 0..6 {
        stand(&mut map, &rig, BESIDE);
        let sought = map.next_target().unwrap();
        assert_eq!(sought.kind, TargetKind::OpenEnd, "round {round}: {sought:?}");
        sought_far += usize::from(sought.place.x > 0.2 + AHEAD);
        map.seek_route(Some(sought.pose));
        // Meanwhile another one may be nearer.
        stand(&mut map, &rig, Pose { position: Point2::new(0.0, 0.0), heading: std::f64::consts::PI });
        others += usize::from((map.next_target().unwrap().place - sought.place).norm() > 0.1);
        map.fail_target();
    }
    assert!(others > 0, "no other target was nearer");
    assert_eq!(sought_far, 3, "each end three times");
    stand(&mut map, &rig, BESIDE);
    assert!(map.next_target().unwrap().kind != TargetKind::OpenEnd);
}

#[test]
fn the_ends_of_a_wall_are_the_first_targets_and_close_after_three_failures() {
    let rig = Rig::default();
    let mut map = map(&rig, MapSettings { extent: 2.0, ..MapSettings::default() });
    let along_the_wall = |x: f64| (0.1..0.3).contains(&x).then(|| Point2::new(x + AHEAD, -0.1));
    follow(&mut map, &rig, 240, along_the_wall);
    let mut seen = Vec::new();
    for _ in 0..7 {
        stand(&mut map, &rig, BESIDE);
        let target = map.next_target().unwrap();
        if target.kind == TargetKind::OpenEnd {
            // Only the right whisker goes on to the right of the wall's far end, with the body parallel to the wall.
            let is_far = target.place.x > 0.2;
            assert_eq!(target.whisker, usize::from(!is_far), "{target:?}");
            let heading: f64 = if is_far { 0.0 } else { std::f64::consts::PI };
            assert!((target.pose.heading - heading).sin().abs() < 1e-2 && (target.pose.heading - heading).cos() > 0.9);
            // The straight tip is before the surface, on known contour, and so far before its end that the contact is sure there.
            let mount = &rig.whiskers[target.whisker];
            let tip = mount.base_pose().point_to_world(Point2::new(mount.shaft.length, 0.0));
            let tip = target.pose.point_to_world(tip);
            let before_end = (tip.x - target.place.x).abs();
            assert!((0.038..0.05).contains(&before_end) && tip.y > target.place.y + 5e-3, "{tip}");
        }
        seen.push((target.kind, target.place.x > 0.2));
        map.fail_target();
        assert!(!map.is_complete());
    }
    let ends = seen.iter().filter(|(kind, _)| *kind == TargetKind::OpenEnd).count();
    assert_eq!((ends, seen[6].0), (6, TargetKind::Frontier), "{seen:?}");
    assert_eq!(seen.iter().filter(|(_, is_far)| *is_far).count() - usize::from(seen[6].1), 3, "each end three times");
}

#[test]
fn a_tip_in_free_ground_is_refuted_and_one_beside_it_is_not() {
    let rig = Rig::default();
    let mut map = map(&rig, MapSettings::default());
    // The straight whisker first sweeps the ground.
    follow(&mut map, &rig, 300, |_| None);
    let reach = -0.03 - 0.1 * 75_f64.to_radians().sin();
    assert!(map.is_free(Point2::new(0.2, reach + 5e-3)) && !map.is_free(Point2::new(0.2, reach - 2e-3)));
    follow(&mut map, &rig, 240, |x| (0.1..0.3).contains(&x).then(|| Point2::new(x + AHEAD, reach + 8e-3)));
    assert_eq!(map.contour_ends().count(), 0);
    let refuted = map.refuted_tips();
    assert!(refuted > 100, "{refuted}");
    follow(&mut map, &rig, 240, |x| (0.1..0.3).contains(&x).then(|| Point2::new(x + AHEAD, reach + 1e-3)));
    assert_eq!(map.refuted_tips(), refuted, "the border of free ground is where surfaces are");
    assert_eq!(map.contour_ends().count(), 2);
}

/// A base angle and a base pose of a shaft that rests on a corner `at` (m, frame of the base) at rest, by small bends.
#[test]
fn a_body_that_rotates_against_a_pole_knows_where_its_shaft_touches() {
    let rig = {
        let mut rig = Rig::default();
        rig.sensing.make_real();
        rig
    };
    let whisker = &rig.whiskers[1];
    let stiffness = whisker.shaft.bending_stiffness();
    for along in [0.03, 0.05, 0.07] {
        let mut map = map(&rig, MapSettings::default());
        let mut perception = super::certainty::perception(&rig);
        let mut random = super::world::Random::new(5);
        // Free for half a second, then the base rotates against a pole, about itself.
        let base = Pose { position: whisker.base_body, heading: whisker.direction_body };
        let pole = base.point_to_world(Point2::new(along, 0.0));
        let mut found = None;
        for tick in 0..40_u32 {
            let samples: Vec<_> = (0..10)
                .map(|index| {
                    let time = f64::from(tick * 10 + index) / 300.0;
                    let turn = 0.2 * (time - 0.5);
                    // The body turns about the base of the whisker.
                    let heading = -turn;
                    let (sin, cos) = heading.sin_cos();
                    let mount = whisker.base_body.coords;
                    let position =
                        whisker.base_body - Vector2::new(cos * mount.x - sin * mount.y, sin * mount.x + cos * mount.y);
                    let mut whiskers = [Reading::default(); MAX_WHISKERS];
                    // `M = 3 EI φ / r`, with the rotation of the hinge.
                    let bend = if turn > 0.0 {
                        let hinge = whisker.hinge.stiffness;
                        turn / (1.0 + hinge * along / (3.0 * stiffness))
                    } else {
                        0.0
                    };
                    whiskers[1].base_angle = bend + 0.5e-6 * random.normal();
                    Sample { time, body: Pose { position, heading }, whiskers }
                })
                .collect();
            perception.update(&samples);
            map.update(&perception, perception.pose(), Command::STOP);
            found = map.shaft_contact(1).copied().or(found);
        }
        let found = found.unwrap();
        assert!(found.is_shaft, "{found:?}");
        let error = (found.place - pole).norm();
        assert!(error < 1.5e-3 && error < 4.0 * found.deviation + 0.5e-3, "{error} m at {along} m: {found:?}");
        let touch = map.first_touch(1).unwrap();
        assert!(touch.distances[0] < along && along < touch.distances[1], "{touch:?}");
    }
}
