//! What people and programs get to see of a run.

use std::collections::BTreeSet;
use std::f64::consts::TAU;

use crate::runs::{arc_of_tips, run_with};
use crate::seen::{apart, see};
use crate::snapshots::snapshots;
use proptest::prelude::*;
use vibrissa::diagnostic::Source;
use vibrissa::figures::Metric;
use vibrissa::geometry::{Contour, Point2, circle};
use vibrissa::report::{picture, results_table, retrieval_picture};
use vibrissa::results::{Ending, Hashes, Identity, RunResult};
use vibrissa::run::{MarkRecord, Run};
use vibrissa::scenario;
use vibrissa::scene::{Outcome, Scene};
use vibrissa::score::{Score, retrievals};
use vibrissa_runtime::machine::{ActionPart, Cause, Fallback, Mark, NonFinite};
use vibrissa_runtime::rig::Rig;

fn disk() -> Contour {
    circle(Point2::origin(), 0.3).unwrap()
}

/// A run half round the disk of 0.3 m, a quarter of a millimetre outside of it.
fn half_round() -> Run {
    run_with(&[arc_of_tips(0.30025, 0.0, 0.5 * TAU, 0.05 / 30.0), vec![]])
}

fn result(run: &Run) -> RunResult {
    RunResult::new(identity(), run, &Score::new(run, &disk().into(), &Rig::default()), &[])
}

fn identity() -> Identity {
    let [scenario, policy, engine] = ["5ce0", "7a11", "3a71"].map(str::to_owned);
    Identity {
        scenario: "disk".to_owned(),
        policy: "thesis".to_owned(),
        true_tips: false,
        world: "mujoco".to_owned(),
        seed: 7,
        mismatch: None,
        calibration: None,
        friction: None,
        hash: Hashes { scenario, policy, engine },
    }
}

/// The result as JSON in the order of its keys, with figures to a thousandth, so that they hold across machines.
fn json(result: &RunResult) -> String {
    let text = serde_json::to_string_pretty(result).unwrap();
    let rounded = text.lines().map(|line| {
        let Some((key, value)) = line.split_once(": ") else { return line.to_owned() };
        let number = value.trim_end_matches(',');
        let Ok(figure) = number.parse::<f64>() else { return line.to_owned() };
        if number.contains('.') { format!("{key}: {figure:.3}{}", &value[number.len()..]) } else { line.to_owned() }
    });
    rounded.collect::<Vec<_>>().join("\n")
}

#[test]
fn a_result_has_the_keys_of_the_command_line() {
    let mut lost = run_with(&[]);
    lost.outcome = Outcome::Failed;
    lost.reason = Some("the whisker lost the object".to_owned());
    lost.wall = std::time::Duration::ZERO;
    snapshots("report").bind(|| {
        for (name, run) in [("result", half_round()), ("result_of_nothing", lost)] {
            insta::assert_snapshot!(name, json(&result(&run)));
        }
    });
}

#[test]
fn a_result_tells_of_failsafes() {
    let mut run = half_round();
    let flaw = NonFinite { part: ActionPart::Speed, is_nan: true };
    for tick in [7, 300] {
        run.trace.ticks[tick].fallback = Some(Fallback { left: 1, cause: Cause::NotFinite(flaw) });
    }
    let failsafes = result(&run).failsafes;
    assert_eq!((failsafes.count, failsafes.first_state.as_deref()), (2, Some("Swiping")));
    assert_eq!(failsafes.first_s, Some(run.trace.ticks[7].time));
    assert_eq!(
        failsafes.first_cause.as_deref(),
        Some("its command was not finite: the speed behind `at` is not a number")
    );
}

/// The run of [`half_round`], lost and found again twice.
fn retrieved() -> Run {
    let mut run = half_round();
    let mark = |(mark, tick): (Mark, usize)| MarkRecord {
        mark,
        whisker: 0,
        tick,
        tip_world: run.trace.ticks[tick].whiskers[0].tip.unwrap(),
    };
    run.trace.marks = [(Mark::Lost, 90), (Mark::Found, 120), (Mark::Lost, 300), (Mark::Found, 345)].map(mark).into();
    run
}

