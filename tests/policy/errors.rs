//! What a malformed policy is answered with, as a user sees it: one fixture a kind, one snapshot a fixture.

use crate::snapshots::snapshots;
use vibrissa_language::compile;
use vibrissa_text::diagnostic::{Colour, Diagnostic, Source, terminal};

fn faults(text: &str) -> Vec<Diagnostic> {
    compile(&Source::new("policy.fsm", text)).err().unwrap_or_default()
}

fn codes(text: &str) -> Vec<&'static str> {
    faults(text).iter().map(|fault| fault.code).collect()
}

#[test]
fn every_malformed_policy_is_answered_as_reviewed() {
    snapshots("policies").bind(|| {
        insta::glob!("../fixtures/policies/bad", "*.fsm", |path| {
            let name = path.file_name().unwrap().to_string_lossy();
            let source = Source::new(name, std::fs::read_to_string(path).unwrap());
            let faults = compile(&source).unwrap_err();
            insta::assert_snapshot!("bad", terminal(&source, &faults, Colour::Plain));
        });
    });
}

#[test]
fn a_text_whose_lines_end_with_cr_alone_is_told_so() {
    let text = "# A policy\rmachine m\rwhisker r0\rinitial S\rstate S { do stop() }\r";
    let [fault] = faults(text).try_into().unwrap();
    assert_eq!((fault.message.as_str(), fault.primary.span.start), ("the lines end with CR alone", 10));
    assert!(fault.hints[0].contains("LF or CR LF"), "{fault:?}");
    assert!(faults(&text.replace('\r', "\r\n")).iter().all(|fault| !fault.message.contains("CR")));
}

#[test]
fn faults_come_in_the_order_of_the_text() {
    let text = "machine m param a = 1 furlong initial Nowhere state S { do nothing() when 1 -> S after 2 -> S }";
    assert_eq!(codes(text), ["P0302", "P0201", "P0201", "P0301", "P0301"]);
}

#[test]
fn a_fault_in_a_law_is_told_once_however_often_the_law_is_used() {
    let text = "machine m initial S law l() { record nothing } state S { do l() do l() } state T { do l() }";
    assert_eq!(codes(text), ["P0201"]);
}

#[test]
fn what_builds_on_a_faulty_value_is_not_reported() {
    let text = "machine m initial S
        let a = nothing  let b = a + 1 m  let c(x: length) = a + x
        state S { let d = b  let e = d * 2 s  steer body along direction(e) at c(d) facing b  when a > c(2 m) -> S }";
    assert_eq!(codes(text), ["P0201"]);
}

#[test]
fn the_number_of_faults_told_is_bounded() {
    let wrong: Vec<String> = (0..500).map(|index| format!("let v{index} = nothing{index}")).collect();
    assert_eq!(faults(&format!("machine m initial S {} state S {{ stop }}", wrong.join("\n"))).len(), 50);
}

#[test]
fn a_file_that_is_too_long_is_answered_as_reviewed() {
    let source = Source::new("policy.fsm", format!("machine m {}", "# a comment\n".repeat(30_000)));
    let faults = compile(&source).unwrap_err();
    assert_eq!(faults.iter().map(|fault| fault.code).collect::<Vec<_>>(), ["P0102"]);
    snapshots("policies").bind(|| insta::assert_snapshot!("too_long", terminal(&source, &faults, Colour::Plain)));
}

#[test]
fn derived_values_that_build_on_one_another_too_deep_are_refused() {
    let mut chain: Vec<String> = (1..2000).map(|index| format!("let v{index} = v{} + 1", index - 1)).collect();
    let text = |items: &[String]| format!("machine m initial S let v0 = 1 {} state S {{ stop }}", items.join("\n"));
    assert_eq!(codes(&text(&chain)), ["P0104"]);
    chain.reverse();
    let codes = codes(&text(&chain));
    assert!(!codes.is_empty() && codes.iter().all(|&code| code == "P0104"));
}
