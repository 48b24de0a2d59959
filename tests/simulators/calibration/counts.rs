//! Calibrations from the counts of a sensor.

use proptest::prelude::*;
use vibrissa::calibration::{CountSet, fit, fit_field, read_count_sets, read_sets};
use vibrissa::geometry::{Pose, Vector2, unit};
use vibrissa::scenario::write_robot_calibration;
use vibrissa_robot::array::{Magnet, Transducer};
use vibrissa_robot::config::Config;
use vibrissa_runtime::machine::{ContactEstimatorKind, Senses, WhiskerVector};
use vibrissa_runtime::mechanics::Elastica;
use vibrissa_runtime::percept::Perception;
use vibrissa_runtime::signal::{MAX_WHISKERS, Reading, Sample};

use super::{fitted, whisker};

/// The sensor of a whisker with a hinge of 1 N m/rad, as the robot knows it before a calibration: 4.38 µT/µN m.
fn sensor(neutral: f64) -> Transducer {
    let magnet = Magnet { field_per_moment: 4.38, cubic: 0.0 };
    Transducer { magnet, microtesla_per_count: 0.15, hinge_stiffness: 1.0, neutral }
}

/// Touches by the tip of a left whisker by the elastica, as integer counts of a sensor with the magnet `magnet`.
fn counts(magnet: &Magnet, neutral: f64) -> Vec<CountSet> {
    let whisker = whisker(1.0);
    let elastica = Elastica::new(&whisker);
    let mut sets = Vec::new();
    for degrees in (150..=180).step_by(5) {
        let normal = f64::from(degrees).to_radians();
        let mut shape = elastica.straight();
        for step in 1..=18 {
            let base_angle = 3e-5 * f64::from(step);
            shape = elastica.solve_tip(base_angle, normal, &shape).unwrap();
            let contact_base = shape.contact_base - whisker.shaft.radius * unit(normal);
            let counts = (neutral + magnet.field_microtesla(base_angle) / 0.15).round();
            sets.push(CountSet { contact_base, counts, normal: Some(normal), on_shaft: false });
        }
    }
    sets
}

/// A touch of the other side of the body.
fn mirrored(set: CountSet) -> CountSet {
    let contact_base = Vector2::new(set.contact_base.x, -set.contact_base.y);
    CountSet { contact_base, normal: set.normal.map(|normal| -normal), ..set }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn the_field_per_moment_is_found_from_counts_with_its_sign(
        field in 1.2..15.0_f64, is_turned in any::<bool>(), is_right in any::<bool>(), neutral in -1000.0..1000.0_f64,
        has_normals in any::<bool>(),
    ) {
        let field_per_moment = if is_turned { -field } else { field };
        let sets = counts(&Magnet { field_per_moment, cubic: 0.0 }, neutral).into_iter();
        let sets = sets.map(|set| CountSet { normal: set.normal.filter(|_| has_normals), ..set });
        let sets: Vec<_> = sets.map(|set| if is_right { mirrored(set) } else { set }).collect();
        let found = fit_field(&whisker(1.0), &sets, &sensor(neutral)).unwrap().magnet.field_per_moment;
        // A touch on the right bends the whisker clockwise, by the same counts.
        let expected = if is_right { -field_per_moment } else { field_per_moment };
        // Without normals the moment follows from the distance of the tip alone. The elastica differs a little from the chain.
        let tolerance = if has_normals { 2e-3 } else { 0.08 };
        prop_assert!((found / expected - 1.0).abs() < tolerance, "{found} for {expected}");
    }
}

#[test]
fn a_cubic_term_of_the_magnet_is_kept() {
    let magnet = Magnet { field_per_moment: 6.0, cubic: 5e5 };
    let first = Transducer { magnet: Magnet { field_per_moment: 4.38, ..magnet }, ..sensor(70.0) };
    let found = fit_field(&whisker(1.0), &counts(&magnet, 70.0), &first).unwrap().magnet;
    assert!((found.field_per_moment / 6.0 - 1.0).abs() < 2e-3, "{found:?}");
    assert!((found.cubic - 5e5).abs() < 1e-6);
}

#[test]
fn counts_that_the_mechanics_cannot_explain_are_refused() {
    let far = counts(&Magnet { field_per_moment: 60.0, cubic: 0.0 }, 0.0);
    assert_eq!(fit_field(&whisker(1.0), &far, &sensor(0.0)), None);
    assert_eq!(fit_field(&whisker(1.0), &[], &sensor(0.0)), None);
}