#[test]
fn a_result_tells_of_retrievals_and_a_picture_shows_them() {
    let run = retrieved();
    let result = result(&run);
    assert_eq!(result.figure(Metric::Retrievals), Some(2.0));
    // The platform of these runs goes at 50 mm/s.
    let figure = |metric| result.figure(metric).unwrap();
    assert!((figure(Metric::RetrievalDistance) - 62.5).abs() < 1e-9);
    assert!((figure(Metric::RetrievalTime) - 1.25).abs() < 1e-9 && figure(Metric::RetrievalRadiusStd) > 0.0);
    let picture = draw(&scene(), "thesis", &run);
    texts_stand_clear(&picture);
    assert!(picture.contains("edge lost") && picture.contains("contact found again") && picture.contains("retrievals"));
    assert!(!draw(&scene(), "thesis", &half_round()).contains("edge lost"));
}

#[test]
fn a_table_has_columns_for_corners_and_collisions_only_where_a_run_has_them() {
    let bare = results_table(&[result(&half_round())]).wide();
    assert!(!bare.contains("corners") && !bare.contains("collisions") && !bare.contains("retrieval"), "{bare}");
    let mut run = retrieved();
    run.trace.ticks[9].body_touches = true;
    let outline = vibrissa::geometry::regular_polygon(Point2::origin(), 0.3, 4, 0.0).unwrap();
    let score = Score::new(&run, &outline.into(), &Rig::default());
    let square = RunResult::new(identity(), &run, &score, &[]);
    let full = results_table(&[result(&half_round()), square]).wide();
    assert!(full.contains(" of 4") && full.contains("collisions") && full.contains("retrieval"), "{full}");
}

#[test]
fn figures_that_are_no_numbers_are_null() {
    let run = run_with(&[vec![Some(Point2::new(1e300, 0.0)); 3]]);
    let json = serde_json::to_value(result(&run)).unwrap();
    assert!(json["error_mm"]["mean"].is_null());
    assert_eq!(json["error_mm"]["n"], 3);
}

#[test]
fn a_table_has_a_line_a_run() {
    let mut lost = result(&run_with(&[]));
    lost.scenario = "rounded rectangle".to_owned();
    lost.outcome = Ending::Failed;
    lost.realtime = None;
    snapshots("report")
        .bind(|| insta::assert_snapshot!("table", results_table(&[result(&half_round()), lost]).fitted()));
}

/// A scene of the disk of [`half_round`].
fn scene() -> Scene {
    let text = "
name: disk
objects: [{circle: {centre: [0 m, 0 m], radius: 0.3 m}}]
start: {position: [0 m, -0.6 m], heading: 90 deg}
stop: {time: 120 s}
";
    scenario::read(&Source::new("disk.yaml", text)).unwrap()
}

fn draw(scene: &Scene, policy: &str, run: &Run) -> String {
    picture(scene, policy, run, &Score::new(run, &scene.truth, &scene.rig))
}

fn texts_stand_clear(picture: &str) {
    let texts = see(picture).texts;
    for (index, (a, place)) in texts.iter().enumerate() {
        assert!(place[0] >= 0.0 && place[1] >= 0.0 && place[2] <= 1200.0, "{a} is cut off");
        for (b, other) in &texts[..index] {
            assert!(apart(place, other), "`{a}` and `{b}` overlap");
        }
    }
}

#[test]
fn a_picture_names_scene_policy_and_outcome_and_no_text_hides_another() {
    let picture = draw(&scene(), "thesis", &half_round());
    let labels: Vec<_> = see(&picture).texts.into_iter().map(|(content, _)| content).collect();
    for wanted in ["disk", "policy thesis ·completed", "Swiping", "Error (mm)", "w0", "w1", "not traced within 1 mm"] {
        assert!(labels.iter().any(|label| label == wanted), "no {wanted:?} in {labels:?}");
    }
    texts_stand_clear(&picture);
}

#[test]
fn the_reference_is_drawn_with_exact_arcs() {
    let picture = draw(&scene(), "thesis", &half_round());
    let outlines = picture.lines().filter(|line| line.matches('A').count() == 3 && line.contains("Z\""));
    assert_eq!(outlines.count(), 2, "the area and the line of a circle in three arcs");
}

#[test]
fn the_same_run_gives_the_same_picture_whatever_the_clock_says() {
    let mut run = half_round();
    let picture = draw(&scene(), "thesis", &run);
    run.wall *= 2;
    run.tick_times.clear();
    assert!(picture == draw(&scene(), "thesis", &run));
    assert_eq!(picture.matches("http").count(), 1, "the namespace alone");
}

