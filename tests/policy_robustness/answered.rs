//! What must hold of any text that is given as a policy.
#![allow(dead_code, reason = "tests and fuzz targets use a part of it each")]

use vibrissa::diagnostic::{Colour, Severity, Source, terminal};
use vibrissa::machine::Artifact;
use vibrissa::policy::{chart, compile, compile_with_warnings, format};
use vibrissa::report::{chart_dot, chart_mermaid, chart_svg};

use crate::erratic;

/// A text is a policy, perhaps with warnings, or has a fault, and each of them has a place in the text and words.
pub(crate) fn is_answered(text: &str) {
    let source = Source::new("policy.fsm", text);
    let (faults, severity) = match compile_with_warnings(&source) {
        Ok(compiled) => (compiled.warnings, Severity::Warning),
        Err(faults) => {
            assert!(!faults.is_empty());
            (faults, Severity::Error)
        }
    };
    if !faults.is_empty() {
        assert!(faults.len() <= 50);
        for fault in &faults {
            assert_eq!(fault.severity, severity);
            assert!(!fault.message.is_empty());
            assert!(!fault.primary.text.is_empty() || !fault.hints.is_empty(), "no words: {fault:?}");
            for label in std::iter::once(&fault.primary).chain(&fault.secondary) {
                assert!(text.get(label.span.start..label.span.end).is_some(), "not in the text: {fault:?}");
            }
            assert!(fault.code != "P0199", "the grammar and its reader disagree: {fault:?}");
        }
        assert!(!terminal(&source, &faults, Colour::Plain).is_empty());
    }
}

/// A text is answered; laying it out changes nothing but blanks, nor does laying it out again. One that compiles has a chart, can be written
/// and read again as it is, and runs within the limits of a rig whatever it feels. Returns whether it compiles.
pub(crate) fn is_handled(text: &str) -> bool {
    is_answered(text);
    let source = Source::new("policy.fsm", text);
    let compiled = compile_with_warnings(&source).map(|compiled| compiled.artifact);
    if let Ok(laid_out) = format(&source) {
        let again = Source::new("policy.fsm", laid_out);
        assert_eq!(format(&again).as_ref(), Ok(&again.text), "laid out twice");
        let program = compile(&again).ok();
        assert_eq!(
            program.as_ref(),
            compiled.as_ref().ok().map(|artifact| &artifact.program),
            "laid out: {}",
            again.text
        );
    }
    let Ok(artifact) = compiled else { return false };
    let chart = chart(&source).unwrap();
    assert!(!chart_mermaid(&chart).is_empty() && !chart_dot(&chart).is_empty());
    assert!(chart_svg(&chart).is_ok_and(|drawn| !drawn.is_empty()));
    let bytes = artifact.to_bytes().unwrap();
    assert_eq!(Artifact::from_bytes(&bytes).as_ref(), Ok(&artifact));
    erratic::run(artifact.program);
    true
}
