//! Fits to drawn whiskers that touch a pin.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test may panic and explain itself")]

use super::parameters::{self, COUNT, Parameter, Parameters};
use super::workspace::Workspace;
use super::{PlannedTouch, Stroke, TouchFit, TouchNoise, TouchPlan, TouchReading, TouchRefusal};
use crate::geometry::{Point2, Pose, Vector2, rotate, unit};
use crate::math;
use crate::mechanics::Obstacle;
use crate::rig::{Rig, Whisker};

/// Uniform and normal numbers from a seed (`SplitMix64`).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn uniform(&mut self, half: f64) -> f64 {
        half * (2.0 * self.next() - 1.0)
    }

    fn normal(&mut self, deviation: f64) -> f64 {
        let radius = (-2.0 * math::ln(1.0 - self.next())).sqrt();
        deviation * radius * math::cos(std::f64::consts::TAU * self.next())
    }
}

const RADIUS: f64 = 10e-3;
const NOISE: f64 = 5e-8;

/// The true whisker of a plausible array.
fn drawn(random: &mut Random) -> Parameters {
    let mut truth = Parameters::zeros();
    let halves = [0.05, 0.5e-3, 1_f64.to_radians(), 0.5e-3, 0.5e-3, 0.1, 0.01, 2e-6, 0.1, 0.0, 0.0, 0.0];
    for index in 0..COUNT {
        truth[index] = random.uniform(halves[index]);
    }
    truth[Parameter::Friction.index()] = truth[Parameter::Friction.index()].abs();
    truth
}

/// The reading of a true whisker for a planned touch.
fn touched(
    whisker: &Whisker,
    truth: &Parameters,
    planned: &PlannedTouch,
    noise: &TouchNoise,
    random: &mut Random,
) -> Option<TouchReading> {
    let obstacle_body = whisker.base_pose().point_to_world(planned.pin_base);
    let body = Pose::default();
    let obstacle = Obstacle::Pin { centre: obstacle_body, radius: RADIUS };
    let off = Pose {
        position: body.position + Vector2::new(random.normal(noise.position), random.normal(noise.position)),
        heading: random.normal(noise.heading),
    };
    let (mechanics, seen) = parameters::mechanics(whisker, truth, &obstacle.seen_from(off));
    let touch = mechanics.press(&seen, planned.side)?;
    let offset = truth[Parameter::Offset.index()];
    let play = planned.side * truth[Parameter::Play.index()];
    Some(TouchReading {
        body,
        obstacle,
        is_known: true,
        side: planned.side,
        base_angle: touch.base_angle + play + offset + random.normal(NOISE),
        in_air: offset + random.normal(NOISE),
        deviation: NOISE * 2_f64.sqrt(),
    })
}

/// The fit to touches that it has chosen itself, and these touches.
fn calibrated(
    whisker: &Whisker,
    truth: &Parameters,
    count: usize,
    random: &mut Random,
    mut change: impl FnMut(&mut TouchReading, &mut Random),
) -> (TouchFit, Vec<TouchReading>) {
    let noise = TouchNoise::default();
    let plan = TouchPlan::new(whisker, RADIUS, NOISE * 2_f64.sqrt(), &noise);
    let (mut fit, mut readings, mut missed) = (TouchFit::untouched(whisker), Vec::new(), Vec::new());
    for _ in 0..count {
        let planned = plan.next(&fit, &missed).unwrap();
        let Some(mut reading) = touched(whisker, truth, &planned, &noise, random) else {
            missed.push(planned);
            continue;
        };
        change(&mut reading, random);
        readings.push(reading);
        if let Some(next) = TouchFit::new(whisker, &readings, &noise) {
            fit = next;
        }
    }
    (fit, readings)
}

