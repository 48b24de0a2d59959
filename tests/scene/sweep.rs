//! Sweeps: their runs, and what a malformed one is answered with.

use std::collections::{BTreeMap, BTreeSet};

use crate::snapshots::snapshots;
use proptest::prelude::*;
use vibrissa::diagnostic::{Colour, Source, terminal};
use vibrissa::sweep::Shard;
use vibrissa::sweep::{ScenesOf, Sweep, SweepRun};

const CORNERS: &str = include_str!("../../sweeps/corners.yaml");
const FRICTION: &str = include_str!("../../sweeps/friction.yaml");

fn sweep(text: &str) -> Sweep {
    let source = Source::new("sweep.yaml", text);
    Sweep::from_yaml(&source).map_err(|faults| terminal(&source, &faults, Colour::Plain)).unwrap()
}

#[test]
fn every_malformed_sweep_is_answered_as_reviewed() {
    snapshots("sweeps").bind(|| {
        insta::glob!("../fixtures/sweeps/bad", "*.yaml", |path| {
            let name = path.file_name().unwrap().to_string_lossy();
            let source = Source::new(name, std::fs::read_to_string(path).unwrap());
            let faults = Sweep::from_yaml(&source).unwrap_err();
            insta::assert_snapshot!("bad", terminal(&source, &faults, Colour::Plain));
        });
    });
}

#[test]
fn a_value_that_a_policy_does_not_take_is_told_at_its_place() {
    let source = Source::new("sweep.yaml", FRICTION);
    let sweep = Sweep::from_yaml(&source).unwrap();
    let run = sweep.samples().next().unwrap();
    let (_, _, place) = run.parameters().next().unwrap();
    let faults =
        [run.unfit(Some(place), "the policy has no parameter `speed`"), run.unfit(None, "there is no whisker `r1`")];
    snapshots("sweeps").bind(|| insta::assert_snapshot!("unfit", terminal(&source, &faults, Colour::Plain)));
}

#[test]
fn the_sweep_of_corners_is_a_thousand_scenes_under_two_policies() {
    let sweep = sweep(CORNERS);
    let runs: Vec<_> = sweep.runs().collect();
    assert_eq!(runs.len(), 2000);
    assert!(
        runs.iter().all(|run| matches!(&run.scenes().of, ScenesOf::Family(family) if family.name == "convex-corner"))
    );
    let keys: BTreeSet<_> = runs.iter().map(SweepRun::key).collect();
    assert_eq!(keys.len(), 2000);
    assert!(keys.contains("family=convex-corner, trial=999, policy=thesis"));
    assert_eq!(sweep.samples().count(), 2);
}

#[test]
fn runs_are_all_combinations_and_samples_have_every_value_once() {
    let sweep = sweep(FRICTION);
    let keys: BTreeSet<_> = sweep.runs().map(|run| run.key()).collect();
    assert_eq!(keys.len(), 30 * 4);
    let mut values: BTreeMap<_, BTreeSet<_>> = BTreeMap::new();
    for (name, value) in sweep.samples().flat_map(|run| run.settings().collect::<Vec<_>>()) {
        values.entry(name).or_default().insert(value);
    }
    assert_eq!(values["speed"].len() + values["rig.physics.friction"].len(), 4);
    // Three kinds of scenes as the first values have them, with another speed, and with another friction.
    assert_eq!(sweep.samples().count(), 9);
    assert!(sweep.samples().all(|run| run.trial == 0));
    for (index, run) in sweep.runs().enumerate() {
        assert_eq!((run.index, sweep.run(run.index).unwrap().key()), (index as u64, run.key()));
    }
    assert!(sweep.run(120).is_none() && sweep.run(u64::MAX).is_none());
}

#[test]
fn runs_have_keys_of_their_own_whatever_files_are_called() {
    let sweep = sweep(
        "name: x\npolicies: [a.fsm]\nscenes: [{scenario: disk.yaml, seed: 1, trials: 2}, \
         {scenario: \"disk, seed=1.yaml\", trials: 2}, {scenario: \"disk, seed=1, trial=1.yaml\"}]\n",
    );
    let keys: BTreeSet<_> = sweep.runs().map(|run| run.key()).collect();
    assert_eq!(keys.len(), 5, "{keys:?}");
}

#[test]
fn a_list_of_many_values_is_gone_through_as_fast_as_many_trials() {
    let values: Vec<_> = (0..20_000).map(|value| value.to_string()).collect();
    let text = format!(
        "name: x\npolicies: [a.fsm]\nscenes: [{{scenario: b.yaml}}]\nvary: {{scenario: {{stop.time: [{}]}}}}\n",
        values.join(", ")
    );
    let keys: BTreeSet<_> = sweep(&text).runs().map(|run| run.key()).collect();
    assert_eq!(keys.len(), 20_000);
}

