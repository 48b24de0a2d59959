//! The figures of a run against closed forms.

use std::f64::consts::{PI, TAU};

use crate::runs::{arc_of_tips, run_with};
use proptest::prelude::*;
use vibrissa::figures::Metric;
use vibrissa::geometry::{Contour, ContourSet, Piece, Point2, Pose, TunnelAxis, circle, polygon, unit};
use vibrissa::scene::Truth;
use vibrissa::score::{
    COVERAGE_RESOLUTION, COVERAGE_TOLERANCE, CoverageTracker, Estimate, HAUSDORFF_TOLERANCE, MAX_STEP, Score, coverage,
    object_coverage, outline_coverages,
};
use vibrissa_runtime::rig::Rig;

/// How far tips go in a tick at 50 mm/s and 30 Hz (m).
const STEP: f64 = 0.05 / 30.0;

fn disk(radius: f64) -> Contour {
    circle(Point2::origin(), radius).unwrap()
}

fn score(tips: &[Vec<Option<Point2>>], reference: &Contour) -> Score {
    Score::new(&run_with(tips), &Truth::from(reference.clone()), &Rig::default())
}

fn moved(tips: &[Option<Point2>], pose: &Pose) -> Vec<Option<Point2>> {
    tips.iter().map(|tip| tip.map(|tip| pose.point_to_world(tip))).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn tips_on_the_contour_have_no_error_and_cover_it(radius in 0.01..0.04_f64) {
        let score = score(&[arc_of_tips(radius, 0.3, TAU, STEP)], &disk(radius));
        let error = score.error.unwrap();
        prop_assert!(error.max < 1e-15 && error.std.unwrap() < 1e-15);
        prop_assert!((score.coverage - 1.0).abs() < 1e-12);
        // Between tips the estimate is a chord.
        let sagitta = radius * (1.0 - (0.5 * STEP / radius).cos());
        prop_assert!(score.hausdorff.unwrap() <= sagitta + 1e-12);
    }

    #[test]
    fn tips_on_the_contour_s_offset_are_wrong_by_it(radius in 0.01..0.02_f64, offset in -5e-3..5e-3_f64) {
        let score = score(&[arc_of_tips(radius + offset, 0.0, TAU, 0.2 * STEP)], &disk(radius));
        let (error, sagitta) = (score.error.unwrap(), radius * (1.0 - (0.1 * STEP / radius).cos()) * 2.0);
        for figure in [error.mean, error.p95, error.max] {
            prop_assert!((figure - offset.abs()).abs() < 1e-15);
        }
        prop_assert!((score.hausdorff.unwrap() - offset.abs()).abs() <= HAUSDORFF_TOLERANCE + sagitta);
        if (offset.abs() - COVERAGE_TOLERANCE).abs() > 1e-5 {
            let traced = offset.abs() < COVERAGE_TOLERANCE;
            prop_assert!((score.coverage - f64::from(u8::from(traced))).abs() < 1e-12);
        }
    }

    #[test]
    fn a_part_of_a_circle_is_covered_to_a_tolerance_beyond_its_ends(radius in 0.02..0.2_f64, sweep in 0.2..5.0_f64) {
        let score = score(&[arc_of_tips(radius, 1.0, sweep, 0.2 * STEP)], &disk(radius));
        // At each end it goes on until the chord from the last tip is as long as the tolerance.
        let beyond = 2.0 * (0.5 * COVERAGE_TOLERANCE / radius).asin();
        prop_assert!((score.coverage - (sweep + 2.0 * beyond) / TAU).abs() * TAU * radius <= COVERAGE_RESOLUTION);
        // The point farthest from the tips is opposite to their middle.
        let farthest = 2.0 * radius * (0.25 * (TAU - sweep)).sin();
        let hausdorff = score.hausdorff.unwrap();
        prop_assert!(hausdorff <= farthest + 1e-12 && hausdorff >= farthest - HAUSDORFF_TOLERANCE);
    }

    #[test]
    fn where_the_scene_stands_changes_nothing(
        x in -2.0..2.0_f64, y in -2.0..2.0_f64, heading in -PI..PI, tips in noisy_tips(0.05),
    ) {
        let (reference, pose) = (disk(0.05), Pose { position: Point2::new(x, y), heading });
        let here = score(std::slice::from_ref(&tips), &reference);
        let there = score(&[moved(&tips, &pose)], &reference.transformed(&pose));
        for metric in Metric::ALL.into_iter().filter(|metric| metric.figure().name.is_some()) {
            let (a, b) = (here.figure(metric), there.figure(metric));
            // A disk has no corners, nor an axis, and these runs no marks.
            prop_assert_eq!(a.is_some(), b.is_some());
            let (Some(a), Some(b)) = (a, b) else { continue };
            // A stretch may be halved once more on one side, and a figure is known to its tolerance only.
            let tolerance = match metric {
                Metric::Coverage => 50.0 * COVERAGE_RESOLUTION / reference.length(),
                Metric::Hausdorff => HAUSDORFF_TOLERANCE,
                _ => 1e-12,
            };
            prop_assert!((a - b).abs() <= tolerance, "{metric:?}: {a} and {b}");
        }
    }

    #[test]
    fn the_order_of_the_whiskers_changes_nothing(a in noisy_tips(0.05), b in noisy_tips(0.05)) {
        let reference = disk(0.05);
        let (ab, ba) = (score(&[a.clone(), b.clone()], &reference), score(&[b, a], &reference));
        prop_assert_eq!(ab.error, ba.error);
        prop_assert!((ab.coverage - ba.coverage).abs() < 1e-12);
        prop_assert!((ab.hausdorff.unwrap() - ba.hausdorff.unwrap()).abs() <= HAUSDORFF_TOLERANCE);
    }

    #[test]
    fn coverage_and_hausdorff_distance_agree_with_brute_force(tips in noisy_tips(0.01)) {
        let reference = disk(0.01);
        let score = score(std::slice::from_ref(&tips), &reference);
        let lines: Vec<_> = tips.iter().flatten().zip(tips.iter().flatten().skip(1)).collect();
        let to_estimate = |point: Point2| {
            let to_line = lines.iter().map(|&(&from, &to)| {
                let along = to - from;
                let share = ((point - from).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
                (from + share * along - point).norm()
            });
            to_line.fold(f64::INFINITY, f64::min)
        };
        let spacing = 5e-6;
        let samples: Vec<_> = reference.sample(spacing).iter().map(|sample| to_estimate(sample.point)).collect();
        let traced = samples.iter().filter(|&&distance| distance <= COVERAGE_TOLERANCE).count() as f64;
        prop_assert!((score.coverage - traced / samples.len() as f64).abs() < 0.005);
        let from_estimate = lines.iter().flat_map(|&(&from, &to)| {
            (0..=200).map(move |k| ((from + (to - from) * (f64::from(k) / 200.0)).coords.norm() - 0.01).abs())
        });
        let brute = samples.iter().copied().chain(from_estimate).fold(0.0, f64::max);
        prop_assert!((score.hausdorff.unwrap() - brute).abs() < HAUSDORFF_TOLERANCE + spacing);
    }

    #[test]
    fn the_coverage_while_a_run_goes_on_is_that_of_its_tips_until_then(
        first in gappy_tips(), second in gappy_tips(), radius in 0.04..0.06_f64,
    ) {
        let there = Pose { position: Point2::new(radius, 0.0), heading: 1.0 };
        let reference = ContourSet::new([disk(radius), disk(0.02).transformed(&there)]).unwrap();
        let mut tracker = CoverageTracker::new(reference.clone());
        let whiskers = [first, second];
        for tick in 0..60 {
            for (whisker, tips) in whiskers.iter().enumerate() {
                if let Some(tip) = tips[tick] {
                    tracker.add(whisker, tick, tip);
                }
            }
            let until = whiskers.each_ref().map(|tips| tips[..=tick].to_vec());
            let whole = coverage(&Estimate::new(&run_with(&until).trace), &reference);
            // Each tip adds at most two ends of intervals to each contour.
            let bound = 8.0 * (tick + 1) as f64 * COVERAGE_RESOLUTION / reference.length();
            prop_assert!((tracker.coverage() - whole).abs() <= bound, "tick {tick}: {} and {whole}", tracker.coverage());
        }
    }

    #[test]
    fn no_trace_is_too_strange(
        tips in prop::collection::vec(prop::option::of((any::<f64>(), any::<f64>())), 0..40),
        near in prop::collection::vec(prop::option::of((-0.1..0.1_f64, prop::num::f64::ANY)), 0..40),
    ) {
        let points = |tips: Vec<Option<(f64, f64)>>| -> Vec<_> {
            tips.into_iter().map(|tip| tip.map(|(x, y)| Point2::new(x, y))).collect()
        };
        let score = score(&[points(tips), points(near)], &disk(0.05));
        prop_assert!((0.0..=1.0).contains(&score.coverage));
    }
}

/// Tips once round the circle of `radius` (m), each up to 2 mm off, close enough to make one stroke.
fn noisy_tips(radius: f64) -> impl Strategy<Value = Vec<Option<Point2>>> {
    prop::collection::vec(-2e-3..2e-3_f64, 60).prop_map(move |offsets| {
        let place = |(k, offset)| Some(Point2::from((radius + offset) * unit(k as f64 * TAU / 60.0)));
        offsets.into_iter().enumerate().map(place).collect()
    })
}

/// Tips about a circle of 5 cm like [`noisy_tips`]. Some ticks have none, and some tips are no numbers or far away.
fn gappy_tips() -> impl Strategy<Value = Vec<Option<Point2>>> {
    let tip = |tip| prop_oneof![5 => Just(tip), 3 => Just(None), 1 => Just(Some(Point2::new(f64::NAN, 0.0)))];
    noisy_tips(0.05).prop_flat_map(move |tips| tips.into_iter().map(tip).collect::<Vec<_>>())
}

#[test]
fn each_outline_has_its_own_coverage() {
    let there = Pose { position: Point2::new(1.0, 0.0), heading: 0.0 };
    let second = disk(0.1).transformed(&there);
    let whole = arc_of_tips(0.1, 0.0, TAU, STEP);
    let half = moved(&arc_of_tips(0.1, 0.0, PI, STEP), &there);
    let pair = ContourSet::new([disk(0.1), second]).unwrap();
    let (estimate, pair) = (Estimate::new(&run_with(&[whole, half]).trace), pair);
    let coverages = outline_coverages(&estimate, &pair);
    assert!((coverages[0] - 1.0).abs() < 1e-12 && (coverages[1] - 0.5).abs() < 0.01, "{coverages:?}");
    assert!((coverage(&estimate, &pair) - f64::midpoint(coverages[0], coverages[1])).abs() < 1e-12);
    let of = |tip| object_coverage(&coverages, tip, &pair).to_bits();
    assert_eq!([of(Some(Point2::new(1.0, 0.2))), of(None)], [coverages[1].to_bits(), 0]);
}

#[test]
fn a_run_without_tips_has_covered_nothing_and_has_no_error() {
    for tips in [vec![], vec![vec![None; 10]], vec![vec![Some(Point2::new(f64::NAN, 0.0)); 10]]] {
        let score = score(&tips, &disk(0.05));
        assert_eq!((score.error, score.hausdorff), (None, None));
        assert!(score.coverage <= 0.0 && score.coverage.is_sign_positive());
        assert_eq!(score.figure(Metric::ErrorMean), None);
        assert_eq!(score.figure(Metric::Coverage), Some(0.0));
    }
}

#[test]
fn a_single_tip_covers_a_tolerance_to_either_side() {
    let square = polygon(&[(0.0, 0.0), (0.1, 0.0), (0.1, 0.1), (0.0, 0.1)].map(|(x, y)| Point2::new(x, y))).unwrap();
    let score = score(&[vec![Some(Point2::new(0.05, 0.0))]], &square);
    assert!((score.coverage * 0.4 - 2.0 * COVERAGE_TOLERANCE).abs() <= COVERAGE_RESOLUTION);
    assert!((score.hausdorff.unwrap() - 0.05_f64.hypot(0.1)).abs() <= HAUSDORFF_TOLERANCE);
    assert_eq!(score.error.unwrap().std, None);
}

#[test]
fn a_stroke_bridges_two_missing_ticks_but_not_three() {
    for (missing, strokes) in [(0, 1), (1, 1), (2, 1), (3, 2), (30, 2)] {
        let mut tips = vec![Some(Point2::new(0.0, 0.0)), Some(Point2::new(0.001, 0.0))];
        tips.extend(vec![None; missing]);
        tips.extend([Some(Point2::new(0.002, 0.0)), Some(Point2::new(0.003, 0.0))]);
        let estimate = Estimate::new(&run_with(&[tips]).trace);
        assert_eq!(estimate.strokes().len(), strokes, "{missing} missing");
        assert_eq!(estimate.strokes().concat().len(), 4);
    }
}

#[test]
fn a_stroke_ends_where_the_tip_jumps() {
    let tips = [0.0, 0.001, 0.002 + MAX_STEP, 0.003 + MAX_STEP].map(|x| Some(Point2::new(x, 0.0)));
    let estimate = Estimate::new(&run_with(&[tips.to_vec()]).trace);
    assert_eq!(estimate.strokes().iter().map(Vec::len).collect::<Vec<_>>(), [2, 2]);
    let middle = Point2::new(0.0015 + 0.5 * MAX_STEP, 0.0);
    assert!((estimate.distance(middle).unwrap() - 0.5 * (MAX_STEP + 0.001)).abs() < 1e-15);
}

#[test]
fn whiskers_are_not_joined_but_pooled() {
    let (left, right) = (Some(Point2::new(0.0, 0.051)), Some(Point2::new(0.0, -0.053)));
    let run = run_with(&[vec![left, left], vec![right, right]]);
    assert_eq!(Estimate::new(&run.trace).strokes().len(), 2);
    let error = Score::new(&run, &disk(0.05).into(), &Rig::default()).error.unwrap();
    assert_eq!(error.count, 4);
    assert!((error.mean - 2e-3).abs() < 1e-12);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// Of tips off a circle by known errors with known standard deviations.
    #[test]
    fn an_outlier_is_what_its_own_deviation_does_not_explain(
        tips in prop::collection::vec((0.0..1e-3_f64, 0.0..2e-4_f64), 1..60)
    ) {
        let place = |index: usize, error: f64| Some(Point2::from((0.05 + error) * unit(0.1 * index as f64)));
        let mut run = run_with(&[tips.iter().enumerate().map(|(index, &(error, _))| place(index, error)).collect()]);
        for (tick, (_, deviation)) in run.trace.ticks.iter_mut().zip(&tips) {
            tick.whiskers[0].tip_deviation = *deviation;
        }
        let outliers = tips.iter().filter(|(error, deviation)| *error > 1e-4 + 4.0 * deviation).count();
        let error = Score::new(&run, &disk(0.05).into(), &Rig::default()).error.unwrap();
        prop_assert!((error.outliers - outliers as f64 / tips.len() as f64).abs() < 1e-12);
    }

    /// The estimates are on the circle, and late: no distance from the outline sees that.
    #[test]
    fn a_late_estimate_is_off_along_the_outline(late in 1e-4..3e-3_f64, sunk in 0.0..5e-5_f64) {
        let tips = arc_of_tips(0.05, 0.3, 5.0, STEP);
        let mut run = run_with(&[tips]);
        run.trace.whiskers = vec!["r0".to_owned()];
        let radius = Rig::default().whiskers[0].shaft.radius_at(1.0);
        for tick in &mut run.trace.ticks {
            let tip = tick.whiskers[0].tip.unwrap();
            let ahead = tip.y.atan2(tip.x) + late / 0.05;
            tick.whiskers[0].tip_end = Some(Point2::from((0.05 + radius - sunk) * unit(ahead)));
        }
        let error = Score::new(&run, &disk(0.05).into(), &Rig::default()).error.unwrap();
        prop_assert!(error.max < 1e-12);
        let (along, across) = (error.along.unwrap(), error.across.unwrap());
        // Along the tangent at the true tip; across it the circle bends away.
        let angle = late / 0.05;
        prop_assert!((along.mean - 0.05 * angle.sin()).abs() < 1e-12);
        prop_assert!((across.max - (0.05 * (1.0 - angle.cos()) - sunk).abs()).abs() < 1e-12);
    }
}

#[test]
fn the_axis_error_is_that_of_the_midpoints_between_two_tips() {
    // The platform goes up the y axis, between them.
    let up = |x| Contour::open(vec![Piece::segment(Point2::new(x, 0.0), Point2::new(x, 1.0))]).unwrap();
    let truth = Truth { axes: vec![TunnelAxis::new(up(0.0), up(-0.11), up(0.11))], ..disk(0.05).into() };
    let left = [Some(Point2::new(-0.104, 0.1)), None, Some(Point2::new(-0.1, 0.3)), Some(Point2::new(f64::NAN, 0.4))];
    let right = [0.1, 0.1, 0.102, 0.1].map(|x| Some(Point2::new(x, 0.2)));
    let axis = Score::new(&run_with(&[left.to_vec(), right.to_vec()]), &truth, &Rig::default()).axis.unwrap();
    assert!((axis.mean - 1.5e-3).abs() < 1e-15 && (axis.std.unwrap() - 0.5e-3 * 2_f64.sqrt()).abs() < 1e-15);
    assert_eq!(
        Score::new(&run_with(&[left.to_vec()]), &truth, &Rig::default()).axis,
        None,
        "one whisker has no midpoint"
    );
    assert_eq!(score(&[left.to_vec(), right.to_vec()], &disk(0.05)).axis, None, "no tunnel");
}

#[test]
fn latency_is_that_of_the_ticks() {
    let latency = score(&[vec![None; 101]], &disk(0.05)).latency.unwrap();
    assert!((latency.mean - 1.05e-6).abs() < 1e-15);
    assert!((latency.p99 - 1.099e-6).abs() < 1e-15);
    assert!((latency.max - 1.1e-6).abs() < 1e-15);
    assert_eq!(score(&[], &disk(0.05)).latency, None);
}
