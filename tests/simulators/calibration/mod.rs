//! Calibrations: what is fitted to touches in known places, their files, and what perception makes of them.

mod counts;
mod touches;

use std::f64::consts::PI;

use proptest::prelude::*;
use vibrissa::calibration::{Fitted, fit, read_sets, write_sets};
use vibrissa::diagnostic::{Colour, Source, terminal};
use vibrissa::geometry::{Point2, Pose, Vector2, rotate, unit};
use vibrissa::scenario;
use vibrissa::scenario::{read_calibration, write_calibration};
use vibrissa_runtime::calibration::{AngleSurface, Calibration, ContactSet};
use vibrissa_runtime::machine::{ContactEstimatorKind, Senses, WhiskerScalar, WhiskerVector};
use vibrissa_runtime::percept::{Perception, TipTable};
use vibrissa_runtime::rig::{Rig, Whisker};
use vibrissa_runtime::signal::{MAX_WHISKERS, Reading, Sample};

/// A reference whisker with a hinge of this stiffness (N m/rad).
fn whisker(stiffness: f64) -> Whisker {
    let mut whisker = Rig::default().whiskers.remove(1);
    whisker.hinge.stiffness = stiffness;
    whisker
}

/// Touches by the tip of such a whisker, on surfaces of many directions, from its mechanics.
fn sets(stiffness: f64) -> Vec<ContactSet> {
    let whisker = whisker(stiffness);
    let table = TipTable::new(&whisker);
    let places = (130..=190).step_by(4).flat_map(|degrees| (1..=14).map(move |step| (f64::from(degrees), step)));
    let sets = places.filter_map(|(degrees, step)| {
        let (normal, base_angle) = (degrees.to_radians(), table.range() * f64::from(step) / 30.0);
        let tip = table.at(base_angle, normal)?.tip_base;
        let contact_base = tip - whisker.shaft.radius * unit(normal);
        Some(ContactSet { contact_base, base_angle, normal: Some(normal), on_shaft: false })
    });
    sets.collect()
}

fn fitted(stiffness: f64, change: impl Fn(ContactSet) -> ContactSet) -> Fitted {
    fit(&whisker(1.0), &sets(stiffness).into_iter().map(change).collect::<Vec<_>>(), "a test".to_owned())
}

#[test]
fn the_hinge_is_found_whether_normals_are_known_or_not() {
    for stiffness in [0.25, 0.6, 1.0, 1.7, 4.0] {
        for normals in [true, false] {
            let found = fitted(stiffness, |set| ContactSet { normal: set.normal.filter(|_| normals), ..set });
            let found = found.calibration.hinge_stiffness.unwrap();
            assert!((found / stiffness - 1.0).abs() < 1e-4, "{found} for {stiffness}");
        }
    }
}

#[test]
fn fits_hold_for_sets_that_they_have_not_seen() {
    let Fitted { held_out, .. } = fitted(1.0, |set| set);
    let [curve, polynomial, surface, hinge] = &held_out[..] else { panic!("{held_out:?}") };
    assert!(polynomial.rms_mm > 0.2 && polynomial.rms_mm < 2.0, "{polynomial:?}");
    // A curve in the base angle alone leaves out the direction of the surface, 11 mm/rad.
    assert!(curve.rms_mm > 0.2 && curve.rms_mm < 2.0, "{curve:?}");
    assert!(surface.rms_mm < 0.05 && surface.max_mm < 0.5, "{surface:?}");
    assert!(hinge.rms_mm < 1e-3, "{hinge:?}");
}

#[test]
fn sets_of_a_whisker_bent_to_the_right_are_the_mirror_image() {
    let mirrored = |set: ContactSet| ContactSet {
        contact_base: Vector2::new(set.contact_base.x, -set.contact_base.y),
        base_angle: -set.base_angle,
        normal: set.normal.map(|normal| -normal),
        on_shaft: set.on_shaft,
    };
    assert_eq!(fitted(1.0, |set| set), fitted(1.0, mirrored));
}

#[test]
fn touches_of_the_shaft_do_not_count_and_without_sets_nothing_is_fitted() {
    let Fitted { calibration, held_out } = fitted(1.0, |set| ContactSet { on_shaft: true, ..set });
    assert_eq!(calibration, Calibration::new("a test".to_owned()));
    assert!(held_out.is_empty());
}