proptest! {
    #[test]
    fn what_is_added_to_a_sweep_changes_no_run_that_was_there(
        trials in 1_u64..20, more in 0_u64..20, speeds in 1_usize..4, faster in 0_usize..3, of in 1_u64..9,
    ) {
        let text = |trials: u64, speeds: usize, policies: &str| {
            let speeds: Vec<_> = (1..=speeds).map(|speed| format!("{speed} cm/s")).collect();
            format!("name: x\npolicies: [{policies}]\nscenes: [{{family: polygon, trials: {trials}}}, {{scenario: a.yaml}}]\n\
                     vary: {{policy: {{speed: [{}]}}}}\n", speeds.join(", "))
        };
        let (few, many) = (sweep(&text(trials, speeds, "b.fsm")), sweep(&text(trials + more, speeds + faster, "a.fsm, b.fsm")));
        let keys = |sweep: &Sweep| sweep.runs().map(|run| run.key()).collect::<BTreeSet<_>>();
        prop_assert!(keys(&few).is_subset(&keys(&many)));
        let shards: Vec<Shard> = (1..=of).map(|number| format!("{number}/{of}").parse().unwrap()).collect();
        for key in keys(&many) {
            prop_assert_eq!(shards.iter().filter(|shard| shard.has(&key)).count(), 1);
        }
    }

    #[test]
    fn any_mutation_of_a_good_sweep_is_answered(
        start in 0..FRICTION.len(), length in 0_usize..12, insert in "[-a-z0-9:{}\\[\\]'\"&*%. \n\u{b5}]{0,6}",
    ) {
        let end = (start + length).min(FRICTION.len());
        let source = Source::new("sweep.yaml", format!("{}{insert}{}", &FRICTION[..start], &FRICTION[end..]));
        if let Err(faults) = Sweep::from_yaml(&source) {
            prop_assert!(!faults.is_empty());
            for fault in &faults {
                prop_assert!(!fault.hints.is_empty(), "no advice: {:?}", fault);
                let span = fault.primary.span;
                prop_assert!(source.text.get(span.start..span.end).is_some(), "not in the text: {:?}", fault);
            }
        }
    }
}

const DISKS: &str = "name: disks
objects:
  - circle: {centre: [40 cm, 40 cm], radius: 30 cm}
  - polygon: {vertices: [[1 m, 1 m], [2 m, 1 m], [2 m, 2 m]]}
start: {position: [0 mm, 72 mm], heading: 90 deg}
stop: {time: 1 s}
";

/// The scenes of a sweep over one key, or the rendered faults.
fn varied(path: &str, values: &str) -> Vec<Result<vibrissa::scene::Scene, String>> {
    let text = format!(
        "name: x\npolicies: [a.fsm]\nscenes: [{{scenario: b.yaml}}]\nvary: {{scenario: {{\"{path}\": {values}}}}}\n"
    );
    let (scenario, definition) = (Source::new("b.yaml", DISKS), Source::new("sweep.yaml", text));
    let sweep = Sweep::from_yaml(&definition).unwrap();
    let scene = |run: SweepRun<'_>| {
        let read = run.scene(&scenario, &definition, &mut |_| Err("there are no files".to_owned()));
        read.map_err(|(source, faults)| terminal(&source, &faults, Colour::Plain))
    };
    sweep.runs().map(scene).collect()
}

#[test]
fn any_number_of_a_scenario_varies_by_its_path() {
    let area = |scene: &Result<vibrissa::scene::Scene, String>, object: usize| {
        scene.as_ref().unwrap_or_else(|told| panic!("{told}")).solids[object].outline().area()
    };
    let scenes = varied("objects[0].circle.radius", "[10 cm, 20 cm]");
    assert!((area(&scenes[1], 0) / area(&scenes[0], 0) - 4.0).abs() < 1e-9);
    assert!((area(&scenes[0], 1) - 0.5).abs() < 1e-9);
    let scenes = varied("objects[1].polygon.vertices[2][1]", "[2 m, 3 m]");
    assert!((area(&scenes[1], 1) / area(&scenes[0], 1) - 2.0).abs() < 1e-9);
    let whole = varied("objects[1]", "[{circle: {centre: [5 m, 5 m], radius: 1 m}}]");
    assert!((area(&whole[0], 1) - std::f64::consts::PI).abs() < 1e-9);
}

#[test]
fn a_path_that_leads_nowhere_is_answered_as_reviewed() {
    for (name, path) in [
        ("item", "objects[2].circle.radius"),
        ("no_number", "objects[first].circle.radius"),
        ("no_bracket", "objects[0.circle.radius"),
        ("key_of_a_list", "objects.circle.radius"),
        ("item_of_a_mapping", "stop[0]"),
        ("key_of_a_value", "stop.time.longest"),
    ] {
        let told = varied(path, "[20 cm]").remove(0).unwrap_err();
        snapshots("sweeps").bind(|| insta::assert_snapshot!(format!("path@{name}"), told));
    }
}

#[test]
fn a_parameter_of_a_family_varies_and_changes_the_key_of_a_run() {
    let sweep = sweep(
        "name: x\npolicies: [a.fsm]\nscenes: [{family: convex-corner}]\nvary: {family: {angle: [30 deg, 60 deg]}}\n",
    );
    let keys: Vec<_> = sweep.runs().map(|run| run.key()).collect();
    assert_eq!(
        keys,
        [
            "family=convex-corner, trial=0, angle=30 deg, policy=a",
            "family=convex-corner, trial=0, angle=60 deg, policy=a"
        ]
    );
}
