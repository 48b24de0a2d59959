//! Figures of a map against geometry of which the answer is known.

use std::f64::consts::PI;

use proptest::prelude::*;
use vibrissa::geometry::{ContourSet, Point2, circle};
use vibrissa::run::{Run, RunMap};
use vibrissa::score::{MapFigures, Score, WRONG_DEPTH};
use vibrissa::trial::Trial;

use crate::runs::mapped_trial;

/// A run that stands still for a second, so that its map has the ground below the body, and its trial.
fn still() -> (Trial, Run) {
    let trial = mapped_trial("tell map.go_to(body.position, body.yaw)", 1.0);
    let run = trial.run().unwrap().run;
    (trial, run)
}

fn map(run: &Run) -> &RunMap {
    run.map.as_deref().unwrap()
}

#[test]
fn ground_that_the_body_has_covered_is_free_and_not_wrong() {
    let (trial, run) = still();
    let figures = MapFigures::new(&map(&run).last, &trial.scene.truth.surfaces);
    let platform = &trial.scene.rig.platform;
    let body = platform.length * 0.5 * (platform.tail_width + platform.nose_width);
    assert!(figures.free > 0.8 * body && figures.free < 1.1 * body, "{} m^2 of {body} m^2", figures.free);
    assert!(figures.wrong_free.abs() < 1e-15, "{} m^2", figures.wrong_free);
    let (unknown, near) = (figures.unknown, figures.unknown_near.unwrap());
    assert!(unknown > 0.0 && (near - trial.scene.start.position).norm() < platform.length, "{near}");
}

#[test]
fn the_reason_of_a_run_says_what_is_left() {
    let (trial, run) = still();
    let reason = run.reason.unwrap();
    assert!(reason.starts_with("the map was not complete within 1 s; the map is not complete: 0.0 % of"), "{reason}");
    assert!(reason.contains(" m² beside free ground are unknown, most near ("), "{reason}");
    let plain = mapped_trial("", 1.0);
    let mut plain = Trial { scene: trial.scene, ..plain };
    plain.scene.stop.mapped = false;
    let result = plain.run().unwrap();
    assert_eq!((result.run.reason, result.score.map), (None, None));
}

#[test]
fn a_score_has_the_figures_of_the_map() {
    let (trial, run) = still();
    let score = Score::new(&run, &trial.scene.truth, &trial.scene.rig);
    assert_eq!(score.map, Some(MapFigures::new(&map(&run).last, &trial.scene.truth.surfaces)));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn free_ground_in_an_object_is_wrong_beyond_its_rim(radius in 0.005..0.02_f64, x in -0.02..0.02_f64, y in -0.01..0.01_f64) {
        let (trial, run) = still();
        let centre = trial.scene.start.point_to_world(Point2::new(x, y));
        let object = ContourSet::from(circle(centre, radius).unwrap());
        let map = &map(&run).last;
        let wrong = MapFigures::new(map, &object).wrong_free;
        let inner = radius - WRONG_DEPTH;
        // The number of cells in a disk is uncertain by those on its rim.
        let rim = 2.0 * PI * inner * map.cell_size() + map.cell_size().powi(2);
        prop_assert!((wrong - PI * inner * inner).abs() < 0.5 * rim, "{wrong} m^2 in {radius} m");
    }
}
