//! The table of the keys of a rig, and what is derived from it: both readers, the mismatch and the documentation.

use std::collections::BTreeSet;
use std::path::Path;

use vibrissa::diagnostic::{Diagnostic, Source};
use vibrissa::mismatch::Difference;
use vibrissa::physics::Physics;
use vibrissa::rig::{Access, KEYS, Place, RigKey, differences_table, key, keys_table};
use vibrissa::scenario::{read_rig, read_with};
use vibrissa_robot::config::{Config, ConfigError};
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::units::parse_quantity;

/// The keys of a path with a value, on one line.
fn nested(path: &str, value: &str) -> String {
    let steps = path.split('.').map(|step| if step == "*" { "r0" } else { step });
    let mut text = value.to_owned();
    for step in steps.rev() {
        text = format!("{{{step}: {text}}}");
    }
    text
}

/// The message of a robot for these diagnostics.
fn told(faults: &[Diagnostic]) -> String {
    let fault = faults.first().unwrap();
    let parts = [&fault.message, &fault.primary.text].into_iter().chain(&fault.hints);
    parts.cloned().collect::<Vec<_>>().join("; ")
}

/// The rig of a scenario. It has no inertia of its links, which only a simulation needs.
fn in_scenario(rig: &str) -> Result<Rig, String> {
    read_rig(&Source::new("rig.yaml", format!("rig: {rig}\n")), &mut |_| Err("none".to_owned()))
        .map_err(|faults| told(&faults))
}

/// The rig of a robot with a board for each of these whiskers.
fn on_robot(rig: &str, whiskers: &[&str]) -> Result<Rig, String> {
    let board = |(index, name): (usize, &&str)| format!("{{whisker: {name}, address: {}}}", 0x0C + index);
    let boards: Vec<_> = whiskers.iter().enumerate().map(board).collect();
    let text = format!(
        "name: robot\nrig: {rig}\nbuses: [{{device: /dev/i2c-1, boards: [{}]}}]\n\
         limits: {{speed: 100 m/s, yaw_rate: 100 rad/s, base_angle: 1050 urad}}\npose: {{udp: {{listen: \"0.0.0.0:9751\"}}}}\n",
        boards.join(", ")
    );
    match Config::from_text(&text) {
        Ok(config) => Ok(config.rig),
        Err(ConfigError::At { message, .. }) => Err(message),
        Err(other) => panic!("{other}"),
    }
}

fn is_number(key: &RigKey) -> bool {
    fn of<T>(access: Access<T>) -> bool {
        matches!(access, Access::Number(_) | Access::Optional(_))
    }
    match key.place {
        Place::Platform(access) => of(access),
        Place::Whisker(access) => of(access),
        Place::Sensing(access) => of(access),
        Place::Physics(access) => of(access),
    }
}

#[test]
fn a_value_out_of_range_has_the_same_message_in_a_scenario_and_on_a_robot() {
    let mut count = 0;
    for key in KEYS.iter().filter(|key| is_number(key)) {
        let (least, greatest) = key.range;
        for value in [least - 1e-3 * (greatest - least), greatest + 1e-3 * (greatest - least)] {
            let rig = nested(key.path, &format!("{value} {}", key.dimension.si_unit()));
            let scenario = in_scenario(&rig).unwrap_err();
            assert_eq!(on_robot(&rig, &["r0"]).unwrap_err(), scenario, "{}", key.path);
            assert!(scenario.contains(&key.key().range_text()), "{}: {scenario}", key.path);
            count += 1;
        }
    }
    assert!(count > 60);
}

#[test]
fn a_value_of_another_kind_and_a_misspelt_key_have_the_same_message_in_both() {
    for key in KEYS {
        for rig in [nested(key.path, "[1 furlong]"), nested(&format!("{}x", key.path), "1")] {
            let scenario = in_scenario(&rig).unwrap_err();
            assert_eq!(on_robot(&rig, &["r0"]).unwrap_err(), scenario, "{}", key.path);
        }
    }
}

#[test]
fn the_former_notation_of_a_robot_is_refused_with_the_new_one() {
    let rig = "{whiskers: {r0: {shaft: {length: 75 mm}}}}";
    let scenario = in_scenario(rig).unwrap_err();
    assert!(scenario.contains("write its keys without it, such as `r0: {length: 75 mm"), "{scenario}");
    assert_eq!(on_robot(rig, &["r0"]).unwrap_err(), scenario);
}

#[test]
fn every_example_is_a_value_in_the_range_and_both_readers_take_it() {
    for key in KEYS.iter().filter(|key| !matches!(key.name(), "calibration" | "step" | "tip_radius")) {
        let example = key.example.trim_start_matches('[').split(',').next().unwrap().trim_end_matches(']');
        if key.range.0 < key.range.1 {
            let quantity = parse_quantity(example).unwrap();
            assert_eq!(quantity.dimension, key.dimension, "{}", key.path);
            assert!(key.key().contains(quantity.value_si), "{}", key.path);
        }
        let rig = nested(key.path, key.example);
        let whiskers: &[&str] = if key.path.starts_with("whiskers") { &["r0"] } else { &["r0", "l0"] };
        let (scenario, robot) = (in_scenario(&rig).unwrap(), on_robot(&rig, whiskers).unwrap());
        if key.is_on_robot {
            assert_eq!(scenario, robot, "{}", key.path);
        } else if key.path.starts_with("whiskers") {
            assert_eq!(robot, Rig { whiskers: vec![Rig::default().whiskers[0].clone()], ..Rig::default() });
        } else {
            assert_eq!(robot, Rig::default(), "{}", key.path);
        }
    }
}

