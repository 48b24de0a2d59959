//! Runs made by hand, for tests of what is made of runs.
#![allow(dead_code, reason = "every test file uses a part of it")]

use std::time::Duration;

use vibrissa::built_in::SCENARIOS;
use vibrissa::diagnostic::Source;
use vibrissa::geometry::{Point2, Pose, Vector2, unit};
use vibrissa::request::{Input, PolicyInput, TrialRequest};
use vibrissa::run::{Run, TickRecord, Trace, WhiskerRecord};
use vibrissa::scene::{Outcome, Stop, WorldKind};
use vibrissa::trial::Trial;
use vibrissa_runtime::signal::Command;

/// Time between ticks (s).
const PERIOD: f64 = 1.0 / 30.0;

/// A completed run that recorded `tips`, one list a whisker, one entry a tick. The platform goes up the y axis at 50 mm/s,
/// and its whiskers are bent by 300 µrad, one to each side.
pub(crate) fn run_with(tips: &[Vec<Option<Point2>>]) -> Run {
    let count = tips.iter().map(Vec::len).max().unwrap_or(0);
    let ticks = (0..count).map(|index| {
        let time = (index + 1) as f64 * PERIOD;
        let whiskers = tips.iter().enumerate().map(|(whisker, tips)| WhiskerRecord {
            deflection: if whisker % 2 == 0 { 3e-4 } else { -3e-4 },
            tip: tips.get(index).copied().flatten(),
            tip_deviation: 1e-3,
            ..WhiskerRecord::default()
        });
        TickRecord {
            time,
            body: Pose { position: Point2::new(0.0, 0.05 * time), heading: std::f64::consts::FRAC_PI_2 },
            state: Some(usize::from(index >= count / 3)),
            whiskers: whiskers.collect(),
            command: Command { velocity_world: Vector2::new(0.0, 0.05), yaw_rate: 0.0 },
            fallback: None,
            body_touches: false,
        }
    });
    Run {
        outcome: Outcome::Completed,
        reason: None,
        final_state: "Swiping".to_owned(),
        trace: Trace {
            whiskers: (0..tips.len()).map(|whisker| format!("w{whisker}")).collect(),
            states: vec!["Exploring".to_owned(), "Swiping".to_owned()],
            parents: vec![None; 2],
            period: PERIOD,
            ticks: ticks.collect(),
            marks: vec![],
            plots: vec![],
            messages: vec![],
            further_messages: 0,
            crashed: false,
        },
        map: None,
        contracts: vec![],
        wall: Duration::from_millis(8),
        start: Duration::from_millis(40),
        tick_times: (0..count).map(|index| Duration::from_nanos(1000 + index as u64)).collect(),
    }
}

/// Tips every `step` (m) or a little less along the arc of `radius` (m) about the origin from `start` over `sweep` (rad),
/// both ends among them.
pub(crate) fn arc_of_tips(radius: f64, start: f64, sweep: f64, step: f64) -> Vec<Option<Point2>> {
    let count = (radius * sweep.abs() / step).ceil();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small whole number")]
    let count_tips = count as usize + 1;
    (0..count_tips).map(|k| Some(Point2::from(radius * unit(start + sweep * (k as f64 / count))))).collect()
}

/// A policy that stands still on the disk and does something with the map, for at most this time (s). Its map has to be complete.
pub(crate) fn mapped_trial(does: &str, time: f64) -> Trial {
    let still = format!("machine still\n\nwhisker r0\n\ninitial Still\n\nstate Still {{ {does} stop }}\n");
    let request = TrialRequest {
        policy: Some(PolicyInput::Text(Source::new("still.fsm", still))),
        world: Some(WorldKind::QuasiStatic),
        ..TrialRequest::new(Input::BuiltIn(&SCENARIOS[0]))
    };
    let mut trial = request.prepare().unwrap().trial;
    trial.scene.stop = Stop { mapped: true, ..Stop::at(time) };
    trial
}