/// True if the parameters of the whisker are within the ellipsoid with a probability of 95 %.
fn is_within(fit: &TouchFit, truth: &Parameters) -> bool {
    // The 95 % quantile of chi-square with eight degrees of freedom.
    const QUANTILE: f64 = 15.507;
    let off = fit.parameters - truth;
    let known = off.fixed_rows::<{ Parameter::WHISKER }>(0);
    let inverse = fit.covariance.fixed_view::<8, 8>(0, 0).try_inverse().unwrap();
    (known.transpose() * inverse * known).x < QUANTILE
}

fn left() -> Whisker {
    Rig::default().whiskers.remove(1)
}

#[test]
fn the_ellipsoid_of_drawn_whiskers_has_their_true_parameters_in_95_percent_of_all_cases() {
    let (mut within, mut accepted, mut errors) = (0, 0, Vec::new());
    for seed in 0..24 {
        let mut random = Random(seed);
        let truth = drawn(&mut random);
        let whisker = Rig::default().whiskers.remove(usize::from(seed % 2 == 0));
        let (fit, readings) = calibrated(&whisker, &truth, 20, &mut random, |_, _| ());
        within += usize::from(is_within(&fit, &truth));
        accepted += usize::from(fit.check(&readings, &TouchNoise::default(), std::iter::empty()).is_ok());
        let workspace = Workspace::new(&whisker, &fit.parameters);
        errors.push((workspace.error(&(fit.parameters - truth)), workspace.deviation(&fit.covariance)));
    }
    let mean = |values: &dyn Fn(&(f64, f64)) -> f64| errors.iter().map(values).sum::<f64>() / errors.len() as f64;
    println!("within {within}, accepted {accepted}, error {:.3e}, deviation {:.3e}", mean(&|e| e.0), mean(&|e| e.1));
    assert!((20..=24).contains(&within), "{within} of 24");
    assert!(accepted >= 23, "{accepted} of 24");
}

#[test]
fn strokes_show_the_friction_of_a_whisker_that_slides_in_spite_of_late_readings() {
    for (seed, friction, lag) in [(0, 0.0, 0.0), (1, 0.05, 0.01), (2, 0.1, -0.02), (3, 0.3, 0.0), (4, 0.0, 0.03)] {
        let mut random = Random(seed);
        let (whisker, truth) = (left(), drawn(&mut random));
        let (fit, readings) = calibrated(&whisker, &truth, 12, &mut random, |_, _| ());
        // The pin slides over the places of the touches. A stroke takes so little time that its poses are hardly noisy.
        let noise = TouchNoise { position: 1e-5, heading: 1e-5 };
        let strokes = readings.iter().zip([1e-3, 4e-3].into_iter().cycle()).filter_map(|(reading, speed)| {
            let Obstacle::Pin { centre, .. } = reading.obstacle else { return None };
            let planned = PlannedTouch {
                pin_base: whisker.base_pose().point_from_world(centre),
                side: reading.side,
                base_angle: reading.base_angle,
            };
            let mut sliding = |friction: f64| {
                let mut truth = truth;
                truth[Parameter::Friction.index()] = friction;
                touched(&whisker, &truth, &planned, &noise, &mut random)
            };
            let velocity_world = -speed * rotate(unit(whisker.direction_body), reading.body.heading);
            let (mut outwards, mut back) = (sliding(friction)?, sliding(-friction)?);
            outwards.body.position += lag * velocity_world;
            back.body.position -= lag * velocity_world;
            Some(Stroke { outwards, back, velocity_world })
        });
        let strokes: Vec<_> = strokes.collect();
        let [found, deviation] = fit.with_strokes(&strokes, &noise).sliding_friction;
        assert!((found - friction).abs() < 3.0 * deviation + 0.05 * friction, "{friction}: {found} ± {deviation}");
        assert!(deviation < 0.01, "{deviation}");
    }
}

