//! What is said of a test that a policy carries, as a user sees it: one fixture a kind, one snapshot a fixture.

use crate::snapshots::snapshots;
use vibrissa_declare::figures::Metric;
use vibrissa_language::{RunFigure, compile_with_warnings};
use vibrissa_text::diagnostic::{Colour, Diagnostic, Source, terminal};

#[test]
fn an_expectation_that_does_not_hold_is_shown_with_what_was_measured() {
    let name = "expectation_that_does_not_hold.fsm";
    let text = include_str!("../fixtures/policies/test/expectation_that_does_not_hold.fsm");
    let source = Source::new(name, text);
    let compiled = compile_with_warnings(&source).unwrap();
    let (mut program, test) = (compiled.artifact.program, &compiled.tests[0]);
    test.set(&mut program);
    // A run that ended as the policy has it, and has no tips.
    let figure = |figure| match figure {
        RunFigure::Failed | RunFigure::Visits(_) => 1.0,
        RunFigure::TimeIn(_) | RunFigure::Metric(Metric::SimulatedTime) => 5.1,
        RunFigure::Passed
        | RunFigure::Completed
        | RunFigure::TimedOut
        | RunFigure::Diverged
        | RunFigure::Metric(Metric::Coverage | Metric::Retrievals | Metric::Collisions) => 0.0,
        RunFigure::Metric(_) | RunFigure::Plot(..) => f64::NAN,
    };
    let faults = test.expectations.iter().filter_map(|expectation| expectation.violation(&program, figure));
    let faults: Vec<Diagnostic> = faults.collect();
    snapshots("policies")
        .bind(|| insta::assert_snapshot!(format!("test@{name}"), terminal(&source, &faults, Colour::Plain)));
}

#[test]
fn a_violated_contract_is_shown_at_the_title_of_the_test() {
    let name = "expectation_that_does_not_hold.fsm";
    let text = include_str!("../fixtures/policies/test/expectation_that_does_not_hold.fsm");
    let source = Source::new(name, text);
    let test = &compile_with_warnings(&source).unwrap().tests[0];
    let fault = test.contract_violation("state Still: violated `never time > 3 s` in 4 ticks, first at 3.03 s");
    snapshots("policies").bind(|| {
        insta::assert_snapshot!("test@violated_contract", terminal(&source, &[fault], Colour::Plain));
    });
}
