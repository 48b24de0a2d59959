//! Paired differences against closed forms and against chance, and starts that vary.
#![allow(clippy::unwrap_used, clippy::float_cmp, reason = "a test may panic, and what is exact is compared exactly")]

use std::cmp::Ordering;

use crate::runs::{arc_of_tips, run_with};
use proptest::prelude::*;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, Normal};
use vibrissa::diagnostic::Source;
use vibrissa::geometry::{Point2, circle};
use vibrissa::report::comparison_tables;
use vibrissa::results::{Hashes, Identity, RunResult};
use vibrissa::scenario;
use vibrissa::scene::{Jitter, Outcome, Scene};
use vibrissa::score::Score;
use vibrissa::study::compare::{Comparison, Figure, FigureComparison, Outlook, figures};
use vibrissa_runtime::rig::Rig;

fn figure(name: &str) -> Figure {
    figures().into_iter().find(|figure| figure.name == name).unwrap()
}

fn compared(name: &str, pairs: &[(f64, f64)]) -> FigureComparison {
    FigureComparison::new(&figure(name), "other", pairs.to_vec()).unwrap()
}

#[test]
fn the_interval_is_student_s() {
    // The quantiles of Student's t at 97.5 % as tables have them.
    for (pairs, quantile) in [(2, 12.706), (5, 2.776), (10, 2.262), (31, 2.042)] {
        let pairs: Vec<_> = (0..pairs).map(|k| (1.0, 2.0 + f64::from(k))).collect();
        let count = pairs.len() as f64;
        // Of the numbers 1 to n.
        let (mean, std) = (0.5 * (count + 1.0), (count * (count + 1.0) / 12.0).sqrt());
        let difference = compared("sim_s", &pairs).difference;
        let half = quantile * std / count.sqrt();
        let [low, high] = difference.interval.unwrap();
        assert!((difference.mean - mean).abs() < 1e-12);
        assert!((low - (mean - half)).abs() < 1e-3 * half && (high - (mean + half)).abs() < 1e-3 * half);
    }
    assert_eq!(compared("sim_s", &[(1.0, 2.0)]).difference.interval, None);
}

#[test]
fn the_interval_holds_the_true_difference_ninety_five_times_in_a_hundred() {
    let (mut random, noise) = (ChaCha8Rng::seed_from_u64(7), Normal::new(0.3, 1.0).unwrap());
    let trials = 4000;
    let held = (0..trials).filter(|_| {
        let pairs: Vec<_> = (0..6).map(|_| (1.0, 1.0 + noise.sample(&mut random))).collect();
        let [low, high] = compared("sim_s", &pairs).difference.interval.unwrap();
        low <= 0.3 && 0.3 <= high
    });
    let share = held.count() as f64 / f64::from(trials);
    // Three standard deviations of the count.
    assert!((share - 0.95).abs() < 3.0 * (0.95 * 0.05 / f64::from(trials)).sqrt(), "{share}");
}

proptest! {
    #[test]
    fn seen_from_the_other_side_every_difference_is_the_opposite(
        pairs in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64), 2..30),
    ) {
        let swapped: Vec<_> = pairs.iter().map(|&(a, b)| (b, a)).collect();
        for name in ["sim_s", "coverage"] {
            let (here, there) = (compared(name, &pairs), compared(name, &swapped));
            prop_assert!((here.difference.mean + there.difference.mean).abs() < 1e-12);
            prop_assert_eq!((here.wins, here.losses), (there.losses, there.wins));
            let opposite = match here.outlook {
                Outlook::Better => Outlook::Worse,
                Outlook::Worse => Outlook::Better,
                same => same,
            };
            prop_assert_eq!(there.outlook, opposite);
        }
    }
}

