//! Retrievals against closed forms, and a policy that loses and finds in a world of its own.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::ops::ControlFlow;
use std::sync::Arc;

use crate::runs::run_with;
use proptest::prelude::*;
use vibrissa::geometry::{Point2, Pose, unit};
use vibrissa::run::{MarkRecord, Progress, Trace, drive};
use vibrissa::scene::{Goal, Stop};
use vibrissa::score::{RetrievalFigures, mark_positions, retrievals};
use vibrissa::world::{Fault, World};
use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::Mark;
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{Command, MAX_WHISKERS, Reading, Sample};

fn near(found: f64, due: f64) -> bool {
    (found - due).abs() < 1e-9
}

/// A trace of `count` ticks of two whiskers. The body goes round the origin at `radius` (m) by `step` (rad) a tick; the tips are
/// recorded where `tip` says.
fn trace(count: usize, radius: f64, step: f64, tip: impl Fn(usize) -> Option<Point2>) -> Trace {
    let mut trace = run_with(&[(0..count).map(tip).collect(), vec![None; count]]).trace;
    for (index, tick) in trace.ticks.iter_mut().enumerate() {
        tick.body = Pose { position: Point2::from(radius * unit(step * index as f64)), heading: 0.0 };
    }
    trace
}

fn marked(mut trace: Trace, marks: &[(Mark, usize, usize, Point2)]) -> Trace {
    trace.marks =
        marks.iter().map(|&(mark, whisker, tick, tip_world)| MarkRecord { mark, whisker, tick, tip_world }).collect();
    trace
}

const EDGE: Point2 = Point2::new(0.3, 0.4);
const AWAY: Point2 = Point2::new(9.0, 9.0);

proptest! {
    #[test]
    fn a_retrieval_on_a_circle_has_its_radius_and_the_length_of_the_bodys_arc(
        edge_tick in 0..40_usize, notice in 0..5_usize, search in 1..60_usize, bearing in 0.0..TAU, radius in 1e-3..0.05_f64,
        step in 1e-4..0.02_f64, body in 0.01..0.5_f64,
    ) {
        let retrieved = EDGE + radius * unit(bearing);
        let (lost, found) = (edge_tick + notice, edge_tick + notice + search);
        // Tips come nearer to the edge point, and are recorded until then.
        let tip = |tick: usize| (tick <= edge_tick).then(|| EDGE - 0.001 * (edge_tick - tick) as f64 * unit(0.0));
        let trace = marked(
            trace(found + 3, body, step, tip),
            &[(Mark::Lost, 0, lost, AWAY), (Mark::Found, 0, found, retrieved)],
        );
        let found_again = retrievals(&trace);
        prop_assert_eq!(found_again.len(), 1);
        let retrieval = found_again[0];
        prop_assert_eq!((retrieval.edge_world, retrieval.retrieved_world), (EDGE, retrieved));
        prop_assert!(near(retrieval.radius, radius));
        // Ticks on a circle are chords apart.
        let ticks = (found - edge_tick) as f64;
        prop_assert!(near(retrieval.distance, ticks * 2.0 * body * (0.5 * step).sin()));
        prop_assert!(near(retrieval.time, ticks * trace.period));
    }

    #[test]
    fn every_found_ends_the_first_lost_of_its_whisker(marks in prop::collection::vec((0..2_usize, any::<bool>()), 0..40)) {
        let of = |is_lost| if is_lost { Mark::Lost } else { Mark::Found };
        let marks: Vec<_> =
            marks.iter().enumerate().map(|(tick, &(whisker, is_lost))| (of(is_lost), whisker, tick, EDGE)).collect();
        let trace = marked(trace(40, 0.1, 0.01, |_| None), &marks);
        let mut due = Vec::new();
        for whisker in 0..2 {
            let own: Vec<_> = marks.iter().filter(|mark| mark.1 == whisker).collect();
            // A retrieval is a stretch of `lost` with a `found` behind it.
            for (index, mark) in own.iter().enumerate() {
                let begins = mark.0 == Mark::Lost && (index == 0 || own[index - 1].0 == Mark::Found);
                let end = own[index..].iter().find(|later| later.0 == Mark::Found);
                if let (true, Some(end)) = (begins, end) {
                    due.push((whisker, (end.2 - mark.2) as f64 * trace.period));
                }
            }
        }
        let mut found: Vec<_> = retrievals(&trace).iter().map(|retrieval| (retrieval.whisker, retrieval.time)).collect();
        found.sort_by_key(|&(whisker, _)| whisker);
        prop_assert_eq!(found.len(), due.len());
        for (found, due) in found.iter().zip(&due) {
            prop_assert!(found.0 == due.0 && near(found.1, due.1), "{found:?} {due:?}");
        }
    }
}

