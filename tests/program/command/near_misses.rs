//! `vibrissa inspect near-misses`

use std::fs;

use serde_json::Value;

use super::program::{directory, stderr, stdout, vibrissa};
use super::schema::check;

const SCENE: &str = "name: still\nworld: quasistatic\nobjects: [{circle: {centre: [3 m, 0 m], radius: 10 cm}}]\n\
    start: {position: [0 mm, 0 mm], heading: 0 deg}\nstop: {time: 4 s}\n";

/// `Coming` approaches the guard `body.position.x > 60 mm` up to 10 mm, and is then left by another one. `Leaving` approaches its own
/// guard until that holds. `Waiting` lacks 2 s of 3 s.
const POLICY: &str = "machine m
whisker r0
initial Coming
state Coming {
  steer body along direction(0 deg) at 50 mm/s turning 0 deg/s
  when body.position.x - 0.001 * body.position.x > 60 mm -> Failure(\"too far\")
  after 1 s -> Leaving
}
state Leaving {
  steer body along direction(180 deg) at 50 mm/s turning 0 deg/s
  when body.position.x < 20 mm -> Waiting
}
state Waiting {
  stop
  when body.position.x < 1 m for 10 s -> Failure(\"too long\")
}
";

#[test]
fn a_guard_that_was_almost_enabled_is_listed_and_one_that_was_enabled_is_not() {
    let folder = directory("near-misses");
    let [scene, policy, out] = ["still.yaml", "m.fsm", "out"].map(|name| folder.join(name));
    fs::write(&scene, SCENE).unwrap();
    fs::write(&policy, POLICY).unwrap();
    let [scene, policy, out] = [&scene, &policy, &out].map(|path| path.to_str().unwrap());
    let output = vibrissa(&["inspect", "near-misses", scene, "--policy", policy, "--out", out, "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let listed: Value = serde_json::from_str(&stdout(&output)).unwrap();
    let listed = listed.as_array().unwrap();
    for miss in listed {
        check("near-miss", miss);
    }
    let of = |state: &str| listed.iter().filter(|miss| miss["state"] == state).collect::<Vec<_>>();
    let [coming] = of("Coming").try_into().unwrap();
    let margin = coming["margin"]["value"].as_f64().unwrap();
    assert!((0.008..0.014).contains(&margin) && coming["margin"]["unit"] == "m", "{coming}");
    assert!((0.9..1.1).contains(&coming["time_s"].as_f64().unwrap()) && coming["scenario"] == "still", "{coming}");
    assert!(of("Leaving").is_empty(), "its transition was taken");
    let [waiting] = of("Waiting").try_into().unwrap();
    assert_eq!((&waiting["part"], &waiting["margin"]["unit"]), (&"for".into(), &"s".into()));
    assert!((7.0..9.0).contains(&waiting["margin"]["value"].as_f64().unwrap()), "{waiting}");
    let shares: Vec<f64> = listed.iter().map(|miss| miss["share"].as_f64().unwrap()).collect();
    assert!(shares.is_sorted());
    for name in ["near-misses.json", "m-still.svg"] {
        assert!(folder.join("out").join(name).is_file(), "{name}");
    }
}

#[test]
fn every_scenario_is_run_under_its_own_policy_unless_one_is_given() {
    let folder = directory("near-misses-policies");
    let file = |name: &str| folder.join(name).display().to_string();
    for (name, policy) in [("one", "first"), ("two", "second"), ("three", "first")] {
        let scene = SCENE.replace("still", name) + &format!("policy: {policy}.fsm\n");
        fs::write(file(&format!("{name}.yaml")), scene).unwrap();
        fs::write(file(&format!("{policy}.fsm")), POLICY.replace("machine m", &format!("machine {policy}"))).unwrap();
    }
    let scenes = ["one.yaml", "two.yaml", "three.yaml"].map(file);
    let listed = |arguments: &[&str]| {
        let output = vibrissa(&[&["inspect", "near-misses", "--json"], arguments].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let listed: Value = serde_json::from_str(&stdout(&output)).unwrap();
        let of =
            |miss: &Value| (miss["policy"].as_str().unwrap().to_owned(), miss["scenario"].as_str().unwrap().to_owned());
        listed.as_array().unwrap().iter().map(of).collect::<std::collections::BTreeSet<_>>()
    };
    let pair = |policy: &str, scene: &str| (policy.to_owned(), scene.to_owned());
    // Equal near misses of a policy are listed once, with the first of its scenarios.
    let own = listed(&scenes.each_ref().map(String::as_str));
    assert_eq!(own, [pair("first", "one"), pair("second", "two")].into());
    assert_eq!(listed(&[&scenes[2]]), [pair("first", "three")].into());
    let given = listed(&[&scenes[0], "--policy", &file("second.fsm")]);
    assert_eq!(given, [pair("second", "one")].into());

    // The table names the policy above it, or in its first column if there are several.
    let table = |scenes: &[String]| {
        let scenes: Vec<&str> = scenes.iter().map(String::as_str).collect();
        stdout(&vibrissa(&[&["inspect", "near-misses"], &*scenes].concat()))
    };
    assert!(table(&scenes[2..]).starts_with("Policy: first\n"), "{}", table(&scenes[2..]));
    let both = table(&scenes);
    assert!(both.contains(" policy ") && both.contains("\n first ") && both.contains("\n second "), "{both}");
}

#[test]
fn the_runs_of_a_sweep_are_taken_together() {
    let folder = directory("near-misses-sweep");
    fs::write(folder.join("still.yaml"), SCENE).unwrap();
    fs::write(
        folder.join("m.fsm"),
        POLICY
            .replace("initial Coming", "param speed = 50 mm/s in 1 .. 100 mm/s\ninitial Coming")
            .replace("direction(0 deg) at 50 mm/s", "direction(0 deg) at speed"),
    )
    .unwrap();
    let sweep = "name: speeds\nscenes: [{scenario: still.yaml}]\npolicies: [m.fsm]\nvary: {policy: {speed: [30 mm/s, 55 mm/s]}}\n";
    fs::write(folder.join("sweep.yaml"), sweep).unwrap();
    let output =
        vibrissa(&["inspect", "near-misses", "--sweep", folder.join("sweep.yaml").to_str().unwrap(), "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let listed: Value = serde_json::from_str(&stdout(&output)).unwrap();
    let coming = listed.as_array().unwrap().iter().find(|miss| miss["state"] == "Coming").unwrap();
    assert!(coming["margin"]["value"].as_f64().unwrap() < 0.008 && coming["run"] == 1, "{coming}");
}