/// The rig without the values that a robot does not use.
fn used(mut rig: Rig) -> Rig {
    let reference = Rig::default();
    for whisker in &mut rig.whiskers {
        (whisker.pitch, whisker.shaft.out_of_plane) = (0.0, 1.0);
    }
    (rig.sensing.forces, rig.sensing.force_noise) = (reference.sensing.forces, reference.sensing.force_noise);
    rig
}

/// The text of the section `rig` of a YAML file.
fn section(text: &str) -> Option<String> {
    let (_, rest) =
        format!("\n{text}").split_once("\nrig:").map(|(before, rest)| (before.to_owned(), rest.to_owned()))?;
    let end = rest.lines().skip(1).take_while(|line| line.is_empty() || line.starts_with([' ', '#']));
    let first = rest.lines().next().unwrap_or_default();
    Some(std::iter::once(first).chain(end).collect::<Vec<_>>().join("\n"))
}

#[test]
fn a_robot_accepts_the_rig_of_every_scenario_and_a_scenario_that_of_the_robot() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut count = 0;
    for folder in ["scenarios", "scenarios/more", "scenarios/zoo"] {
        for file in std::fs::read_dir(root.join(folder)).unwrap() {
            let path = file.unwrap().path();
            let Ok(text) = std::fs::read_to_string(&path) else { continue };
            let Some(rig) = section(&text) else { continue };
            let scene = read_with(&Source::new("a.yaml", text.as_str()), &mut |name| {
                std::fs::read(path.parent().unwrap().join(name)).map_err(|error| error.to_string())
            });
            let scene = scene.unwrap();
            let whiskers: Vec<&str> = scene.rig.whiskers.iter().map(|whisker| whisker.name.as_str()).collect();
            let robot = on_robot(&rig, &whiskers).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
            assert_eq!(robot, used(scene.rig), "{}", path.display());
            count += 1;
        }
    }
    assert!(count > 30, "{count}");

    let text = std::fs::read_to_string(root.join("deploy/pi/array.yaml")).unwrap();
    let scenario = in_scenario(&section(&text).unwrap()).unwrap();
    let mut robot = Config::from_text(&text).unwrap().rig;
    // The limits of the robot apply to its rig.
    (robot.platform.speed_limit, robot.platform.yaw_rate_limit) =
        (scenario.platform.speed_limit, scenario.platform.yaw_rate_limit);
    assert_eq!(scenario, robot);
}

#[test]
fn every_key_is_there_once_and_a_mismatch_changes_only_numbers_of_whiskers_the_platform_and_contacts() {
    let paths: BTreeSet<_> = KEYS.iter().map(|key| key.path).collect();
    assert_eq!(paths.len(), KEYS.len());
    let properties: BTreeSet<_> = Difference::all().map(|difference| difference.property).collect();
    let differences: BTreeSet<_> = Difference::all().map(|difference| difference.path).collect();
    assert_eq!((properties.len(), differences.len()), (Difference::all().count(), Difference::all().count()));
    for (path, change) in Difference::all().filter_map(|difference| difference.of) {
        let key = key(path).unwrap_or_else(|| panic!("{path}"));
        let (mut rig, mut physics) = (Rig::default(), Physics::default());
        key.apply(&mut rig.whiskers[0], change, 0.25);
        key.apply(&mut rig.platform, change, 0.25);
        key.apply(&mut rig.sensing, change, 0.25);
        key.apply(&mut physics, change, 0.25);
        // Perception has the rig, and only the simulation has the contacts.
        let is_of_contacts = path == "physics.contact_time";
        assert_eq!((rig != Rig::default(), physics != Physics::default()), (!is_of_contacts, is_of_contacts), "{path}");
        assert_eq!(rig.sensing, Rig::default().sensing, "{path}");
    }
}

/// Replaces the tables of a page by those of the program. A table is behind its marker and ends with an empty line.
fn with_tables(page: &str) -> String {
    let mut lines = page.lines();
    let mut text = String::new();
    while let Some(line) = lines.next() {
        text += line;
        text.push('\n');
        let Some(marker) = line.strip_prefix("<!-- table of ").and_then(|rest| rest.strip_suffix(" -->")) else {
            continue;
        };
        let table = match marker {
            "mismatch" => differences_table(),
            path => keys_table(&format!("{path}.")),
        };
        text.extend(["\n", &table, "\n"]);
        for line in lines.by_ref().skip_while(|line| line.is_empty()) {
            if line.is_empty() {
                break;
            }
        }
    }
    text
}

#[test]
fn the_tables_of_the_documentation_are_those_of_the_program() {
    for (page, count) in [("docs/rig.md", 4), ("docs/mismatch.md", 1)] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(page);
        let found = std::fs::read_to_string(&path).unwrap();
        let expected = with_tables(&found);
        assert_eq!(expected.matches("<!-- table of ").count(), count, "{page}");
        if std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
            std::fs::write(&path, &expected).unwrap();
        } else {
            assert!(found == expected, "{page} is stale; run `INSTA_UPDATE=always cargo test --test scene rig_keys`");
        }
    }
}
