//! What a malformed scenario is answered with, as a user sees it: one fixture a kind, one snapshot a fixture.

use crate::snapshots::snapshots;
use proptest::prelude::*;
use vibrissa::diagnostic::{Colour, Diagnostic, FAULT_LIMIT, Severity, Source, terminal};
use vibrissa::scenario;
use vibrissa::solid::{PartsError, PartsFault, convex_parts};

const DISK: &str = include_str!("../../../scenarios/disk.yaml");

fn faults(text: &str) -> Vec<Diagnostic> {
    scenario::read(&Source::new("scenario.yaml", text)).err().unwrap_or_default()
}

#[test]
fn every_malformed_scenario_is_answered_as_reviewed() {
    snapshots("scenarios").bind(|| {
        insta::glob!("../../fixtures/scenarios/bad", "*.yaml", |path| {
            let name = path.file_name().unwrap().to_string_lossy();
            let source = Source::new(name, std::fs::read_to_string(path).unwrap());
            let faults = scenario::read(&source).unwrap_err();
            insta::assert_snapshot!("bad", terminal(&source, &faults, Colour::Plain));
        });
    });
}

/// A text either is a scenario, or has at least one error, and each error has a place in the text and advice.
fn is_answered(text: &str) -> Result<(), TestCaseError> {
    let source = Source::new("scenario.yaml", text);
    if let Err(faults) = scenario::read(&source) {
        prop_assert!(!faults.is_empty() && faults.len() <= FAULT_LIMIT);
        for fault in &faults {
            prop_assert_eq!(fault.severity, Severity::Error);
            prop_assert!(!fault.hints.is_empty(), "no advice: {:?}", fault);
            let span = fault.primary.span;
            prop_assert!(text.get(span.start..span.end).is_some(), "not in the text: {:?}", fault);
        }
        prop_assert!(!terminal(&source, &faults, Colour::Plain).is_empty());
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn any_text_is_answered(text in "(\\PC|\n|\t| |: |- ){0,80}") {
        is_answered(&text)?;
    }

    #[test]
    fn any_yaml_like_text_is_answered(text in "([a-z]{1,3}|[0-9]{1,3}|: |, |\\[|\\]|\\{|\\}|\n|\n  |- |'|\"|&a |\\*a|<<: |!!int |\\| |---\n| mm){0,30}") {
        is_answered(&text)?;
    }

    #[test]
    fn any_mutation_of_a_good_scenario_is_answered(
        start in 0..DISK.len(), length in 0_usize..12, insert in "[-a-z0-9:{}\\[\\]'\"&*%. \n\u{b5}]{0,6}",
    ) {
        let end = (start + length).min(DISK.len());
        let text = format!("{}{insert}{}", &DISK[..start], &DISK[end..]);
        is_answered(&text)?;
    }

    #[test]
    fn any_value_of_any_key_is_answered(
        index in 0_usize..10, value in "-?[0-9]{1,3}(\\.[0-9]{1,2})?(e-?[0-9]{1,3})?( ?(mm|m|deg|s|%|kg/m\\^3))?|null|\\[\\]|\\{\\}|\\.inf|true",
    ) {
        let values = ["0.4 m", "0.3 m", "[0 m, 72 mm]", "90 deg", "120 s", "5 mm", "5 s", "0.8 mm", "95 %", "disk"];
        is_answered(&DISK.replace(values[index], &value))?;
    }
}

#[cfg(not(feature = "outlines"))]
#[test]
fn a_build_that_reads_no_outlines_says_how_to_get_one_that_does() {
    let drawn = "objects: [{outline: {file: gripper.svg}}]\nstart: {position: [0 m, 0 m], heading: 0 deg}";
    let source = Source::new("gripper.yaml", format!("name: gripper\n{drawn}\nstop: {{time: 1 s}}\n"));
    let faults = scenario::read_with(&source, &mut |_| Ok(b"<svg/>".to_vec())).unwrap_err();
    snapshots("scenarios").bind(|| insta::assert_snapshot!("no_outlines", terminal(&source, &faults, Colour::Plain)));
}

#[test]
fn independent_faults_are_told_together_and_in_the_order_of_the_text() {
    let text = DISK.replace("0.3 m", "0.3").replace("90 deg", "90 mm").replace("coverage", "covrage");
    let faults = faults(&text);
    assert_eq!(faults.iter().map(|fault| fault.code).collect::<Vec<_>>(), ["S0201", "S0204", "S0101"]);
}

#[test]
fn a_large_text_is_refused_whatever_is_in_it() {
    let faults = faults(&"# a comment\n".repeat(100_000));
    assert_eq!(faults.first().map(|fault| fault.code), Some("S0005"));
}

/// The disk's scenario with a polygon of these vertices in its place, each on a line of its own.
fn with_polygon(vertices: impl Iterator<Item = String>) -> Source {
    let lines = vertices.fold(String::new(), |lines, vertex| lines + "        - " + &vertex + "\n");
    let disk = "  - circle: {centre: [0.4 m, 0.4 m], radius: 0.3 m}\n";
    assert!(DISK.contains(disk));
    Source::new("scenario.yaml", DISK.replace(disk, &format!("  - polygon:\n      vertices:\n{lines}")))
}

/// The disk's scenario with a regular polygon of more corners than MuJoCo takes.
fn with_many_corners() -> Source {
    let sides = 2100;
    with_polygon((0..sides).map(|corner| {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(corner) / f64::from(sides)).sin_cos();
        format!("[{} m, {} m]", 0.4 + 0.3 * cos, 0.4 + 0.3 * sin)
    }))
}

#[test]
fn a_polygon_of_too_many_corners_is_answered_as_reviewed_if_the_simulator_is_mujoco() {
    let source = with_many_corners();
    let source = Source::new(&*source.name, format!("{}world: mujoco\n", source.text));
    let faults = scenario::read(&source).unwrap_err();
    snapshots("scenarios")
        .bind(|| insta::assert_snapshot!("too_many_corners", terminal(&source, &faults, Colour::Plain)));
}

#[test]
fn a_polygon_of_too_many_corners_is_a_scenario_whose_convex_parts_are_refused_with_its_line() {
    let scene = scenario::read(&with_many_corners()).unwrap();
    let PartsError { solid, place, fault } = convex_parts(&scene.solids).unwrap_err();
    assert_eq!((solid, fault), (0, PartsFault::Corners { count: 2100, limit: 2048 }));
    let line = DISK.lines().position(|line| line.contains("circle:")).unwrap() + 1;
    assert_eq!(place.map(|place| place.line), Some(line));
}

#[test]
fn of_a_great_many_faults_some_are_told() {
    let source = with_polygon((0..16_000).map(|_| "[1, 2]".to_owned()));
    let faults = scenario::read(&source).unwrap_err();
    assert_eq!(faults.len(), FAULT_LIMIT);
    assert!(faults.iter().all(|fault| fault.code == "S0201"));
    assert!(terminal(&source, &faults, Colour::Plain).len() < 50_000);
}
