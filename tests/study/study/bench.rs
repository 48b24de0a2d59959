//! The comparison of the bench with the baseline, and its page.

use std::f64::consts::TAU;

use crate::runs::{arc_of_tips, run_with};
use vibrissa::built_in::SCENARIOS;
use vibrissa::diagnostic::Source;
use vibrissa::geometry::{Point2, circle};
use vibrissa::report::{RunFigures, bench_page, bench_table, pooled_tips};
use vibrissa::results::{Ending, Hashes, Identity, LargestError, MismatchIdentity, Provenance, RunResult};
use vibrissa::scenario;
use vibrissa::score::{ErrorFigures, Moments, RetrievalFigures, Score};
use vibrissa::study::bench::{BASELINE, BenchRow, Conditions, Verdict};
use vibrissa_runtime::rig::Rig;

/// The result of a run once round a disk, `off` (m) outside of it, as that of a scenario.
fn result(scenario: &str, off: f64) -> RunResult {
    scored(scenario, off, |_| {})
}

/// The same result after a `change` of the score.
fn scored(scenario: &str, off: f64, change: impl FnOnce(&mut Score)) -> RunResult {
    let run = run_with(&[arc_of_tips(0.03 + off, 0.0, TAU, 0.05 / 30.0)]);
    let hash = Hashes { scenario: String::new(), policy: String::new(), engine: String::new() };
    let (scenario, policy, world) = (scenario.to_owned(), "thesis".to_owned(), "mujoco".to_owned());
    let identity = Identity {
        scenario,
        policy,
        true_tips: false,
        world,
        seed: 0,
        mismatch: None,
        calibration: None,
        friction: None,
        hash,
    };
    let mut score = Score::new(&run, &circle(Point2::origin(), 0.03).unwrap().into(), &Rig::default());
    change(&mut score);
    RunResult::new(identity, &run, &score, &[])
}

/// The result with another outcome.
fn with(outcome: Ending, mut result: RunResult) -> RunResult {
    result.outcome = outcome;
    result
}

/// The result of a run in the box with retrievals of this mean radius (m).
fn retrieved(radius: f64) -> RunResult {
    let moments = |mean| Some(Moments { mean, std: Some(1e-4) });
    let retrieval = RetrievalFigures { count: 4, radius: moments(radius), distance: moments(0.2), time: moments(3.0) };
    scored("box", 0.0, |score| score.retrieval = Some(retrieval))
}

#[test]
fn a_figure_is_better_up_to_the_baselines_and_worse_beyond() {
    for figures in BASELINE {
        for (factor, verdict) in [(0.99, Verdict::Better), (1.01, Verdict::Worse)] {
            let row = BenchRow::new(result(figures.scenario, factor * figures.error_mm.mean * 1e-3));
            assert_eq!(row.verdicts.error_mm, Some(verdict), "{}", figures.scenario);
        }
    }
    let row = BenchRow::new(retrieved(0.0113));
    assert_eq!((row.verdicts.radius_mm, row.passed), (Some(Verdict::Worse), false));
    assert!(BenchRow::new(retrieved(0.0111)).passed);
}

#[test]
fn shares_are_pooled_over_tips_and_not_over_scenes() {
    let row = |scenario: &str, count: usize, outliers: f64, interval_coverage: f64| {
        let change = |error| ErrorFigures { count, outliers, interval_coverage, ..error };
        BenchRow::new(scored(scenario, 0.0, |score| score.error = score.error.map(change)))
    };
    let told = pooled_tips(&[row("disk", 100, 0.04, 0.6), row("box", 300, 0.0, 1.0)]);
    assert_eq!(told, "thesis: 400 tips, 1.000 % outliers, 90.0 % within their 95 % interval");
}

#[test]
fn a_run_that_does_not_complete_or_measures_nothing_does_not_pass() {
    let good = result("disk", 1e-4);
    assert!(BenchRow::new(good.clone()).passed);
    assert!(!BenchRow::new(with(Ending::Timeout, good)).passed);
    let nothing = scored("disk", 1e-4, |score| score.error = None);
    assert_eq!(BenchRow::new(nothing).verdicts.error_mm, Some(Verdict::Worse));
    let tunnel = BenchRow::new(result("smooth-tunnel", 1e-4));
    assert_eq!(
        (tunnel.verdicts.axis_mm, tunnel.passed),
        (Some(Verdict::Worse), false),
        "it was never between both walls"
    );
    let unknown = |error| ErrorFigures { mean: f64::NAN, ..error };
    let not_a_number = scored("disk", 1e-4, |score| score.error = score.error.map(unknown));
    assert!(!BenchRow::new(not_a_number).passed);
}

#[test]
fn who_retrieves_nothing_is_not_worse_at_it_and_a_foreign_scene_has_only_to_complete() {
    let row = BenchRow::new(result("octagon", 1e-4));
    assert_eq!((row.verdicts.radius_mm, row.passed), (None, true));
    let foreign = BenchRow::new(result("star", 0.1));
    assert_eq!((foreign.baseline, foreign.passed), (None, true));
}

#[test]
fn a_run_under_harder_conditions_has_only_to_complete_and_says_what_they_are() {
    let conditions = Conditions { friction: 0.3, noise: true, round: false };
    let worse = BenchRow::new(result("disk", 2e-3));
    assert!(!worse.passed && !worse.clone().under(Conditions::default()).passed);
    let hard = worse.clone().under(conditions);
    assert!(hard.passed && bench_table(&[hard]).wide().contains("disk, friction 0.3, noise"));
    // A run that ended without what its scene expects has not completed.
    for outcome in [Ending::Ended, Ending::Failed] {
        let row = BenchRow { result: with(outcome, worse.result.clone()), ..worse.clone() };
        assert!(!row.under(conditions).passed, "{outcome}");
    }
}

