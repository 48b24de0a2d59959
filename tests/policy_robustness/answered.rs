//! What must hold of any text that is given as a policy.
#![allow(dead_code, reason = "tests and fuzz targets use a part of it each")]

use vibrissa::diagnostic::{Colour, Diagnostic, Severity, Source, terminal};
use vibrissa::policy::{Checked, Compiled, chart, check, compile, compile_with_warnings, format, gather};
use vibrissa::report::{chart_dot, chart_mermaid, chart_svg};
use vibrissa_runtime::machine::Artifact;

use crate::erratic;

/// The line between the policy and the files that it may use: `0.fsm`, `1.fsm` and so on.
const NEXT_FILE: &str = "\n----\n";
/// The states and the transitions of charts that are always drawn.
const DRAWN: (usize, usize) = (100, 400);

/// The policy that a text begins with, and what it uses of the files behind it in the text.
pub(crate) fn source(text: &str) -> Source {
    let mut files = text.split(NEXT_FILE);
    let main = Source::new("policy.fsm", files.next().unwrap_or_default());
    let files: Vec<&str> = files.collect();
    // The standard library is at hand without.
    if files.is_empty() { main } else { gathered(&main, &files) }
}

/// The policy and all that it uses, as far as it is there.
fn gathered(main: &Source, files: &[&str]) -> Source {
    gather(main, &mut |path: &str| {
        let index = path.strip_suffix(".fsm").and_then(|index| index.parse::<usize>().ok());
        let text = index.and_then(|index| files.get(index));
        text.map(|text| (*text).to_owned()).ok_or_else(|| "there is none".to_owned())
    })
}

/// The source with another text in the place of its first part.
fn with_main(source: &Source, text: String) -> Source {
    let mut other = Source::new("policy.fsm", text);
    for part in 1..source.count() {
        let reason = source.absence(part).map(str::to_owned);
        other.add(source.part_name(part), reason.map_or_else(|| Ok(source.slice(source.part_span(part))), Err));
    }
    other
}

/// A text is a policy, perhaps with warnings, or has a fault, and each of them has a place in the text and words. That a file is not
/// there is a fault like others. Returns whether it compiles.
pub(crate) fn is_answered(text: &str) -> bool {
    answer(&source(text)).is_ok()
}

fn answer(source: &Source) -> Result<Compiled, Vec<Diagnostic>> {
    let compiled = compile_with_warnings(source);
    match &compiled {
        Ok(compiled) => are_told(source, &compiled.warnings, Severity::Warning),
        Err(faults) => are_told(source, faults, Severity::Error),
    }
    compiled
}

/// Whoever asks about a text is told the same: a check, and who does not have the files that it uses. What is left when lines at fault
/// are left out is answered too, again and again.
pub(crate) fn is_answered_the_same(text: &str) {
    let source = gather(&source(text), &mut |_: &str| Err("there is none".to_owned()));
    let compiled = answer(&source);
    let is_library = |told: &[Diagnostic]| told.iter().any(|fault| fault.code == "P0603");
    match check(&source) {
        Ok(Checked::Machine(checked)) => assert_eq!(Ok(&*checked), compiled.as_ref()),
        Ok(Checked::Library { warnings, .. }) => {
            are_told(&source, &warnings, Severity::Warning);
            assert!(compiled.as_ref().is_err_and(|told| is_library(told)));
        }
        Err(faults) => {
            are_told(&source, &faults, Severity::Error);
            assert!(compiled.as_ref().is_err_and(|told| *told == faults || is_library(told)), "{faults:?}");
        }
    }
    assert_eq!(gather(&source, &mut |path| panic!("{path} has been asked for")), source);
    let mut main = Source::new("policy.fsm", source.slice(source.part_span(0)));
    if source.count() > 1 {
        let alone = answer(&main);
        let has_all = (1..source.count()).all(|part| source.part_name(part).starts_with("std."));
        assert!(!has_all || alone.is_ok() == compiled.is_ok());
    }
    for _ in 0..3 {
        let Err(faults) = format(&main) else { break };
        are_told(&main, &faults, Severity::Error);
        main = Source::new("policy.fsm", without(&main.text, &faults));
    }
    let _ = answer(&main);
}