#[test]
fn figures_are_those_of_all_retrievals_and_there_are_none_without_marks() {
    let at = |radius: f64| EDGE + radius * unit(1.0);
    let tip = |tick: usize| (tick % 50 < 10).then_some(EDGE);
    let bare = trace(200, 0.1, 0.01, tip);
    assert_eq!(RetrievalFigures::new(&bare), None);
    let lost_only = RetrievalFigures::new(&marked(bare.clone(), &[(Mark::Lost, 0, 12, AWAY)])).unwrap();
    assert_eq!((lost_only.count, lost_only.radius), (0, None));
    let marks = [
        (Mark::Lost, 0, 12, AWAY),
        (Mark::Found, 0, 29, at(0.008)),
        (Mark::Lost, 0, 62, AWAY),
        (Mark::Found, 0, 79, at(0.012)),
    ];
    let figures = RetrievalFigures::new(&marked(bare, &marks)).unwrap();
    assert_eq!(figures.count, 2);
    let radius = figures.radius.unwrap();
    assert!(near(radius.mean, 0.010) && near(radius.std.unwrap(), 0.004 / 2.0_f64.sqrt()));
    assert!(near(figures.time.unwrap().mean, 20.0 / 30.0) && near(figures.time.unwrap().std.unwrap(), 0.0));
}

#[test]
fn a_mark_without_a_place_counts_as_not_made_and_a_pose_that_is_none_is_passed_over() {
    let nowhere = Point2::new(f64::NAN, 0.0);
    let marks = [
        (Mark::Lost, 0, 5, nowhere),
        (Mark::Lost, 1, 5, EDGE),
        (Mark::Found, 0, 9, EDGE),
        (Mark::Found, 1, 9, nowhere),
    ];
    let mut trace = marked(trace(20, 0.1, 0.01, |_| None), &marks);
    assert_eq!(mark_positions(&trace).len(), 2);
    assert_eq!(retrievals(&trace), []);
    trace.marks.push(MarkRecord { mark: Mark::Found, whisker: 1, tick: 15, tip_world: EDGE });
    trace.ticks[8].body = Pose::UNKNOWN;
    let chord = |ticks: f64| 0.2 * (0.005 * ticks).sin();
    assert!(near(retrievals(&trace)[0].distance, 8.0 * chord(1.0) + chord(2.0)));
}

/// A world without walls: the body goes as it is told, and the right whisker is bent at the ticks that are said.
struct Stage {
    bent: fn(usize) -> bool,
    tick: usize,
    body: Pose,
    samples: [Sample; 10],
}

impl World for Stage {
    fn advance(&mut self, command: &Command) -> Result<&[Sample], Fault> {
        for index in 0..self.samples.len() {
            self.body.position += command.velocity_world / 300.0;
            self.body.heading += command.yaw_rate / 300.0;
            let mut whiskers = [Reading::default(); MAX_WHISKERS];
            whiskers[0].base_angle = if (self.bent)(self.tick) { -3e-4 } else { 0.0 };
            let time = (10 * self.tick + index + 1) as f64 / 300.0;
            self.samples[index] = Sample { time, body: self.body, whiskers };
        }
        self.tick += 1;
        Ok(&self.samples)
    }

    fn body_touches(&self) -> bool {
        false
    }

    fn snapped_off(&self, _whisker: usize) -> bool {
        false
    }

    fn tip(&self, _whisker: usize) -> Point2 {
        self.body.position
    }
}

#[test]
fn a_policy_that_loses_an_edge_and_finds_it_again_is_measured_from_its_last_touch() {
    let text = "machine retrieving whisker r0 initial Following
        state Following {
          record r0
          steer body along vector(0, 1) at 50 mm/s turning 0 deg/s
          when not r0.touching for 100 ms -> Searching
          exit { mark lost r0 }
        }
        state Searching {
          steer body along vector(1, 0) at 30 mm/s turning 0 deg/s
          when r0.touching -> Following
          exit { mark found r0 }
        }";
    let control = Control::new(&Rig::default(), Arc::new(crate::common::program(text))).unwrap();
    let body = Pose { position: Point2::origin(), heading: FRAC_PI_2 };
    let sample = Sample { time: 0.0, body, whiskers: [Reading::default(); MAX_WHISKERS] };
    let bent = |tick| !(60..90).contains(&tick);
    let mut stage = Stage { bent, tick: 0, body, samples: [sample; 10] };
    let goal = Goal { stop: &Stop::at(5.0), tunnels: &[] };
    let run = drive(&mut stage, control, goal, 1.0 / 30.0, &mut Progress(|_: &Trace| ControlFlow::Continue(())));
    let run = run.unwrap();
    let found = retrievals(&run.trace);
    assert_eq!(found.len(), 1);
    let ticks = &run.trace.ticks;
    let last = (0..90).rev().find(|&tick| ticks[tick].whiskers[0].tip.is_some()).unwrap();
    let again = (last + 1..ticks.len()).find(|&tick| ticks[tick].whiskers[0].deflection.abs() > 2e-5).unwrap();
    let turned = ticks.iter().position(|tick| tick.state == Some(1)).unwrap();
    assert_eq!(Some(found[0].edge_world), ticks[last].whiskers[0].tip);
    assert!(near(found[0].time, (again - last) as f64 / 30.0));
    // A command counts for the tick after it.
    let due = (0.05 * (turned - last) as f64 + 0.03 * (again - turned) as f64) / 30.0;
    assert!(near(found[0].distance, due), "{} {due}", found[0].distance);
    assert!(found[0].radius > 0.01 && found[0].radius < 0.08, "{}", found[0].radius);
}
