//! What a run tells of every tick.

use std::f64::consts::FRAC_PI_2;

use crate::runs::{arc_of_tips, run_with};
use serde_json::{Value, json};
use vibrissa::geometry::{Point2, Vector2};
use vibrissa::results::tick_lines;
use vibrissa::run::{Contact, MarkRecord, Run};
use vibrissa::score::InclinationFigures;
use vibrissa_runtime::machine::Mark;

/// A run of one whisker that recorded in every tick but the first.
fn run() -> Run {
    let mut tips = arc_of_tips(0.3, 0.0, 1.0, 0.01);
    tips[0] = None;
    run_with(&[tips])
}

/// The coefficient of friction that perception assumes.
const FRICTION: f64 = 0.1;

fn lines(run: &Run) -> Vec<Value> {
    tick_lines("box", &run.trace, FRICTION).map(|line| serde_json::to_value(line).unwrap()).collect()
}

#[test]
fn there_is_a_line_for_every_tick_with_its_time_state_pose_and_command() {
    let run = run();
    let lines = lines(&run);
    assert_eq!(lines.len(), run.trace.ticks.len());
    for (line, tick) in lines.iter().zip(&run.trace.ticks) {
        assert_eq!(line["scenario"], "box");
        assert_eq!(line["time_s"], tick.time);
        assert_eq!(line["state"], run.trace.states[tick.state.unwrap()]);
        assert_eq!(line["position_m"], json!([tick.body.position.x, tick.body.position.y]));
        assert_eq!(line["heading_rad"], tick.body.heading);
        assert_eq!(line["velocity_m_s"], json!([0.0, 0.05]));
        assert_eq!(line["yaw_rate_rad_s"], 0.0);
        assert_eq!(line["whiskers"][0]["whisker"], "w0");
        assert_eq!(line["whiskers"][0]["deflection_rad"], 3e-4);
        assert_eq!(line["whiskers"][0]["springs"], tick.whiskers[0].snap_off);
        assert_eq!(line["whiskers"][0]["recorded"], tick.whiskers[0].tip.is_some());
    }
}

#[test]
fn a_tip_is_told_whether_recorded_or_not_and_what_is_not_known_is_null() {
    let mut run = run();
    run.trace.ticks[0].whiskers[0].contact = Contact {
        is_touching: true,
        tip_world: Some(Point2::new(1.0, 2.0)),
        tangent_world: Some(Vector2::new(0.0, 1.0)),
        inclination: None,
    };
    let lines = lines(&run);
    let told =
        |tick: usize| ["touching", "tip_m", "tangent", "recorded"].map(|key| lines[tick]["whiskers"][0][key].clone());
    assert_eq!(told(0), [json!(true), json!([1.0, 2.0]), json!([0.0, 1.0]), json!(false)]);
    assert_eq!(told(1), [json!(false), Value::Null, Value::Null, json!(true)]);
}

#[test]
fn a_mark_stands_in_the_line_of_its_tick() {
    let mut run = run();
    let mark = |mark, tick| MarkRecord { mark, whisker: 0, tick, tip_world: Point2::origin() };
    run.trace.marks = vec![mark(Mark::Lost, 2), mark(Mark::Lost, 5), mark(Mark::Found, 5)];
    let lines = lines(&run);
    let marks = |tick: usize| lines[tick]["whiskers"][0]["marks"].clone();
    assert_eq!([1, 2, 5].map(marks), [json!([]), json!(["lost"]), json!(["lost", "found"])]);
}

#[test]
fn a_run_that_failed_has_no_state_at_its_end() {
    let mut run = run();
    run.trace.ticks.last_mut().unwrap().state = None;
    assert_eq!(lines(&run).last().unwrap()["state"], Value::Null);
}

#[test]
fn a_tick_has_the_margin_of_its_inclination() {
    let mut run = run();
    run.trace.ticks[1].whiskers[0].contact.inclination = Some(100_f64.to_radians());
    let lines = lines(&run);
    let told = |tick: usize, key: &str| lines[tick]["whiskers"][0][key].as_f64();
    assert_eq!(told(0, "inclination_margin_rad"), None);
    let sum = told(1, "inclination_rad").unwrap() + told(1, "inclination_margin_rad").unwrap();
    assert!((sum - FRAC_PI_2 - FRICTION.atan()).abs() < 1e-12, "{sum}");
}

/// The limit of the inclination in a whole run: where, when and in which state its margin is least, and who breaks it.
#[test]
fn a_result_has_the_least_margin_and_the_states_beyond_the_limit() {
    let mut run = run();
    let inclinations = [None, Some(80.0), Some(100.0), Some(110.0), Some(95.0)];
    for (tick, inclination) in run.trace.ticks.iter_mut().zip(inclinations) {
        tick.whiskers[0].contact.inclination = inclination.map(f64::to_radians);
        tick.whiskers[0].contact.tip_world = Some(Point2::new(tick.time, 2.0));
    }
    let figures = InclinationFigures::of(&run.trace, FRICTION).unwrap();
    let ticks = &run.trace.ticks;
    assert_eq!(
        (figures.largest.whisker, figures.largest.time, figures.largest.state),
        (0, ticks[3].time, ticks[3].state)
    );
    assert_eq!(figures.largest.tip_world, ticks[3].whiskers[0].contact.tip_world);
    assert!((figures.margin.to_degrees() - (FRICTION.atan().to_degrees() - 20.0)).abs() < 1e-9);
    // 95 deg is within the limit, which friction moves to 95.7 deg.
    assert!((figures.beyond - 2.0 * run.trace.period).abs() < 1e-12);
    assert!((figures.beyond_by_state.values().sum::<f64>() - figures.beyond).abs() < 1e-12);
    assert!(InclinationFigures::of(&run.trace, 1.0).unwrap().beyond_by_state.is_empty());
}
