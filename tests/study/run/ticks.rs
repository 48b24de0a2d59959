//! What a run tells of every tick.

use crate::runs::{arc_of_tips, run_with};
use serde_json::{Value, json};
use vibrissa::geometry::{Point2, Vector2};
use vibrissa::results::tick_lines;
use vibrissa::run::{Contact, MarkRecord, Run};
use vibrissa_runtime::machine::Mark;

/// A run of one whisker that recorded in every tick but the first.
fn run() -> Run {
    let mut tips = arc_of_tips(0.3, 0.0, 1.0, 0.01);
    tips[0] = None;
    run_with(&[tips])
}

fn lines(run: &Run) -> Vec<Value> {
    tick_lines("box", &run.trace).map(|line| serde_json::to_value(line).unwrap()).collect()
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
        assert_eq!(line["whiskers"][0]["springs"], tick.snap_offs[0]);
        assert_eq!(line["whiskers"][0]["recorded"], tick.tips[0].is_some());
    }
}

#[test]
fn a_tip_is_told_whether_recorded_or_not_and_what_is_not_known_is_null() {
    let mut run = run();
    run.trace.ticks[0].contacts[0] = Contact {
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