/// Counts become a board and a calibration. A robot that has both finds the tip from the counts alone.
#[test]
fn one_fit_serves_the_robots_conversion_and_its_perception() {
    let (magnet, neutral) = (Magnet { field_per_moment: -6.1, cubic: 0.0 }, -812.0);
    let transducer = fit_field(&whisker(1.0), &counts(&magnet, neutral), &sensor(neutral)).unwrap();
    let sets: Vec<_> = counts(&magnet, neutral).iter().map(|set| set.converted(&transducer)).collect();
    let mut calibration = fit(&whisker(1.0), &sets, "counts".to_owned()).calibration;
    // The field per moment holds the scale, so there is nothing left for the stiffness.
    assert!((calibration.hinge_stiffness.unwrap() - 1.0).abs() < 1e-4);
    calibration.hinge_stiffness = None;
    let board = format!("{{whisker: l0, address: 0x0C, field_per_moment: {:.4}}}", transducer.magnet.field_per_moment);
    let text = write_robot_calibration("l0", &board, &calibration);
    let config = format!(
        "{text}name: robot\nbuses: [{{device: /dev/i2c-1, boards: [{board}]}}]\n\
         limits: {{speed: 0.1 m/s, yaw_rate: 60 deg/s, base_angle: 1050 urad}}\npose: {{udp: {{listen: \"0.0.0.0:9751\"}}}}\n"
    );
    let config = Config::from_text(&config).unwrap();
    assert_eq!(config.rig.whiskers[0].calibration, Some(calibration));
    let (_, found) = Transducer::of(&config, &config.rig.whiskers[0]).unwrap();
    let found = Transducer { neutral, ..found };
    for set in counts(&magnet, neutral) {
        let base_angle = found.base_angle(set.counts);
        let [parallel, limit] = [(set.normal.unwrap() - whisker(1.0).usual_normal()).abs() < 1e-9, base_angle < 5e-4];
        if !parallel || !limit {
            continue;
        }
        let mut perception = Perception::new(&config.rig, &[Some(0)], &[ContactEstimatorKind::Polynomial]).unwrap();
        let mut whiskers = [Reading::default(); MAX_WHISKERS];
        whiskers[0].base_angle = base_angle;
        for tick in 0..60 {
            perception.update(&[Sample { time: f64::from(tick) / 30.0, body: Pose::default(), whiskers }]);
        }
        let off = perception.whisker_vector(0, WhiskerVector::TipBase) - set.contact_base;
        assert!(off.norm() < 1e-3, "{} m at {base_angle} rad", off.norm());
    }
}

#[test]
fn a_calibration_that_no_perception_can_use_is_refused_by_the_robot() {
    let calibration = fitted(1.0, |set| set).calibration;
    let text = write_robot_calibration("l0", "{}", &calibration);
    let config = |text: &str| {
        Config::from_text(&format!(
            "{text}name: robot\nbuses: [{{device: /dev/i2c-1, boards: [{{whisker: l0, address: 0x0C}}]}}]\n\
             limits: {{speed: 0.1 m/s, yaw_rate: 60 deg/s, base_angle: 1050 urad}}\npose: {{udp: {{listen: \"0.0.0.0:9751\"}}}}\n"
        ))
    };
    assert!(config(&text).is_ok());
    let spoilt = text.replace("          scale: ", "          scale: -");
    assert_ne!(spoilt, text);
    let error = config(&spoilt).unwrap_err().to_string();
    assert!(error.contains("the calibration cannot be used; `recursive` cannot be used"), "{error}");
}

#[test]
fn counts_are_read_from_their_own_column_and_each_kind_says_what_the_other_needs() {
    let sets = read_count_sets(b"counts,x_mm,y_mm,contact\n-8760.5,82,51,tip\n12,80,3,shaft\n").unwrap();
    assert_eq!(sets.iter().map(|set| (set.counts, set.on_shaft)).collect::<Vec<_>>(), [(-8760.5, false), (12.0, true)]);
    let error = read_sets(b"x_mm,y_mm,counts\n82,51,300\n").unwrap_err().to_string();
    assert!(error.contains("give --config and --neutral"), "{error}");
    let error = read_count_sets(b"x_mm,y_mm,base_angle_urad\n82,51,300\n").unwrap_err().to_string();
    assert!(error.contains("leave out --config and --neutral"), "{error}");
    let error = read_count_sets(b"x_mm,y_mm,counts\n82,51,40000\n").unwrap_err().to_string();
    assert!(error.contains("`counts` must be a number from -32768 to 32768"), "{error}");
}