#[test]
fn many_states_and_whiskers_with_long_names_and_a_long_reason_have_room() {
    let mut run = run_with(&vec![arc_of_tips(0.301, 0.0, 1.0, 0.05 / 30.0); 8]);
    run.trace.states = (0..30).map(|k| format!("StateOfALongName{k}")).collect();
    run.trace.parents = vec![None; 30];
    run.trace.whiskers = (0..8).map(|k| format!("whisker_of_a_long_name_{k}")).collect();
    for (index, tick) in run.trace.ticks.iter_mut().enumerate() {
        tick.state = Some(index / 5);
        tick.body_touches = index % 10 == 0;
    }
    run.outcome = Outcome::Failed;
    run.reason = Some("the whisker was lost and ".repeat(20) + &"o".repeat(400));
    texts_stand_clear(&draw(&scene(), "thesis", &run));
}

/// The colours of the dots in a picture.
fn dot_colours(picture: &str) -> BTreeSet<String> {
    let dots = picture.lines().filter(|line| line.contains("stroke-linecap=\"round\"") && line.contains("d=\"M"));
    dots.filter_map(|line| Some(line.split_once("stroke=\"")?.1.split('"').next()?.to_owned())).collect()
}

#[test]
fn an_error_has_the_same_colour_in_every_picture_and_the_legend_says_which() {
    let around = |radius: f64| arc_of_tips(radius, 0.0, TAU / 4.0, 0.05 / 30.0);
    let colours = |tips: &[Vec<Option<Point2>>]| dot_colours(&draw(&scene(), "thesis", &run_with(tips)));
    // A twentieth of a millimetre, alone and beside five millimetres, which make the mean a hundred times as large.
    let (small, large) = (colours(&[around(0.30005)]), colours(&[around(0.305)]));
    let both = colours(&[around(0.30005), around(0.305)]);
    assert_eq!((small.len(), large.len()), (1, 1));
    assert_ne!(small, large);
    assert_eq!(both, &small | &large);
    let picture = draw(&scene(), "thesis", &run_with(&[around(0.30005)]));
    for colour in &both {
        assert!(picture.contains(&format!("fill=\"{colour}\"")), "the legend has no {colour}");
    }
    let labels: Vec<_> = see(&picture).texts.into_iter().map(|(content, _)| content).collect();
    for limit in ["0.01", "0.03", "0.1", "0.3", "1", "3", "10"] {
        assert!(labels.iter().any(|label| label == limit), "no {limit} in {labels:?}");
    }
}

#[test]
fn a_picture_says_what_the_hausdorff_distance_is_of() {
    let around = |sweep| draw(&scene(), "thesis", &run_with(&[arc_of_tips(0.30005, 0.0, sweep, 0.05 / 30.0)]));
    assert!(around(0.9 * TAU).contains("of the outline's farthest untraced point"));
    assert!(around(TAU).contains("of the farthest estimate"));
}

#[test]
fn each_of_43_states_looks_different_and_as_in_other_runs_of_its_machine() {
    let parents: Vec<_> = (0..43).map(|k| (k % 22 != 0).then_some(k / 22 * 22)).collect();
    let fills = |states: &[usize]| {
        let mut run = run_with(&[arc_of_tips(0.301, 0.0, 1.0, 0.05 / 30.0)]);
        run.trace.states = (0..43).map(|k| format!("S{k}")).collect();
        run.trace.parents.clone_from(&parents);
        let count = run.trace.ticks.len();
        for (index, tick) in run.trace.ticks.iter_mut().enumerate() {
            tick.state = Some(states[index * states.len() / count]);
        }
        let picture = draw(&scene(), "thesis", &run);
        let bands = picture.lines().filter(|line| line.starts_with("<rect") && line.contains("height=\"24\""));
        bands
            .map(|line| line.split_once("fill=\"").unwrap().1.split('"').next().unwrap().to_owned())
            .collect::<Vec<_>>()
    };
    let all = fills(&(0..43).collect::<Vec<_>>());
    assert_eq!(all.iter().collect::<BTreeSet<_>>().len(), 43);
    assert_eq!(fills(&[42, 7]), [all[42].clone(), all[7].clone()]);
}

#[test]
fn names_cannot_break_a_picture() {
    let mut run = half_round();
    run.reason = Some("\u{0}\u{1b}[31m]]> & <script>\u{ffff}".to_owned());
    run.trace.whiskers[0] = "\"<w0>\"".to_owned();
    let scene = Scene { name: "</text>&amp;".to_owned(), ..scene() };
    let picture = draw(&scene, "\"><script>alert(1)</script>", &run);
    assert!(!picture.contains("<script"));
    assert!(!picture.contains(|c: char| c.is_control() && c != '\n'));
    see(&picture);
}

