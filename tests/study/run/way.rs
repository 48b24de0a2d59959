//! What the platform did: its way, its contacts, its states, its place in a tunnel; against closed forms.

use crate::runs::{arc_of_tips, run_with};
use proptest::prelude::*;
use vibrissa::geometry::{Contour, Piece, Point2, Pose, TunnelAxis, circle};
use vibrissa::run::Trace;
use vibrissa::score::{Collisions, Score, axis_error, body_path, state_shares};
use vibrissa_runtime::rig::Rig;

/// A tunnel up the y axis, from 0 to 1 m, wide enough for all of these tips.
fn tunnel() -> [TunnelAxis; 1] {
    let up = |x| Contour::open(vec![Piece::segment(Point2::new(x, 0.0), Point2::new(x, 1.0))]).unwrap();
    [TunnelAxis::new(up(0.0), up(-0.5), up(0.5))]
}

/// A run up the y axis that records tips at `left` and `right` (m, to the right of the axis) beside the platform.
fn between(left: f64, right: f64, count: usize) -> Trace {
    let beside = |x: f64| (0..count).map(|tick| Some(Point2::new(x, 0.05 * (tick + 1) as f64 / 30.0))).collect();
    run_with(&[beside(right), beside(left)]).trace
}

proptest! {
    #[test]
    fn the_axis_error_is_that_of_the_midpoints(left in -0.2..-0.01_f64, right in 0.01..0.2_f64) {
        let error = axis_error(&between(left, right, 60), &tunnel()).unwrap();
        prop_assert!((error.mean - 0.5 * (left + right).abs()).abs() < 1e-12);
        prop_assert!(error.std.unwrap() < 1e-12);
    }

    #[test]
    fn of_several_whiskers_a_side_the_mean_counts(extra in 0.01..0.2_f64) {
        let mut trace = between(-0.1, 0.1, 30);
        for tick in &mut trace.ticks {
            let mut third = tick.whiskers[0];
            third.tip = third.tip.map(|tip| Point2::new(extra, tip.y));
            tick.whiskers = [&*tick.whiskers, &[third]].concat().into();
        }
        let error = axis_error(&trace, &tunnel()).unwrap();
        prop_assert!((error.mean - 0.5 * (0.5 * (0.1 + extra) - 0.1).abs()).abs() < 1e-12);
    }
}

#[test]
fn only_ticks_with_both_walls_and_beside_the_axis_count() {
    let mut trace = between(-0.1, 0.12, 60);
    for tick in &mut trace.ticks[..30] {
        tick.whiskers[1].tip = None;
    }
    for tick in &mut trace.ticks[30..40] {
        tick.whiskers[0].tip = tick.whiskers[0].tip.map(|tip| Point2::new(0.3, tip.y));
    }
    let error = axis_error(&trace, &tunnel()).unwrap();
    assert!((error.mean - (10.0 * 0.1 + 20.0 * 0.01) / 30.0).abs() < 1e-12);
    let beyond = between(-0.1, 0.12, 900);
    let inside = axis_error(&beyond, &tunnel()).unwrap();
    assert!((inside.mean - 0.01).abs() < 1e-12, "what lies beyond its end does not count");
    assert_eq!(axis_error(&run_with(&[vec![Some(Point2::new(0.1, 0.1)); 9]]).trace, &tunnel()), None);
}

#[test]
fn a_left_side_is_that_of_the_body_whichever_way_it_goes() {
    let mut trace = between(-0.1, 0.12, 30);
    for tick in &mut trace.ticks {
        tick.body.heading = -std::f64::consts::FRAC_PI_2;
    }
    assert!((axis_error(&trace, &tunnel()).unwrap().mean - 0.01).abs() < 1e-12);
}

#[test]
fn the_way_is_that_of_the_centre_of_mass_and_leaves_out_what_is_no_pose() {
    let mut run = run_with(&[arc_of_tips(0.3, 0.0, 1.0, 0.05 / 30.0)]);
    let due = 0.05 * (run.trace.ticks.len() - 1) as f64 / 30.0;
    assert!((body_path(&run.trace.ticks) - due).abs() < 1e-12);
    run.trace.ticks[7].body = Pose::UNKNOWN;
    let score = Score::new(&run, &circle(Point2::origin(), 0.3).unwrap().into(), &Rig::default());
    assert!((score.path - due).abs() < 1e-12);
    assert!((score.path_ratio - due / (0.6 * std::f64::consts::PI)).abs() < 1e-12);
    assert!(body_path(&[]).is_sign_positive());
}

#[test]
fn contacts_a_tenth_of_a_second_apart_are_separate_and_a_crash_is_one() {
    let mut trace = run_with(&[vec![None; 60]]).trace;
    assert_eq!(Collisions::of(&trace), Collisions::default());
    for tick in [3, 4, 7, 11, 30] {
        trace.ticks[tick].body_touches = true;
    }
    let collisions = Collisions::of(&trace);
    assert_eq!(collisions.count, 3, "3 to 7, 11, 30");
    assert!((collisions.time - 5.0 / 30.0).abs() < 1e-12);
    let (first, third) = (collisions.first.unwrap(), &trace.ticks[3]);
    assert_eq!((first.time, first.position, first.state), (third.time, third.body.position, third.state));
    trace.crashed = true;
    assert_eq!(Collisions::of(&trace).count, 4);
    trace.ticks[58].body_touches = true;
    assert_eq!(Collisions::of(&trace).count, 4, "the contact that it ended in");
}

#[test]
fn the_shares_of_the_states_add_up_to_one() {
    let mut trace = run_with(&[vec![None; 90]]).trace;
    let share =
        |trace: &Trace| state_shares(trace).into_iter().map(|share| (share.state, share.share)).collect::<Vec<_>>();
    assert_eq!(share(&trace), [("Exploring".to_owned(), 30.0 / 90.0), ("Swiping".to_owned(), 60.0 / 90.0)]);
    trace.ticks[89].state = None;
    assert_eq!(share(&trace)[2], ("Failure".to_owned(), 1.0 / 90.0));
    assert_eq!(share(&run_with(&[]).trace), []);
}
