//! Recorded contours in a map, from perception's own tips.

use vibrissa_runtime::geometry::{Point2, Pose, Vector2};
use vibrissa_runtime::machine::{ContactEstimatorKind, Senses};
use vibrissa_runtime::map::{Cell, EndKind, Map, MapSettings};
use vibrissa_runtime::percept::Perception;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{Command, MAX_WHISKERS, Reading, Sample, TrueTip};

use super::certainty::map;

/// Distance (m) of the told tip ahead of the body, about that of the tip of the straight whisker.
const AHEAD: f64 = 0.03;

/// A perception that is told the true tips.
fn told(rig: &Rig) -> Perception {
    let kinds = [ContactEstimatorKind::Truth; 2];
    Perception::new(rig, &[Some(0), Some(1)], &kinds).unwrap()
}

/// A body that goes along the x axis for `ticks`. Its right whisker follows a surface, with its tip told
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
