//! Filter and contour against what they are defined to be.

use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};

use nalgebra::{DMatrix, Matrix2};
use proptest::prelude::*;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, Normal};
use vibrissa::geometry::{Point2, Pose, Vector2, rotate, turn_between, unit};
use vibrissa_runtime::machine::{ContactEstimatorKind, ContourVector, Senses, WhiskerVector};
use vibrissa_runtime::percept::{LocalContour, LowPass, Perception};
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{MAX_WHISKERS, Reading, Sample};

/// The amplitude that a filter gives a sine of unit amplitude at `frequency`, once it has settled: that of the sine which
/// fits its output best.
fn gain(cutoff: f64, rate: f64, frequency: f64) -> f64 {
    let mut filter = LowPass::new(cutoff, rate).unwrap();
    let settled = (20.0 * rate / cutoff).ceil();
    let fitted = (4.0 * rate / frequency).ceil().max(1000.0);
    let (mut normal, mut right) = (Matrix2::zeros(), Vector2::zeros());
    let mut index = 0.0;
    while index < settled + fitted {
        let phase = TAU * frequency * index / rate;
        let value = filter.next(phase.sin());
        if index >= settled {
            let basis = Vector2::new(phase.sin(), phase.cos());
            normal += basis * basis.transpose();
            right += value * basis;
        }
        index += 1.0;
    }
    normal.lu().solve(&right).unwrap().norm()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(30))]

    #[test]
    fn the_filter_halves_the_power_at_its_cutoff(cutoff in 2.0..100.0_f64) {
        prop_assert!((gain(cutoff, 300.0, cutoff) - FRAC_1_SQRT_2).abs() < 2e-3);
    }

    #[test]
    fn the_filter_has_the_gain_of_a_third_order_butterworth(cutoff in 3.0..30.0_f64, ratio in 0.2..4.0_f64) {
        // The bilinear transform maps a frequency f to the analogue one that tan(pi f / rate) stands for.
        let rate = 300.0;
        let frequency = cutoff * ratio;
        let warped = (PI * frequency / rate).tan() / (PI * cutoff / rate).tan();
        let due = 1.0 / (1.0 + warped.powi(6)).sqrt();
        let found = gain(cutoff, rate, frequency);
        prop_assert!((found - due).abs() < 3e-3, "{found} {due}");
    }

    #[test]
    fn a_step_is_passed_on_in_full_with_the_overshoot_of_its_kind(cutoff in 1.0..8.0_f64) {
        let mut filter = LowPass::new(cutoff, 300.0).unwrap();
        let answer: Vec<f64> = (0..3000).map(|_| filter.next(1.0)).collect();
        prop_assert!((answer.last().unwrap() - 1.0).abs() < 1e-9);
        // A third-order Butterworth filter overshoots by 8.15 %.
        let most = answer.iter().copied().fold(0.0, f64::max);
        prop_assert!((most - 1.0815).abs() < 2e-3, "{most}");
    }
}

#[test]
fn far_above_the_cutoff_the_gain_falls_eightfold_an_octave() {
    let octave = gain(5.0, 3000.0, 100.0) / gain(5.0, 3000.0, 50.0);
    assert!((octave - 0.125).abs() < 0.003, "{octave}");
}

#[test]
fn a_cutoff_that_no_filter_can_have_is_an_error() {
    for cutoff in [150.0, 151.0, 0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(LowPass::new(cutoff, 300.0).is_err(), "{cutoff}");
    }
    assert!(LowPass::new(149.0, 300.0).is_ok());
    assert!(LowPass::new(1.0, 0.0).is_err() && LowPass::new(1.0, -300.0).is_err());
    let message = LowPass::new(150.0, 300.0).unwrap_err().to_string();
    assert_eq!(message, "a filter for samples at 300 Hz needs a cutoff above 0 Hz and below 150 Hz, not 150 Hz");
}

fn spline(points: impl IntoIterator<Item = Point2>) -> LocalContour {
    let mut spline = LocalContour::default();
    points.into_iter().for_each(|point| spline.add(point));
    spline
}