/// The text with blanks instead of the lines where faults are.
fn without(text: &str, faults: &[Diagnostic]) -> String {
    let mut start = 0;
    let lines = text.split_inclusive('\n').map(|line| {
        let (from, end) = (start, start + line.len());
        start = end;
        let is_at_fault = faults.iter().any(|fault| (from..end).contains(&fault.primary.span.start));
        if is_at_fault { " ".repeat(line.len() - 1) + "\n" } else { line.to_owned() }
    });
    lines.collect()
}

/// Faults, or warnings, have a place in the text and words.
fn are_told(source: &Source, faults: &[Diagnostic], severity: Severity) {
    assert!(severity == Severity::Warning || !faults.is_empty());
    assert!(faults.len() <= 50);
    for fault in faults {
        assert_eq!(fault.severity, severity);
        assert!(!fault.message.is_empty());
        assert!(!fault.primary.text.is_empty() || !fault.hints.is_empty(), "no words: {fault:?}");
        for label in std::iter::once(&fault.primary).chain(&fault.secondary) {
            assert!(source.text.get(label.span.start..label.span.end).is_some(), "not in the text: {fault:?}");
        }
        assert!(fault.code != "P0199", "the grammar and its reader disagree: {fault:?}");
    }
    assert!(faults.is_empty() || !terminal(source, faults, Colour::Plain).is_empty());
}

/// A text is answered; laying it out changes nothing but blanks, nor does laying it out again. One that compiles has a chart, can be written
/// and read again as it is, and runs within the limits of a rig whatever it feels; so it does as its tests set it, and they say whether
/// they hold whatever it did. Returns whether it compiles.
pub(crate) fn is_handled(text: &str) -> bool {
    let source = source(text);
    let compiled = answer(&source);
    // A text with faults of syntax has no layout: to say so takes as long as to compile it, and `is_answered_the_same` asks for it.
    let is_read = compiled.as_ref().map_or_else(|faults| faults.iter().all(|fault| fault.code >= "P02"), |_| true);
    let main = Source::new("policy.fsm", source.slice(source.part_span(0)));
    if is_read && let Ok(laid_out) = format(&main) {
        let main = Source::new("policy.fsm", laid_out);
        assert_eq!(format(&main).as_ref(), Ok(&main.text), "laid out twice");
        let program = compile(&with_main(&source, main.text.clone())).ok();
        assert_eq!(
            program.as_ref(),
            compiled.as_ref().ok().map(|compiled| &compiled.artifact.program),
            "laid out: {}",
            main.text
        );
    }
    let Ok(Compiled { artifact, tests, .. }) = compiled else { return false };
    let chart = chart(&source).unwrap();
    assert!(!chart_mermaid(&chart).is_empty() && !chart_dot(&chart).is_empty());
    match chart_svg(&chart) {
        Ok(drawn) => assert!(!drawn.is_empty()),
        Err(large) => {
            assert!(
                large.states > DRAWN.0 || large.transitions > DRAWN.1,
                "a chart that people read is drawn: {large}"
            );
        }
    }
    let bytes = artifact.to_bytes().unwrap();
    assert_eq!(Artifact::from_bytes(&bytes).as_ref(), Ok(&artifact));
    for test in &tests {
        let mut program = artifact.program.clone();
        test.set(&mut program);
        for (expectation, figure) in test.expectations.iter().flat_map(|one| [0.0, 1.0, f64::NAN].map(|it| (one, it))) {
            if let Some(fault) = expectation.violation(&program, |_| figure) {
                are_told(&source, &[fault], Severity::Error);
            }
        }
        erratic::run(program);
    }
    erratic::run(artifact.program);
    true
}
