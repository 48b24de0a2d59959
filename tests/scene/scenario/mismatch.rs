//! Mismatches in scenarios and in files.

use std::path::Path;

use vibrissa::diagnostic::Source;
use vibrissa::mismatch::{Loss, Mismatch, Property, Range};
use vibrissa::scenario::{read_mismatch, read_with};
use vibrissa::scene::Scene;

const DISK: &str = include_str!("../../../scenarios/disk.yaml");
const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenarios");

fn file(name: &str) -> Mismatch {
    let text = std::fs::read_to_string(format!("{FOLDER}/mismatch/{name}.yaml")).unwrap();
    read_mismatch(&Source::new(name, text)).unwrap()
}

/// The disk with a section, in the folder of scenarios.
fn disk(section: &str) -> Scene {
    let mut files = |path: &str| std::fs::read(Path::new(FOLDER).join(path)).map_err(|error| error.to_string());
    let source = Source::new("disk.yaml", format!("{DISK}\nmismatch: {section}\n"));
    read_with(&source, &mut files).unwrap_or_else(|faults| panic!("{faults:?}"))
}

/// The value of a property without a width.
fn value(mismatch: &Mismatch, property: Property) -> Option<f64> {
    let Range { least, greatest } = mismatch.common.get(property)?;
    assert!(greatest - least < f64::MIN_POSITIVE, "{property:?}");
    Some(least)
}

#[test]
fn the_hard_array_has_twice_the_values_of_the_plausible_one() {
    let (plausible, hard) = (file("plausible"), file("hard"));
    for property in Property::all() {
        let factor = if property == Property::WanderTime { 1.0 } else { 2.0 };
        let (value, twice) = (value(&plausible, property), value(&hard, property));
        assert_eq!(value.is_some(), twice.is_some(), "{property:?}");
        if let (Some(value), Some(twice)) = (value, twice) {
            assert!((twice - factor * value).abs() < 1e-12 * twice, "{property:?}");
        }
    }
}

#[test]
fn the_ranges_of_drawn_arrays_are_about_zero_and_end_at_the_plausible_values() {
    let (plausible, drawn) = (file("plausible"), file("array"));
    for property in Property::all() {
        let Some(value) = value(&plausible, property) else { continue };
        let Range { least, greatest } = drawn.common.get(property).unwrap();
        assert!((greatest - value).abs() < 1e-15, "{property:?}");
        let is_signed = least < 0.0;
        assert!(!is_signed || (least + value).abs() < 1e-15, "{property:?}");
    }
}

#[test]
fn every_key_of_a_section_reaches_the_array() {
    let scene = disk(
        "{seed: 4, stiffness: 5 %, radius: 1 %, tip_radius: -5 %, length: 1 mm, tip_aside: 2 mm, links: 20, hinge: 3 %,
          base: {forward: 1 mm, outward: 2 mm}, direction: 1 deg,
          sensor: {gain: 2 %, cubic: 3 %, offset: 4 urad, drift_per_minute: 5 urad, noise: 6 urad, resolution: 7 urad,
            latency: 8 ms, lost: {share: 9 %, kind: stale}},
          pose: {noise: {position: 1 mm, heading: 2 deg}, wander: {position: 3 mm, heading: 4 deg, time: 5 s}, latency: 6 ms},
          command: {latency: 33 ms}, servo: 70 ms, friction: 0.2,
          whiskers: {l0: {stiffness: 0 %, sensor: {offset: 0 urad}}}}",
    );
    let mismatch = scene.mismatch.as_ref().unwrap();
    let mut own = Property::all().filter(|property| !matches!(property, Property::Rig(_)));
    assert!(own.all(|property| mismatch.common.get(property).is_some()));
    assert_eq!(mismatch.seed, Some(4));
    let (assumed, array) = (&scene.rig, scene.true_array().unwrap());
    let near =
        |found: f64, expected: f64| assert!((found - expected).abs() < 1e-9 * expected.abs(), "{found} {expected}");
    let [right, left] = [0, 1].map(|index: usize| &array.rig.whiskers[index]);
    near(right.shaft.young_modulus, 1.05 * assumed.whiskers[0].shaft.young_modulus);
    near(left.shaft.young_modulus, assumed.whiskers[1].shaft.young_modulus);
    near(right.shaft.radius, 1.01 * 0.125e-3);
    near(right.shaft.tip_radius.unwrap(), 0.95 * 1.01 * 0.125e-3);
    near(right.shaft.length, 0.101);
    near(right.shaft.curvature, -2.0 * 2e-3 / (0.101 * 0.101));
    near(right.hinge.stiffness, 1.03);
    assert_eq!(right.shaft.links, 20);
    near(right.base_body.x, 0.054);
    near(right.base_body.y, -0.032);
    near(right.direction_body, -106_f64.to_radians());
    let sensor = array.sensors[0];
    for (found, expected) in [
        (sensor.gain, 0.02),
        (sensor.cubic, 0.03e6),
        (sensor.offset, 4e-6),
        (sensor.drift, 5e-6 / 60.0),
        (sensor.noise, 6e-6),
        (sensor.resolution, 7e-6),
        (sensor.latency, 8e-3),
        (array.lost, 0.09),
        (array.pose.noise.0, 1e-3),
        (array.pose.noise.1, 2_f64.to_radians()),
        (array.pose.wander.0, 3e-3),
        (array.pose.wander.1, 4_f64.to_radians()),
        (array.pose.wander_time, 5.0),
        (array.pose.latency, 6e-3),
        (array.command_latency, 33e-3),
        (array.rig.platform.servo, 70e-3),
        (array.friction.unwrap(), 0.2),
    ] {
        near(found, expected);
    }
    assert_eq!((array.loss, array.sensors[1].offset), (Loss::Stale, 0.0));
}

#[test]
fn a_section_can_start_from_a_file() {
    let scene = disk("{from: mismatch/plausible.yaml, length: 2 mm, seed: 5}");
    let mut expected = file("plausible");
    expected.common.set(Property::Length, 2e-3);
    (expected.seed, expected.file) = (Some(5), Some("mismatch/plausible.yaml".to_owned()));
    assert_eq!(scene.mismatch, Some(expected));
}

#[test]
fn the_scenario_of_the_page_is_one() {
    let page = include_str!("../../../docs/mismatch.md");
    let block = page.split("```yaml\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    let scene = read_with(&Source::new("docs/mismatch.md", block), &mut |_| Err("no files".to_owned())).unwrap();
    let mismatch = scene.mismatch.unwrap();
    assert!(mismatch.is_drawn() && mismatch.seed == Some(3));
}

/// A table of the page has every key, so that none can be added without a word about it.
#[test]
fn the_page_names_every_key() {
    let page = include_str!("../../../docs/mismatch.md");
    let Err(faults) = read_mismatch(&Source::new("mismatch.yaml", "nothing: 1\n")) else {
        panic!("a key was accepted")
    };
    let keys = faults[0].hints.join(" ");
    let named = keys.split('`').skip(1).step_by(2);
    for key in named {
        assert!(page.contains(&format!("| `{key}")) || page.contains(&format!("`{key}`")), "{key}");
    }
}