/// Points on a circle of `radius` at equal steps of arc length, counter-clockwise for a positive radius.
fn arc(radius: f64, step: f64, start: f64, centre: Point2) -> impl Iterator<Item = Point2> {
    (0..7).map(move |index| centre + radius * unit(start + step * f64::from(index) / radius))
}

/// End and direction there of the parabola, in the length along them, that fits the newest seven points best: by orthogonal factors
/// of the lengths' powers. `None` before there are seven.
fn least_squares(points: &[Point2]) -> Option<(Point2, Vector2)> {
    let newest = points.last_chunk::<7>()?;
    let lengths: Vec<f64> =
        (0..7).map(|first| -newest[first..].windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum::<f64>()).collect();
    // Powers of the share of the whole, so that all columns are of one size.
    let share = |row: usize| lengths[row] / lengths[0];
    let powers = DMatrix::from_fn(7, 3, |row, power| [1.0, share(row), share(row).powi(2)][power]);
    let places = DMatrix::from_fn(7, 2, |row, axis| newest[row][axis] - newest[6][axis]);
    let (q, r) = powers.qr().unpack();
    let fitted = r.solve_upper_triangular(&(q.transpose() * places))?;
    let row = |index: usize| Vector2::new(fitted[(index, 0)], fitted[(index, 1)]);
    Some((newest[6] + row(0), row(1) / lengths[0]))
}

proptest! {
    #[test]
    fn a_straight_contour_has_its_own_direction_and_no_curvature(
        direction in -PI..PI, x in -2.0..2.0_f64, y in -2.0..2.0_f64,
        steps in prop::collection::vec(1.0001e-3..5e-3_f64, 6..20),
    ) {
        let mut at = Point2::new(x, y);
        let mut points = vec![at];
        for step in steps {
            at += step * unit(direction);
            points.push(at);
        }
        let spline = spline(points);
        prop_assert!(spline.is_ready());
        prop_assert!((spline.tangent().unwrap() - unit(direction)).norm() < 1e-9);
        prop_assert!(spline.curvature().unwrap().abs() < 1e-6);
        prop_assert_eq!(spline.newest(), Some(at));
    }

    #[test]
    fn a_round_contour_has_its_tangent_and_curvature_to_second_order(
        radius in 0.05..0.5_f64, left in any::<bool>(), start in -PI..PI, step in 1.01e-3..3e-3_f64,
    ) {
        let radius = if left { radius } else { -radius };
        let centre = Point2::new(0.4, -0.3);
        let spline = spline(arc(radius, step, start, centre));
        let radial = unit(start + 6.0 * step / radius) * radius.signum();
        let tangent = rotate(radial, 0.5 * PI * radius.signum());
        // What a parabola leaves over is of second order in the arc's angle for the tangent, and for the curvature too.
        let angle = 6.0 * step / radius.abs();
        prop_assert!((spline.tangent().unwrap() - tangent).norm() < 0.2 * angle * angle, "{angle}");
        prop_assert!((spline.curvature().unwrap() * radius - 1.0).abs() < 0.2 * angle + 0.2 * angle * angle);
    }

    #[test]
    fn a_contour_is_the_parabola_of_least_squares_through_its_newest_keypoints_however_many_were_before(
        steps in prop::collection::vec((prop_oneof![9 => 1.0001e-3..4e-3_f64, 1 => 4e-3..3e-2_f64], -0.5..0.5_f64), 6..120),
    ) {
        let (mut at, mut course, mut points) = (Point2::new(0.7, -0.4), 1.0, vec![Point2::new(0.7, -0.4)]);
        let mut contour = spline(points.iter().copied());
        for (step, turn) in steps {
            course += turn;
            at += step * unit(course);
            points.push(at);
            contour.add(at);
            let Some((end, along)) = least_squares(&points) else { continue };
            prop_assert!((contour.point_at(0.0).unwrap() - end).norm() < 1e-9);
            prop_assert!((contour.tangent().unwrap() - along.normalize()).norm() < 1e-8 / along.norm());
        }
    }

    #[test]
    fn turning_and_moving_a_contour_turns_its_tangent_and_leaves_its_curvature(
        points in prop::collection::vec((-3e-3..3e-3_f64, 1.1e-3..4e-3_f64), 7..12), turn in -PI..PI,
    ) {
        let mut at = Point2::origin();
        let next = |(x, y)| {
            at += Vector2::new(x, y);
            at
        };
        let points: Vec<Point2> = points.into_iter().map(next).collect();
        let pose = Pose { position: Point2::new(1.0, -2.0), heading: turn };
        let plain = spline(points.iter().copied());
        let moved = spline(points.iter().map(|&point| pose.point_to_world(point)));
        let tangent = pose.vector_to_world(plain.tangent().unwrap());
        prop_assert!((tangent - moved.tangent().unwrap()).norm() < 1e-6);
        let curvature = plain.curvature().unwrap();
        prop_assert!((curvature - moved.curvature().unwrap()).abs() < 1e-5 * (1.0 + curvature.abs()));
    }
}