proptest! {
    #[test]
    fn the_slope_of_a_surface_is_that_of_its_values(index in 0..150_usize) {
        let sets = sets(1.0);
        let surface = AngleSurface::fit(&sets).unwrap();
        let place = sets[index % sets.len()].contact_base;
        let step = 1e-6;
        let slope = |along: Vector2| (surface.at(place + step * along).0 - surface.at(place - step * along).0) / (2.0 * step);
        let (_, gradient) = surface.at(place);
        for along in [Vector2::x(), Vector2::y()] {
            prop_assert!((slope(along) - gradient.dot(&along)).abs() < 1e-5 * gradient.norm());
        }
    }

    #[test]
    fn a_surface_holds_at_its_places_and_nowhere_far_from_them(index in 0..150_usize, angle in 0.0..6.0_f64, off in 0.0..0.05_f64) {
        let sets = sets(1.0);
        let surface = AngleSurface::fit(&sets).unwrap();
        prop_assert!(surface.reach < 15e-3, "{}", surface.reach);
        let place = sets[index % sets.len()].contact_base;
        prop_assert!(surface.contains(place));
        let place = place + off * unit(angle);
        let off_places = surface.positions.iter().map(|known| (Vector2::from(*known) - place).norm());
        let nearest = off_places.fold(f64::INFINITY, f64::min);
        prop_assert!(nearest > 0.17 * surface.reach || surface.contains(place));
        prop_assert!(nearest <= surface.reach || !surface.contains(place));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// A grid has no holes, not even where a place is missing, and ends where its outermost places are.
    #[test]
    fn a_surface_holds_all_over_a_grid_and_not_beyond_it(
        (columns, rows) in (6..12_usize, 6..12_usize), step in 1e-3..6e-3_f64, stretch in 1.0..2.5_f64, turn in 0.0..6.0_f64,
        missing in 0..12_usize, (u, v) in (0.0..1.0_f64, 0.0..1.0_f64), (side, beyond) in (0..4_usize, 0.5..8.0_f64),
    ) {
        let mesh = step * stretch;
        let at = |column: f64, row: f64| rotate(Vector2::new(column * step, row * mesh), turn) + Vector2::new(0.08, 0.02);
        let inner = (1 + missing % (columns - 2), 1 + missing % (rows - 2));
        let grid = (0..columns).flat_map(|column| (0..rows).map(move |row| (column, row))).filter(|place| *place != inner);
        let sets: Vec<_> = grid
            .map(|(column, row)| {
                let contact_base = at(column as f64, row as f64);
                ContactSet { contact_base, base_angle: contact_base.norm(), normal: None, on_shaft: false }
            })
            .collect();
        let surface = AngleSurface::fit(&sets).unwrap();
        let (width, height) = ((columns - 1) as f64, (rows - 1) as f64);
        prop_assert!(surface.contains(at(u * width, v * height)), "{}", surface.reach);
        prop_assert!(surface.contains(at(inner.0 as f64, inner.1 as f64)), "{}", surface.reach);
        let outside = match side {
            0 => at(-beyond * stretch, v * height),
            1 => at(width + beyond * stretch, v * height),
            2 => at(u * width, -beyond),
            _ => at(u * width, height + beyond),
        };
        prop_assert!(!surface.contains(outside), "{}", surface.reach);
    }

    /// Places that fill a crescent do not fill the middle between its horns.
    #[test]
    fn a_surface_does_not_hold_between_the_horns_of_a_crescent(turn in 0.0..6.0_f64, radius in 0.0..0.035_f64, angle in 0.0..3.1_f64) {
        let places = (0..5).flat_map(|ring| (0..=36).map(move |step| (0.04 + 2e-3 * f64::from(ring), f64::from(step) * PI / 36.0)));
        let sets: Vec<_> = places
            .map(|(radius, angle)| {
                let contact_base = radius * unit(turn + angle);
                ContactSet { contact_base, base_angle: radius, normal: None, on_shaft: false }
            })
            .collect();
        let surface = AngleSurface::fit(&sets).unwrap();
        prop_assert!(!surface.contains(radius * unit(turn + angle)));
        prop_assert!(surface.contains((0.041 + 0.17 * radius) * unit(turn + angle)));
    }
}

/// On an even grid, too, sets that are held out are in range of the others.
#[test]
fn a_fit_to_a_grid_is_judged_by_sets_that_it_has_not_seen() {
    let grid = (0..12).flat_map(|column| (0..10).map(move |row| Vector2::new(f64::from(column), f64::from(row))));
    let sets: Vec<_> = grid
        .map(|place| {
            let contact_base = Vector2::new(0.07, 0.01) + 2e-3 * place;
            ContactSet { contact_base, base_angle: 3e-3 * contact_base.y, normal: None, on_shaft: false }
        })
        .collect();
    let Fitted { held_out, .. } = fit(&whisker(1.0), &sets, String::new());
    let surface = held_out.iter().find(|model| model.model == "recursive").unwrap();
    // All but those outermost.
    assert!(surface.sets >= 80 && surface.max_mm < 1e-3, "{surface:?}");
}

#[test]
fn a_file_gives_back_what_was_written() {
    let calibration = fitted(1.3, |set| set).calibration;
    assert_eq!(read_calibration(&write_calibration(&calibration)).unwrap(), calibration);
}

proptest! {
    #[test]
    fn a_file_gives_back_whatever_it_is_about(about in any::<String>()) {
        let calibration = Calibration::new(about);
        prop_assert_eq!(read_calibration(&write_calibration(&calibration)).unwrap(), calibration);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn touches_in_too_few_places_or_on_one_line_are_not_fitted_to(
        places in 1..45_usize, turn in 0.0..6.0_f64, off in 0.0..1e-9_f64,
    ) {
        let sets = sets(1.0);
        let again: Vec<_> = (0..200).map(|index| sets[index % places]).collect();
        prop_assert_eq!(fit(&whisker(1.0), &again, String::new()).held_out, []);
        let on_line = |index: usize| Vector2::new(0.08, 0.04) + 1e-4 * index as f64 * unit(turn) + off * unit(index as f64);
        let line: Vec<_> = (0..60).map(|index| ContactSet { contact_base: on_line(index), ..sets[index] }).collect();
        prop_assert_eq!(AngleSurface::fit(&line), None);
    }
}

#[test]
fn touches_of_one_base_angle_give_no_curve() {
    let Fitted { calibration, .. } = fitted(1.0, |set| ContactSet { base_angle: 3e-4, ..set });
    assert_eq!(calibration.one_channel, None);
}

#[test]
fn a_hinge_beyond_all_that_are_tried_is_not_taken_for_the_nearest_that_is() {
    for factor in [8.0, 0.12] {
        // As if the sensor's scale were off.
        let Fitted { calibration, held_out } =
            fitted(1.0, |set| ContactSet { base_angle: set.base_angle / factor, ..set });
        assert_eq!(calibration.hinge_stiffness, None, "{factor}");
        assert!(held_out.iter().all(|model| !model.model.contains("sliding")), "{held_out:?}");
    }
}

#[test]
fn what_is_no_calibration_is_refused_and_the_error_says_why() {
    let good = write_calibration(&fitted(1.0, |set| set).calibration);
    let start = |key: &str| good.find(key).unwrap();
    let line = |key: &str| good[start(key)..].lines().next().unwrap().to_owned();
    let bad = [
        (String::new(), "not a calibration"),
        ("a text".to_owned(), "not a calibration"),
        (good.replace("vibrissa_calibration: 2", "vibrissa_calibration: 1"), "format 1"),
        (good.replace("vibrissa_calibration: 2", "vibrissa_calibration: 3\nwhat_is_new: 7"), "format 3"),
        (good.replace("hinge_stiffness", "stiffness"), "not a calibration"),
        (good.replace(&line("hinge_stiffness"), "hinge_stiffness: .nan"), "`hinge_stiffness`"),
        (good.replace(&line("  range"), "  range: [5e-4, 1e-4]"), "`one_channel`"),
        (good.replace(&line("  covariance"), "  covariance: [1e-6, 1e-5, 1e-6]"), "`one_channel`"),
        (good.replace(&line("  length"), "  length: 0"), "`polynomial`"),
        (good.replace(&line("  scale"), "  scale: 0"), "`recursive`"),
        (good.replace(&line("  reach"), "  reach: -1"), "`recursive`"),
        (good.replace(&line("  places"), "  places: []"), "`recursive`"),
    ];
    for (text, reason) in bad {
        let error = read_calibration(&text).unwrap_err().to_string();
        assert!(error.contains(reason), "{error}");
    }
}

#[test]
fn sets_are_read_as_they_were_written() {
    let sets = sets(1.0);
    let read = read_sets(write_sets(&sets).as_bytes()).unwrap();
    assert_eq!(read.len(), sets.len());
    for (read, set) in read.iter().zip(&sets) {
        assert!(
            (read.contact_base - set.contact_base).norm() < 1e-7 && (read.base_angle - set.base_angle).abs() < 1e-10
        );
        assert!((read.normal.unwrap() - set.normal.unwrap()).abs() < 1e-5);
    }
    let few = "base_angle_urad, y_mm, x_mm\n# measured by hand\n-300, -51, 82\n";
    let contact_base = Vector2::new(0.082, -0.051);
    let [set] = read_sets(few.as_bytes()).unwrap()[..] else { panic!("one set") };
    assert!((set.contact_base - contact_base).norm() < 1e-12 && set.normal.is_none() && !set.on_shaft);
}

#[test]
fn a_line_that_cannot_be_read_is_told() {
    for (text, reason) in [
        ("x_mm,y_mm\n1,2\n", "line 1: the column `base_angle_urad` is missing"),
        ("x_mm,y_mm,base_angle_urad,z_mm\n", "line 1: there is no column `z_mm`"),
        (
            "x_mm,y_mm,base_angle_urad\n1,2,3\n1,two,3\n",
            "line 3: `y_mm` must be a number from -10000 to 10000, and is `two`",
        ),
        ("x_mm,y_mm,base_angle_urad\n1,2,inf\n", "line 2: `base_angle_urad` must be a number"),
        ("x_mm,y_mm,base_angle_urad\n1,2e300,3\n", "line 2: `y_mm` must be a number from -10000 to 10000"),
        ("x_mm,y_mm,base_angle_urad,x_mm\n", "line 1: the column `x_mm` occurs twice"),
        ("x_mm,y_mm,base_angle_urad\n1,2\n", "line 2: every line"),
        ("x_mm,y_mm,base_angle_urad,contact\n1,2,3,edge\n", "line 2: `contact` must be `tip` or `shaft`"),
    ] {
        let error = read_sets(text.as_bytes()).unwrap_err().to_string();
        assert!(error.starts_with(reason), "{error}");
    }
}

/// What a left whisker that is bent by `base_angle` (rad) is perceived as, by a rig with a calibration.
fn perceived(
    kind: ContactEstimatorKind,
    calibration: Option<Calibration>,
    stiffness: f64,
    base_angle: f64,
) -> Perception {
    let mut rig = Rig::default();
    rig.whiskers[1].hinge.stiffness = stiffness;
    rig.whiskers[1].calibration = calibration;
    let mut perception = Perception::new(&rig, &[Some(1)], &[kind]).unwrap();
    for tick in 0..30 {
        let samples: [Sample; 10] = std::array::from_fn(|index| {
            let time = (tick * 10 + index) as f64 / 300.0;
            let mut whiskers = [Reading::default(); MAX_WHISKERS];
            whiskers[1].base_angle = base_angle * (4.0 * time).min(1.0);
            let body = Pose { position: Point2::new(0.0, 0.05 * time), heading: std::f64::consts::FRAC_PI_2 };
            Sample { time, body, whiskers }
        });
        perception.update(&samples);
        perception.record(0);
    }
    perception
}

#[test]
fn a_calibrated_hinge_is_perceived_as_if_the_rig_had_it() {
    let mut calibration = Calibration::new("stiffer than it was made".to_owned());
    calibration.hinge_stiffness = Some(1.4);
    for kind in [ContactEstimatorKind::OneChannel, ContactEstimatorKind::Sliding, ContactEstimatorKind::Recursive] {
        let calibrated = perceived(kind, Some(calibration.clone()), 1.0, 3e-4);
        let (by_rig, made) = (perceived(kind, None, 1.4, 3e-4), perceived(kind, None, 1.0, 3e-4));
        let tip = |perception: &Perception| perception.contact(0).unwrap().point_world;
        // The delay of the hinge is its damping over its stiffness, and the angle does not change any more.
        assert!((tip(&calibrated) - tip(&by_rig)).norm() < 1e-12, "{kind:?}");
        assert!((tip(&calibrated) - tip(&made)).norm() > 1e-3, "{kind:?}");
    }
}

#[test]
fn what_was_measured_is_what_one_channel_tells_and_beyond_its_range_it_tells_nothing() {
    let calibration = fitted(1.0, |set| set).calibration;
    let curve = calibration.one_channel.clone().unwrap();
    let told =
        |base_angle: f64| perceived(ContactEstimatorKind::OneChannel, Some(calibration.clone()), 1.0, base_angle);
    let found = told(3e-4);
    let tip_base = found.whisker_vector(0, WhiskerVector::TipBase);
    assert!((tip_base - curve.at(3e-4)).norm() < 2e-6, "{tip_base} {}", curve.at(3e-4));
    let [xx, _, yy] = curve.covariance;
    assert!((found.whisker(0, WhiskerScalar::TipDeviation) / (xx + yy).sqrt() - 1.0).abs() < 1e-9);
    for base_angle in [1.01 * curve.range[1], 0.99 * curve.range[0]] {
        let beyond = told(base_angle);
        assert_eq!((beyond.contact(0), beyond.recorded_tip(0)), (None, None));
        assert!(beyond.whisker(0, WhiskerScalar::TipDeviation).is_infinite());
        // Something to steer by there is all the same: the end of what was measured.
        let end = curve.at(base_angle.clamp(curve.range[0], curve.range[1]));
        assert!((beyond.whisker_vector(0, WhiskerVector::TipBase) - end).norm() < 2e-4);
    }
}

const SCENARIO: &str = "name: calibrated
rig:
  whiskers: {r0: {}, l0: {calibration: l0.yaml}}
objects: [{circle: {centre: [40 cm, 40 cm], radius: 30 cm}}]
start: {position: [0 mm, 72 mm], heading: 90 deg}
stop: {time: 120 s}
";

#[test]
fn a_rig_loads_the_calibration_of_a_whisker_and_says_what_is_wrong_with_it() {
    let calibration = fitted(1.1, |set| set).calibration;
    let source = Source::new("calibrated.yaml", SCENARIO);
    let text = write_calibration(&calibration);
    let scene = scenario::read_with(&source, &mut |path| {
        assert_eq!(path, "l0.yaml");
        Ok(text.clone().into_bytes())
    });
    let whiskers = scene.unwrap().rig.whiskers;
    assert_eq!((&whiskers[0].calibration, &whiskers[1].calibration), (&None, &Some(calibration)));
    for (bytes, reason) in [
        (Err("there is none".to_owned()), "there is none"),
        (Ok(b"vibrissa_calibration: 2\nabout: \xb5m\n".to_vec()), "the byte 0xB5 in line 2, column 8"),
        (Ok(b"vibrissa_calibration: 7\nabout: x\n".to_vec()), "format 7"),
    ] {
        let faults = scenario::read_with(&source, &mut |_| bytes.clone()).unwrap_err();
        let shown = terminal(&source, &faults, Colour::Plain);
        assert!(shown.contains(reason) && shown.contains("3:40"), "{shown}");
    }
}

#[cfg(feature = "sim")]
#[test]
fn a_stage_in_the_simulated_world_finds_the_hinge_that_is_there() {
    let mut rig = Rig::default();
    rig.whiskers[0].hinge.stiffness = 1.25;
    let sets = vibrissa::calibration::simulated_sets(&rig, &vibrissa::physics::Physics::default(), 0, 0).unwrap();
    assert!((150..=180).contains(&sets.len()), "{}", sets.len());
    let Fitted { calibration, held_out } = fit(&whisker(1.0), &sets, String::new());
    let stiffness = calibration.hinge_stiffness.unwrap();
    assert!((stiffness / 1.25 - 1.0).abs() < 0.01, "{stiffness}");
    // Curves in the base angle alone leave out the direction of the surface.
    for model in &held_out {
        let most = if ["one_channel", "polynomial"].contains(&model.model) { 1.5 } else { 0.1 };
        assert!(model.rms_mm < most, "{model:?}");
    }
}