#[test]
fn a_bent_whisker_is_refused_as_bent() {
    for seed in 0..6 {
        let mut random = Random(seed);
        let mut truth = drawn(&mut random);
        // The tip is 8 mm aside.
        truth[Parameter::Curvature.index()] = if seed % 2 == 0 { 1.6 } else { -1.6 };
        let (fit, readings) = calibrated(&left(), &truth, 16, &mut random, |_, _| ());
        let verdict = fit.check(&readings, &TouchNoise::default(), std::iter::empty());
        assert!(matches!(verdict, Err(TouchRefusal::Bent { .. })), "{seed}: {verdict:?}");
    }
}

#[test]
fn a_touch_that_is_repeated_counts_once() {
    let (mut random, truth) = (Random(1), Parameters::zeros());
    let (_, readings) = calibrated(&left(), &truth, 16, &mut random, |_, _| ());
    let verdict = |readings: &[TouchReading]| {
        TouchFit::accepted(&left(), readings, &TouchNoise::default(), std::iter::empty()).map(|_| ())
    };
    assert_eq!(verdict(&readings), Ok(()));
    for different in 1..6 {
        let repeated: Vec<_> = readings.iter().copied().take(different).cycle().take(20).collect();
        assert_eq!(verdict(&repeated), Err(TouchRefusal::TooFew { count: different }));
    }
}

#[test]
fn a_loose_whisker_is_refused_as_loose_whether_its_play_shows_in_the_air_or_in_contact() {
    for seed in 0..6 {
        let mut random = Random(seed);
        let mut truth = drawn(&mut random);
        truth[Parameter::Play.index()] = 2e-5;
        let is_sprung = seed % 2 == 0;
        let rattle = |reading: &mut TouchReading, random: &mut Random| {
            if !is_sprung {
                reading.in_air += random.uniform(2e-5);
            }
        };
        let (fit, readings) = calibrated(&left(), &truth, 16, &mut random, rattle);
        let verdict = fit.check(&readings, &TouchNoise::default(), std::iter::empty());
        assert!(matches!(verdict, Err(TouchRefusal::Loose { .. })), "{seed}: {verdict:?}");
    }
}

#[test]
fn a_swapped_whisker_is_refused_as_swapped() {
    let mut shorter = left();
    shorter.name = "l1".to_owned();
    shorter.shaft.length = 0.085;
    for seed in 0..3 {
        // The sensor of another whisker, which touches nothing.
        let mut random = Random(seed);
        let truth = drawn(&mut random);
        let silent = |reading: &mut TouchReading, random: &mut Random| reading.base_angle = random.normal(NOISE);
        let (fit, readings) = calibrated(&left(), &truth, 8, &mut random, silent);
        let verdict = fit.check(&readings, &TouchNoise::default(), std::iter::once(&shorter));
        assert!(matches!(verdict, Err(TouchRefusal::Swapped { .. })), "{seed}: {verdict:?}");
        // The shaft of another whisker.
        let (fit, readings) = {
            let mounted = Whisker { shaft: shorter.shaft.clone(), ..left() };
            let mut random = Random(seed);
            let (_, readings) = calibrated(&mounted, &truth, 16, &mut random, |_, _| ());
            (TouchFit::new(&left(), &readings, &TouchNoise::default()), readings)
        };
        let verdict = fit.unwrap().check(&readings, &TouchNoise::default(), std::iter::once(&shorter));
        assert!(matches!(verdict, Err(TouchRefusal::Swapped { .. })), "{seed}: {verdict:?}");
    }
}

#[test]
fn a_pin_elsewhere_is_refused_as_displaced() {
    for seed in 0..3 {
        let mut random = Random(seed);
        let truth = drawn(&mut random);
        let (fit, readings) = calibrated(&left(), &truth, 16, &mut random, |reading, _| {
            if let Obstacle::Pin { centre, .. } = &mut reading.obstacle {
                *centre += Vector2::new(3e-3, -4e-3);
            }
        });
        let verdict = fit.check(&readings, &TouchNoise::default(), std::iter::empty());
        assert!(matches!(verdict, Err(TouchRefusal::Displaced { .. })), "{seed}: {verdict:?}");
    }
}