proptest! {
    #[test]
    fn a_distance_behind_the_end_is_measured_along_the_curve(
        radius in 0.05..0.5_f64, left in any::<bool>(), start in -PI..PI, step in 1.01e-3..2e-3_f64, share in 0.0..1.0_f64,
    ) {
        let radius = if left { radius } else { -radius };
        let centre = Point2::new(0.4, -0.3);
        let spline = spline(arc(radius, step, start, centre));
        let back = share * 6.0 * step;
        let angle = start + (6.0 * step - back) / radius;
        let due = centre + radius * unit(angle);
        // A parabola is a millionth of a metre off an arc of a few degrees, and more for one that bends more.
        let bend = 6.0 * step / radius.abs();
        prop_assert!((spline.point_at(back).unwrap() - due).norm() < 6.0 * step * 0.05 * bend * bend, "{bend}");
        let tangent = rotate(unit(angle), 0.5 * PI);
        prop_assert!((spline.tangent_at(back).unwrap() - tangent).norm() < 0.2 * bend * bend);
        prop_assert_eq!(spline.tangent_at(0.0), spline.tangent());
    }

    #[test]
    fn no_distance_leads_beyond_the_curve(back in 0.0..1.0_f64) {
        let spline = spline(arc(0.3, 2e-3, 0.0, Point2::origin()));
        prop_assert_eq!(spline.point_at(-back), spline.point_at(0.0));
        let length = 6.0 * 0.6 * (2e-3_f64 / 0.6).sin();
        prop_assert!((spline.point_at(length + back).unwrap() - spline.point_at(length).unwrap()).norm() < 1e-12);
    }
}

/// Perception of the reference rig's whiskers, 0 on the right and 1 on the left, that have swiped along a wall parallel to the
/// heading, forwards or backwards, and have then been lifted off it and moved by `gone`.
fn after_swiping(whisker: usize, body: Pose, forwards: f64, gone: Vector2) -> Perception {
    let rig = Rig::default();
    let mut perception = Perception::new(&rig, &[Some(0), Some(1)], &[ContactEstimatorKind::OneChannel; 2]).unwrap();
    let bent = 3e-4 * rig.whiskers[whisker].side() * forwards;
    let feel = |perception: &mut Perception, position, angle: f64| {
        let mut whiskers = [Reading::default(); MAX_WHISKERS];
        whiskers[whisker].base_angle = angle;
        let sample = Sample { time: 0.0, body: Pose { position, heading: body.heading }, whiskers };
        perception.update(&vec![sample; 300]);
    };
    for index in 0..12 {
        let position = body.position + forwards * 2e-3 * f64::from(index) * unit(body.heading);
        feel(&mut perception, position, bent);
        perception.record(whisker);
    }
    feel(&mut perception, body.position + gone, 0.0);
    perception
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn the_normal_leads_from_the_object_to_the_body_and_stays_when_that_has_left(
        whisker in 0_usize..2, heading in -PI..PI, forwards in any::<bool>(), x in -0.5..0.5_f64, y in -0.5..0.5_f64,
    ) {
        let body = Pose { position: Point2::new(0.2, 0.1), heading };
        let forwards = if forwards { 1.0 } else { -1.0 };
        let perception = after_swiping(whisker, body, forwards, Vector2::new(x, y));
        let (tangent, normal) = (forwards * unit(heading), unit(heading + if whisker == 0 { 0.5 * PI } else { -0.5 * PI }));
        let found = |quantity| perception.whisker_vector(whisker, quantity);
        prop_assert!((found(WhiskerVector::ContourTangent) - tangent).norm() < 1e-6);
        prop_assert!((found(WhiskerVector::ContourNormal) - normal).norm() < 1e-6);
        prop_assert!((perception.contour_at(whisker, 5e-3, ContourVector::Normal) - normal).norm() < 1e-6);
        let point = perception.contour_at(whisker, 5e-3, ContourVector::Point) + 5e-3 * tangent;
        prop_assert!((point - perception.contour_at(whisker, 0.0, ContourVector::Point)).norm() < 1e-6);
    }
}