proptest! {
    #[test]
    fn completed_runs_differ_if_the_sign_test_says_so(gained in 0_i32..15, lost in 0_i32..15, same in 2_i32..30) {
        let several = |pair: (f64, f64), count: i32| (0..count).map(move |_| pair);
        let pairs = several((0.0, 1.0), gained).chain(several((1.0, 0.0), lost)).chain(several((1.0, 1.0), same)).collect();
        let compared = FigureComparison::new(&figure("completed"), "other", pairs).unwrap();
        // The probability of so uneven a split of the pairs that differ, by the binomial distribution itself.
        let differing = gained + lost;
        let ways = |count: i32| (0..count).map(|i| f64::from(differing - i) / f64::from(count - i)).product::<f64>();
        let tail: f64 = (0..=gained.min(lost)).map(|count| ways(count) * 0.5_f64.powi(differing)).sum();
        let outlook = match gained.cmp(&lost) {
            _ if differing == 0 => Outlook::Same,
            Ordering::Greater if 2.0 * tail < 0.05 => Outlook::Better,
            Ordering::Less if 2.0 * tail < 0.05 => Outlook::Worse,
            _ => Outlook::Open,
        };
        prop_assert_eq!(compared.outlook, outlook, "{} gained, {} lost", gained, lost);
        let [low, high] = compared.difference.interval.unwrap();
        prop_assert!(-1.0 <= low && low <= compared.difference.mean && compared.difference.mean <= high && high <= 1.0);
    }
}

#[test]
fn less_is_better_but_for_coverage() {
    let more = [(1.0, 2.0), (1.0, 2.1), (1.0, 2.2)];
    assert_eq!(compared("error_mm.mean", &more).outlook, Outlook::Worse);
    let coverage = compared("coverage", &more);
    assert_eq!((coverage.outlook, coverage.wins, coverage.losses), (Outlook::Better, 3, 0));
    assert_eq!(compared("sim_s", &[(1.0, 1.0), (2.0, 2.0)]).outlook, Outlook::Same);
    assert_eq!(compared("sim_s", &[(1.0, 0.0), (2.0, 3.5)]).outlook, Outlook::Open);
    assert_eq!(compared("sim_s", &[(1.0, f64::NAN), (2.0, 3.5)]).pairs, 1);
    assert_eq!(FigureComparison::new(&figure("sim_s"), "other", vec![(f64::NAN, 1.0)]), None);
}

/// A result of the run with this seed, which took so many ticks.
fn result(seed: u64, ticks: usize, outcome: Outcome) -> RunResult {
    let mut run = run_with(&[arc_of_tips(0.3, 0.0, 1.0, 0.05 / 30.0)]);
    run.trace.ticks.truncate(ticks);
    run.outcome = outcome;
    let hash = Hashes { scenario: String::new(), policy: String::new(), engine: String::new() };
    let [scenario, policy, world] = ["disk", "m", "mujoco"].map(str::to_owned);
    let identity = Identity {
        scenario,
        policy,
        true_tips: false,
        world,
        seed,
        mismatch: None,
        calibration: None,
        friction: None,
        hash,
    };
    let score = Score::new(&run, &circle(Point2::origin(), 0.3).unwrap().into(), &Rig::default());
    RunResult::new(identity, &run, &score, &[])
}