/// Touches of a face by the tip, at three attitudes and four depths. The normal of the face is the first axis of the world.
/// `said` is where the face is said to be.
fn face_touches(truth: &Parameters, said: Obstacle, is_known: bool, random: &mut Random) -> Vec<TouchReading> {
    let (whisker, noise) = (left(), TouchNoise::default());
    let tip = whisker.base_pose().point_to_world(Point2::new(whisker.shaft.length, 0.0)).coords;
    let (side, radius, base) = (1.0, whisker.shaft.radius_at(1.0), whisker.direction_body);
    let pose = |turn: f64, depth: f64| {
        // The normal is turned from the perpendicular of the shaft towards the base.
        let heading = -(base + side * (std::f64::consts::FRAC_PI_2 + turn.to_radians()));
        Pose { position: Point2::new(radius - depth, 0.0) - rotate(tip, heading), heading }
    };
    let poses =
        [10.0, 30.0, 50.0].into_iter().flat_map(|turn| [4e-3, 8e-3, 12e-3, 16e-3].map(|depth| pose(turn, depth)));
    let face = Obstacle::Face { point: Point2::origin(), normal: 0.0 };
    let reading = |body: Pose| {
        let off = Pose {
            position: body.position + Vector2::new(random.normal(noise.position), random.normal(noise.position)),
            heading: body.heading + random.normal(noise.heading),
        };
        let (mechanics, seen) = parameters::mechanics(&whisker, truth, &face.seen_from(off));
        let touch = mechanics.press(&seen, side)?;
        let in_air = truth[Parameter::Offset.index()];
        Some(TouchReading {
            body,
            obstacle: said,
            is_known,
            side,
            base_angle: touch.base_angle + in_air + random.normal(NOISE),
            in_air: in_air + random.normal(NOISE),
            deviation: NOISE * 2_f64.sqrt(),
        })
    };
    poses.filter_map(reading).collect()
}

/// A face that is 4 mm and 3 degrees from where it is said to be.
fn rough_face() -> Obstacle {
    Obstacle::Face { point: Point2::new(-4e-3, 1e-3), normal: 3_f64.to_radians() }
}

#[test]
fn a_face_of_unknown_position_determines_the_stiffness_and_leaves_length_and_base_open() {
    let tolerances = parameters::tolerances();
    let open = [Parameter::Length, Parameter::BaseX, Parameter::BaseY].map(Parameter::index);
    for seed in 0..4 {
        let mut random = Random(seed);
        let mut truth = drawn(&mut random);
        let readings = face_touches(&truth, rough_face(), false, &mut random);
        assert_eq!(readings.len(), 12, "{seed}");
        let fit = TouchFit::accepted(&left(), &readings, &TouchNoise::default(), std::iter::empty()).unwrap();
        // The rough face, as a difference from the true one.
        truth[Parameter::FaceHeight.index()] = 4e-3;
        truth[Parameter::FaceTurn.index()] = -3_f64.to_radians();
        let deviation = |parameter: Parameter| fit.covariance[(parameter.index(), parameter.index())].sqrt();
        let off = |parameter: Parameter| (fit.parameters - truth)[parameter.index()] / deviation(parameter);
        let scaled = nalgebra::Matrix3::from_fn(|row, column| {
            fit.covariance[(open[row], open[column])] / (tolerances[open[row]] * tolerances[open[column]])
        });
        let weakest = scaled.symmetric_eigenvalues().max().sqrt();
        println!(
            "stiffness {:.4}, face height {:.2e}, turn {:.2e}, weakest of length and base {weakest:.2}, tips {:.2e}",
            deviation(Parameter::Stiffness),
            deviation(Parameter::FaceHeight),
            deviation(Parameter::FaceTurn),
            fit.tip_deviation()
        );
        assert!(is_within(&fit, &truth), "{seed}");
        assert!(off(Parameter::Stiffness).abs() < 4.0 && off(Parameter::FaceTurn).abs() < 4.0, "{seed}");
        assert!(deviation(Parameter::Stiffness) < 0.5 * tolerances[Parameter::Stiffness.index()], "{seed}");
        assert!(weakest > 0.5, "{seed}: {weakest}");
    }
}

