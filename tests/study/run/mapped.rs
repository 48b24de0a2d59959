//! Runs of policies that use a map.

use vibrissa::report::{growth_picture, picture};
use vibrissa::scene::{Outcome, Stop};
use vibrissa::trial::ExecuteError;

use crate::runs::mapped_trial as trial;

#[test]
fn a_run_without_a_map_cannot_end_with_one() {
    let refusal = trial("", 5.0).run().unwrap_err();
    assert!(matches!(&refusal, ExecuteError::NoMap { policy } if policy == "still"), "{refusal}");
    let mut free = trial("", 5.0);
    free.scene.stop = Stop::at(1.0);
    assert!(free.run().unwrap().run.map.is_none());
}

#[test]
fn a_run_is_completed_as_soon_as_its_map_is_complete() {
    // All targets about the body fail one after the other, so that nothing is left to be looked at.
    let result = trial("tell map.give_up", 300.0).run().unwrap();
    let time = result.run.trace.ticks.last().unwrap().time;
    assert_eq!(result.run.outcome, Outcome::Completed, "{:?}", result.run.reason);
    assert!(time < 299.0, "{time} s");
    assert!(result.run.map.is_some_and(|map| map.last.is_complete()));
}

#[test]
fn a_run_whose_map_stays_incomplete_times_out() {
    let result = trial("tell map.go_to(body.position, body.yaw)", 4.0).run().unwrap();
    assert_eq!(result.run.outcome, Outcome::Timeout);
    assert!(result.run.reason.is_some_and(|reason| reason.starts_with("the map was not complete within 4 s")));
    // The map grows only, and the stages are in the order of time.
    let map = result.run.map.unwrap();
    assert!(map.stages.len() >= 3 && map.stages.is_sorted_by_key(|stage| stage.tick));
    let area = |stage: &vibrissa::run::MapStage| -> f64 {
        let areas = stage.free.iter().map(|span| (span.high - span.low).product());
        areas.sum()
    };
    let areas: Vec<f64> = map.stages.iter().map(area).chain([map.last.free_area()]).collect();
    assert!(areas[0] > 0.0 && areas.windows(2).all(|pair| pair[0] <= pair[1] + 1e-12), "{areas:?}");
}

#[test]
fn a_picture_shows_the_map_and_a_strip_how_it_grew() {
    let mapped = trial("tell map.go_to(body.position, body.yaw)", 8.0);
    let result = mapped.run().unwrap();
    let scene = &mapped.scene;
    let drawn = picture(scene, "still", &result.run, &result.score);
    assert!(drawn.contains("Map by touch") && drawn.len() < 200_000, "{} bytes", drawn.len());
    let map = result.run.map.as_deref().unwrap();
    let grown = growth_picture(scene, "still", &result.run.trace, map);
    assert_eq!(grown.matches("<clipPath").count(), 6);
    assert!(grown.contains("\n8 s\n") && grown.len() < 400_000, "{} bytes", grown.len());
    let mut plain = trial("", 1.0);
    plain.scene.stop.mapped = false;
    let result = plain.run().unwrap();
    assert!(!picture(scene, "still", &result.run, &result.score).contains("Map by touch"));
}