#[test]
fn a_run_that_either_did_not_complete_is_in_no_pair_but_that_of_completion_and_is_told() {
    let ended = |ticks: [usize; 4], bad: usize| -> Vec<RunResult> {
        let outcome = |seed| if seed == bad { Outcome::Timeout } else { Outcome::Completed };
        (0..4).map(|seed| result(seed as u64, ticks[seed], outcome(seed))).collect()
    };
    let runs = [
        ("a.fsm".to_owned(), ended([30, 60, 90, 120], 9)),
        ("b.fsm".to_owned(), ended([60, 90, 3, 150], 2)),
        ("c.fsm".to_owned(), ended([30, 60, 90, 120], 9)),
    ];
    let comparison = Comparison::new(&runs);
    assert_eq!(comparison.policies.iter().map(|policy| policy.incomplete.len()).collect::<Vec<_>>(), [0, 1, 0]);
    assert_eq!(comparison.policies[1].incomplete[0].seed, 2);
    let time = |policy: &str| {
        comparison.figures.iter().find(|figure| figure.figure == "sim_s" && figure.policy == policy).unwrap()
    };
    assert_eq!((time("b.fsm").pairs, time("b.fsm").losses), (3, 3));
    assert!((time("b.fsm").difference.mean - 1.0).abs() < 1e-9 && (time("b.fsm").first - 7.0 / 3.0).abs() < 1e-9);
    assert_eq!((time("c.fsm").pairs, time("c.fsm").outlook), (4, Outlook::Same));
    let completed = comparison.figures.iter().find(|figure| figure.figure == "completed").unwrap();
    assert_eq!((completed.pairs, completed.losses, completed.wins), (4, 1, 0));
    assert!(completed.first == 1.0 && completed.mean == 0.75, "a share of all runs");
    assert!(comparison.figures.iter().all(|figure| figure.figure != "corners.time_s"), "a disk has none");
    let [runs, figures, _] = <[_; 3]>::try_from(comparison_tables(&comparison)).unwrap();
    assert_eq!(runs.rows[1], ["b.fsm", "4", "75.0 (30.1–95.4)", "100.0 (51.0–100.0)"]);
    assert!(figures.fitted().starts_with("b.fsm minus a.fsm"), "{}", figures.fitted());
}

#[test]
fn a_comparison_shows_each_difference_with_its_interval_within_a_line_of_a_terminal() {
    let runs = |ticks: [usize; 4]| (0..4).map(|seed| result(seed as u64, ticks[seed], Outcome::Completed)).collect();
    let names = ["policies/a-policy-with-a-long-name.fsm", "policies/another-policy-with-a-long-name.fsm"];
    let runs = [(names[0].to_owned(), runs([30, 60, 90, 120])), (names[1].to_owned(), runs([60, 90, 126, 150]))];
    let tables = comparison_tables(&Comparison::new(&runs));
    let shown = tables[1].fitted();
    assert!(["difference", "95 % interval", "verdict", "+1.05"].iter().all(|text| shown.contains(text)), "{shown}");
    assert!(shown.contains("+0.891 .. +1.21"), "{shown}");
}

/// A disk whose edge is 1 cm in front of the platform's nose.
fn close_by() -> Scene {
    let text = "
name: disk
objects: [{circle: {centre: [0 m, 0.418 m], radius: 0.3 m}}]
start: {position: [0 m, 0 m], heading: 90 deg}
stop: {time: 120 s}
";
    scenario::read(&Source::new("disk.yaml", text)).unwrap()
}

#[test]
fn a_seed_always_gives_the_same_start_within_the_jitter_and_clear_of_the_object() {
    let (scene, jitter) = (close_by(), Jitter { position: 0.02, heading: 0.2 });
    let starts: Vec<_> = (0..200).map(|seed| jitter.start(&scene, seed).unwrap()).collect();
    for (seed, start) in starts.iter().enumerate() {
        assert_eq!(jitter.start(&scene, seed as u64), Some(*start));
        let off = start.position - scene.start.position;
        assert!(off.x.abs() <= 0.02 && off.y.abs() <= 0.02 && (start.heading - scene.start.heading).abs() <= 0.2);
        assert!(scene.is_clear_at(start));
        assert!(!starts[..seed].contains(start));
    }
    let mean = |of: fn(&vibrissa::geometry::Pose) -> f64| starts.iter().map(of).sum::<f64>() / 200.0;
    assert!(
        mean(|start| start.position.x).abs() < 0.004 && mean(|start| start.position.y) < 0.0,
        "the nearer half is taken"
    );
}

#[test]
fn where_there_is_no_clear_start_none_is_given() {
    let mut scene = close_by();
    scene.start.position.y = 0.4;
    assert_eq!(Jitter { position: 0.01, heading: 0.0 }.start(&scene, 1), None);
}