#[test]
fn a_face_that_is_said_to_be_elsewhere_is_refused() {
    let mut random = Random(1);
    let truth = drawn(&mut random);
    let readings = face_touches(&truth, rough_face(), true, &mut random);
    let verdict = TouchFit::accepted(&left(), &readings, &TouchNoise::default(), std::iter::empty());
    assert!(verdict.is_err(), "{verdict:?}");
}

/// The edge of a gauge block is a pin without a radius, and its face is where it is said to be.
#[test]
fn an_edge_and_a_face_of_a_block_calibrate_a_whisker() {
    let mut random = Random(3);
    let truth = drawn(&mut random);
    let face = Obstacle::Face { point: Point2::origin(), normal: 0.0 };
    let mut readings = face_touches(&truth, face, true, &mut random);
    let noise = TouchNoise::default();
    for (share, side, depth) in
        [(0.5, 1.0, 8e-3), (0.7, 1.0, 14e-3), (0.85, 1.0, 18e-3), (0.5, -1.0, 8e-3), (0.8, -1.0, 16e-3)]
    {
        let pin_base = Point2::new(share * left().shaft.length, side * depth);
        let edge = Obstacle::Pin { centre: left().base_pose().point_to_world(pin_base), radius: 0.0 };
        let off =
            Pose { position: Point2::new(random.normal(noise.position), random.normal(noise.position)), heading: 0.0 };
        let (mechanics, seen) = parameters::mechanics(&left(), &truth, &edge.seen_from(off));
        let touch = mechanics.press(&seen, side).unwrap();
        let in_air = truth[Parameter::Offset.index()];
        readings.push(TouchReading {
            body: Pose::default(),
            obstacle: edge,
            is_known: true,
            side,
            base_angle: touch.base_angle + in_air,
            in_air,
            deviation: NOISE,
        });
    }
    let fit = TouchFit::accepted(&left(), &readings, &noise, std::iter::empty()).unwrap();
    assert!(is_within(&fit, &truth));
    // What the touches are worth: a fraction of the tolerances, and no less than the fit states.
    let deviation = fit.tip_deviation();
    println!("tip deviation {deviation:.3e}, before {:.3e}", TouchFit::untouched(&left()).tip_deviation());
    assert!(deviation < 0.25 * TouchFit::untouched(&left()).tip_deviation(), "{deviation}");
    assert!(Workspace::new(&left(), &fit.parameters).error(&(fit.parameters - truth)) < 3.0 * deviation);
}

#[test]
fn a_whisker_too_weak_for_its_hinge_is_known_before_any_touch() {
    let noise = TouchNoise { position: 1e-5, heading: 1e-6 };
    let check =
        |whisker: &Whisker| TouchPlan::new(whisker, 0.1 * whisker.shaft.length, 1e-7, &noise).check(whisker, 20, 2e-8);
    for whisker in &Rig::default().whiskers {
        assert_eq!(check(whisker), Ok(()));
        // The shaft of a rat: 30 mm of keratin, 0.1 mm thick at its base and 4 um at its tip.
        let mut weak = whisker.clone();
        (weak.shaft.length, weak.shaft.radius, weak.shaft.tip_radius) = (30e-3, 50e-6, Some(2e-6));
        weak.shaft.young_modulus = 3e9;
        assert!(matches!(check(&weak), Err(TouchRefusal::Hopeless { touches: 20, .. })), "{:?}", check(&weak));
        // A stiffer tip bends the hinge more.
        weak.shaft.tip_radius = Some(25e-6);
        assert_eq!(check(&weak), Ok(()));
    }
}