#[test]
fn a_tip_far_off_is_left_out_of_the_map() {
    let mut run = half_round();
    run.trace.ticks[3].whiskers[0].tip = Some(Point2::new(1e308, 0.0));
    see(&draw(&scene(), "thesis", &run));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn a_picture_of_any_run_is_well_formed(
        tips in prop::collection::vec(prop::option::of((any::<f64>(), -1.0..1.0_f64)), 0..30),
        bodies in prop::collection::vec((prop::num::f64::ANY, -1.0..1.0_f64, prop::num::f64::ANY), 30),
        states in prop::collection::vec(0..4_usize, 30),
    ) {
        let tips = tips.into_iter().map(|tip| tip.map(|(x, y)| Point2::new(x, y))).collect();
        let mut run = run_with(&[tips]);
        for ((tick, (x, y, deflection)), state) in run.trace.ticks.iter_mut().zip(bodies).zip(states) {
            tick.body.position = Point2::new(x, y);
            tick.whiskers[0].deflection = deflection;
            tick.body_touches = state == 0;
            tick.state = (state < 3).then_some(state);
        }
        see(&draw(&scene(), "thesis", &run));
    }
}

/// The number of frames of a retrieval.
fn frames(strips: &str, retrieval: usize) -> usize {
    strips.matches(&format!("id=\"frame-{retrieval}-")).count()
}

#[test]
fn every_retrieval_has_a_strip_with_a_frame_for_the_edge_and_for_each_state() {
    let scene = scenario::read(&Source::new("disk.yaml", include_str!("../../scenarios/disk.yaml"))).unwrap();
    assert_eq!(retrieval_picture(&scene, "thesis", &half_round().trace), None);
    let run = retrieved();
    let strips = retrieval_picture(&scene, "thesis", &run.trace).unwrap();
    let found = retrievals(&run.trace);
    assert_eq!(found.len(), 2);
    for (number, retrieval) in found.iter().enumerate() {
        let heading = format!("{}: whisker", number + 1);
        assert!(strips.contains(&heading), "{heading}");
        let radius = format!("radius {:.1} mm", 1e3 * retrieval.radius);
        assert!(strips.contains(&radius), "{radius}");
        // The state is the same throughout, so there is one frame besides that of the edge.
        assert_eq!(frames(&strips, number + 1), 2);
    }
    // A whisker that records no tip at once goes on to do so in another state.
    let mut late = run;
    for tick in &mut late.trace.ticks[120..=150] {
        tick.whiskers[0].tip = None;
    }
    late.trace.ticks[130..=160].iter_mut().for_each(|tick| tick.state = Some(1));
    let strips = retrieval_picture(&scene, "thesis", &late.trace).unwrap();
    assert_eq!([1, 2].map(|number| frames(&strips, number)), [3, 2]);
}

#[test]
fn a_picture_shows_the_whiskers_that_the_policy_binds() {
    let run = half_round();
    let pictures = [vec!["r0".to_owned()], Vec::new()].map(|bound| {
        let mut run = run.clone();
        run.trace.whiskers = bound;
        draw(&scene(), "thesis", &run)
    });
    // A shaft is a cubic curve. The rig has the whiskers `r0` and `l0`.
    let is_number = |rest: &&str| rest.starts_with(|first: char| first.is_ascii_digit() || "-.".contains(first));
    let [bound, unbound] = pictures.map(|picture| picture.split('C').skip(1).filter(is_number).count());
    assert!(bound > 0 && unbound == 0, "{bound} {unbound}");
}

#[test]
fn only_the_picture_of_a_tunnel_shows_its_axis() {
    let read = |text: &str| scenario::read(&Source::new("scene.yaml", text)).unwrap();
    let run = half_round();
    for (scene, is_tunnel) in [
        (read(include_str!("../../scenarios/disk.yaml")), false),
        (read(include_str!("../../scenarios/smooth-tunnel.yaml")), true),
    ] {
        let score = Score::new(&run, &scene.truth, &scene.rig);
        let shown = picture(&scene, "thesis", &run, &score);
        assert_eq!(shown.contains("axis of the tunnel"), is_tunnel, "{}", scene.name);
        // Two dashed lines besides the path of the platform: the axis and its entry in the legend.
        assert_eq!(shown.matches("stroke-dasharray=\"7 4\"").count(), if is_tunnel { 2 } else { 0 });
    }
}
