//! What a policy that compiles is warned of, as a user sees it: one fixture a kind, one snapshot a fixture.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::collections::BTreeMap;
use std::sync::Arc;

use proptest::prelude::*;
use vibrissa::diagnostic::{Colour, Diagnostic, Severity, Source, terminal};
use vibrissa::geometry::Vector2;
use vibrissa::machine::{BodyScalar, Machine, Senses, WhiskerScalar, WhiskerVector};
use vibrissa::policy::{compile, compile_with_warnings};
use vibrissa::units::parse_quantity;

fn warnings(text: &str) -> Vec<Diagnostic> {
    let source = Source::new("policy.fsm", text);
    let compiled = compile_with_warnings(&source);
    compiled.unwrap_or_else(|faults| panic!("{}", terminal(&source, &faults, Colour::Plain))).warnings
}

fn codes(text: &str) -> Vec<&'static str> {
    warnings(text).iter().map(|warning| warning.code).collect()
}

/// The codes of the warnings about the transitions of a state, `A`, among others that have no others.
fn codes_of(transitions: &str) -> Vec<&'static str> {
    codes(&format!(
        "machine m whisker r, l initial A param p = 1 in 1 .. 2
        state A {{ stop {transitions} }} state B {{ record r record l }} state C {{ stop }}
        state Reached {{ stop when r.touching and p > 9 or 1 > p -> B }}
        always when time > 300 s -> Failure(\"too long\")"
    ))
    .into_iter()
    .filter(|code| !["P0501", "P0504"].contains(code))
    .collect()
}

#[test]
fn every_warning_is_given_as_reviewed() {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../snapshots/policies");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| {
        insta::glob!("fixtures/policies/warn/*.fsm", |path| {
            let name = path.file_name().unwrap().to_string_lossy();
            let source = Source::new(name, std::fs::read_to_string(path).unwrap());
            let warnings = compile_with_warnings(&source).unwrap().warnings;
            assert!(warnings.iter().all(|warning| warning.severity == Severity::Warning));
            insta::assert_snapshot!("warn", terminal(&source, &warnings, Colour::Plain));
        });
    });
}

#[test]
fn good_policies_have_no_warnings() {
    for path in ["policies/thesis.fsm"] {
        let source = Source::new(path, std::fs::read_to_string(path).unwrap());
        let warnings = compile_with_warnings(&source).unwrap().warnings;
        assert!(warnings.is_empty(), "{}", terminal(&source, &warnings, Colour::Plain));
    }
}