#[test]
fn a_run_with_a_mismatch_has_only_to_complete_and_says_so() {
    let mut bent = result("disk", 5e-3);
    bent.mismatch = Some(MismatchIdentity::default());
    let row = BenchRow::new(bent.clone()).under(Conditions::default());
    assert!(row.passed && row.scene() == "disk, mismatch");
    bent.outcome = Ending::Failed;
    assert!(!BenchRow::new(bent).under(Conditions::default()).passed);
}

#[test]
fn conditions_leave_a_rig_whose_steps_fit_and_are_short_enough_and_ideal_ones_change_nothing() {
    let friction = Conditions { friction: 0.1, ..Conditions::default() };
    for file in SCENARIOS {
        let scene = scenario::read(&Source::new(file.path, file.text)).unwrap();
        let mut harder = scene.clone();
        Conditions::default().apply(&mut harder);
        assert_eq!(harder.rig, scene.rig);
        friction.apply(&mut harder);
        let steps = 1.0 / (harder.rig.sensing.sample_rate * harder.physics.step);
        assert!((steps - steps.round()).abs() < 1e-9 && harder.physics.step <= 1.0 / 1800.0 + 1e-9, "{steps}");
        assert!(harder.physics.penetration_limit >= scene.physics.penetration_limit);
        assert!(harder.rig.sensing.friction > 0.0 && harder.rig.sensing.angle_noise == 0.0);
    }
}

#[test]
fn the_table_marks_figures_that_are_better_than_the_baselines() {
    let rows = ["disk", "smooth-tunnel"].into_iter().zip([2e-4, 2e-3]);
    let table = bench_table(&rows.map(|(scene, off)| BenchRow::new(result(scene, off))).collect::<Vec<_>>());
    let column = |heading: &str| table.headings.iter().position(|found| found == heading).unwrap();
    for (row, wanted) in table
        .rows
        .iter()
        .zip([["better", "0.200 ± 0.000", "0.8 ± 0.5"], ["worse: error, axis", "2.00 ± 0.00", "1.3 ± 1.6"]])
    {
        let found = ["against the baseline", "error mm", "baseline: error mm"].map(|heading| &row[column(heading)]);
        assert_eq!(found, wanted);
    }
    // An axis that is not known is worse than the baseline's.
    assert_eq!(["axis mm", "baseline: axis mm"].map(|heading| &table.rows[1][column(heading)]), ["–", "4 ± 4"]);
}

#[test]
fn the_page_needs_no_other_file_and_nothing_in_it_can_break_it() {
    let attack = "<script>alert(\"1\")</script> & more";
    let scene = "name: disk\nobjects: [{circle: {centre: [0 m, 0 m], radius: 30 mm}}]\nstart: {position: [1 m, 1 m], heading: 0 deg}\n\
                 stop: {time: 1 s}\npolicy: a.fsm\n";
    let scene = scenario::read(&Source::new("disk.yaml", scene)).unwrap();
    // The third tip is 5 m off the disk, which the map does not show.
    let mut tips = arc_of_tips(0.0301, 0.0, TAU, 0.05 / 30.0);
    tips[2] = Some(Point2::new(5.03, 0.0));
    let mut run = run_with(&[tips]);
    run.trace.states = vec![attack.to_owned()];
    let score = Score::new(&run, &scene.truth, &scene.rig);
    let worst = score.largest_error.unwrap();
    assert_eq!((worst.tick, worst.tip_world), (2, Point2::new(5.03, 0.0)));
    let figures = RunFigures::new(&scene, attack, &run, &score);
    let mut failed = result("disk", 1e-4);
    failed.largest_error = Some(LargestError {
        error_mm: 1e3 * worst.error,
        tip_m: worst.tip_world.coords.into(),
        time_s: 0.1,
        state: Some(attack.to_owned()),
        whisker: attack.to_owned(),
    });
    failed.outcome = Ending::Failed;
    failed.reason = Some(attack.to_owned());
    let rows = [BenchRow::new(failed), BenchRow::new(result("box", 1e-4))];
    let page = bench_page(
        &Provenance { command: attack.to_owned(), ..Provenance::default() },
        &rows,
        &[figures.clone(), figures],
        None,
    );
    assert!(page.contains("1 of 2 runs passed") && page.contains("class=\"name worse\">failed"));
    // The only scripts are the positions of two pictures and that of the page.
    assert_eq!((page.matches("<script").count(), page.matches("</script").count()), (3, 3));
    assert!(!page.contains("alert(\"1\")</script>") && !page.contains("<img") && !page.contains("src=\"http"));
    // Identifiers of one picture do not occur in the other.
    let identifiers: Vec<&str> = page.split(" id=\"").skip(1).map(|rest| rest.split('"').next().unwrap()).collect();
    let mut unique = identifiers.clone();
    unique.sort_unstable();
    unique.dedup();
    assert_eq!(unique.len(), identifiers.len(), "{identifiers:?}");
    assert!(page.contains("<b>5000 mm</b> at (5030 mm, 0 mm)"), "the largest error is not named");
    assert!(page.contains("It is outside of the map."));
}