/// A rig that states a larger noise than its contact threshold allows.
#[test]
fn the_stated_noise_raises_the_contact_threshold_from_the_first_tick() {
    let mut rig = Rig::default();
    rig.sensing.angle_noise = 2.0 * rig.sensing.contact_threshold;
    let deviation = rig.sensing.angle_noise * LowPass::noise_gain(rig.sensing.filter_cutoff, rig.sensing.sample_rate);
    let touches = |angle: f64| {
        let mut perception = Perception::new(&rig, &[Some(0)], &[ContactEstimatorKind::OneChannel]).unwrap();
        let mut whiskers = [Reading::default(); MAX_WHISKERS];
        whiskers[0].base_angle = angle;
        let body = Pose { position: Point2::origin(), heading: 0.0 };
        perception.update(&vec![Sample { time: 0.0, body, whiskers }; 300]);
        perception.is_touching(0)
    };
    assert!(4.0 * deviation > rig.sensing.contact_threshold);
    assert!(!touches(4.0 * deviation) && touches(6.0 * deviation));
}

#[test]
fn noise_comes_through_the_filter_as_much_as_is_said() {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let noise = Normal::new(0.0, 1.0).unwrap();
    for (cutoff, rate) in [(20.0, 300.0), (5.0, 300.0), (8.0, 100.0)] {
        let mut filter = LowPass::new(cutoff, rate).unwrap();
        let values = (0..200_000).map(|_| filter.next(noise.sample(&mut random)));
        let squares: Vec<f64> = values.skip(1000).map(|value| value * value).collect();
        let found = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
        let due = LowPass::noise_gain(cutoff, rate);
        assert!((found / due - 1.0).abs() < 0.03, "{cutoff} Hz at {rate} Hz: {found}, not {due}");
    }
    assert!((LowPass::noise_gain(149.0, 300.0) - 1.0).abs() < f64::EPSILON);
}

#[test]
fn halving_the_spacing_brings_a_round_contour_four_times_nearer() {
    let error = |step: f64| {
        let spline = spline(arc(0.3, step, 0.2, Point2::origin()));
        (turn_between(0.2 + 6.0 * step / 0.3 + 0.5 * PI, {
            let tangent = spline.tangent().unwrap();
            tangent.y.atan2(tangent.x)
        }))
        .abs()
    };
    let order = (error(8e-3) / error(4e-3)).log2();
    assert!(order > 1.8, "{order}");
}

#[test]
fn points_that_are_too_near_are_left_out_and_seven_make_a_curve() {
    let mut spline = LocalContour::default();
    for index in 0..65 {
        spline.add(Point2::new(1e-4 * f64::from(index), 0.0));
        assert_eq!(spline.is_ready(), index >= 60 && spline.newest().unwrap().x > 5.9e-3, "{index}");
    }
    spline.clear();
    assert!(!spline.is_ready() && spline.newest().is_none() && spline.tangent().is_none());
    assert!(spline.curvature().is_none());
}
