//! What can be written about states in states, in a mark and in a test.

use vibrissa_language::index::RenameError;

use super::candidate::{candidates, labels};
use super::policies::{MARKING, index};

/// A policy with states in states, with `first` in the first of the outermost and `outer` in the second.
fn nested(first: &str, outer: &str) -> String {
    format!(
        "machine m\nwhisker r0\nparam speed = 50 mm/s\ninitial A\nstate A {{\n  {first}\n}}\nstate Outer(w: whisker) {{\n  var n = 0\n  \
         let known = 1 mm\n  {outer}\n  state First {{ stop }}\nstate Second(x: length) {{\n initial Deep\n state Deep {{ stop }}\n }}\n}}\n"
    )
}

#[test]
fn a_target_in_another_state_is_written_with_the_way_there() {
    let written = |text: String| -> Vec<(String, String)> {
        candidates(&text).into_iter().map(|candidate| (candidate.label, candidate.snippet)).collect()
    };
    let owned = |pairs: &[(&str, &str)]| -> Vec<(String, String)> {
        pairs.iter().map(|&(label, snippet)| (label.to_owned(), snippet.to_owned())).collect()
    };
    let ends = [
        ("resume", "resume ${1:State}"),
        ("Success", "Success(\"${1:reason}\")"),
        ("Failure", "Failure(\"${1:reason}\")"),
    ];
    let from_outside = [
        ("A", "A"),
        ("Outer", "Outer(${1:w})"),
        ("First", "Outer(${1:w}).First"),
        ("Second", "Outer(${1:w}).Second(${2:x})"),
        ("Deep", "Outer(${1:w}).Second(${2:x}).Deep"),
    ];
    for place in ["when true -> \u{a7}", "failsafe -> \u{a7}", "after 5 s -> Fi\u{a7}"] {
        assert_eq!(written(nested(place, "")), owned(&[&from_outside[..], &ends].concat()), "{place}");
    }
    let from_inside = [("A", "A"), ("Outer", "Outer(${1:w})"), ("First", "First"), ("Second", "Second(${1:x})")];
    let from_inside = [&from_inside[..], &[("Deep", "Second(${1:x}).Deep")], &ends].concat();
    assert_eq!(written(nested("", "when true -> \u{a7}")), owned(&from_inside));
    assert_eq!(labels(&nested("when true -> Outer(r0).\u{a7}", "")), ["First", "Second"]);
    assert_eq!(labels(&nested("when true -> Outer(r0).Second(1 mm).\u{a7}", "")), ["Deep"]);
    assert_eq!(labels(&nested("when true -> resume \u{a7}", "")), ["Outer", "Second"]);
    assert_eq!(labels(&nested("failsafe \u{a7}", "")), ["->"]);
    assert_eq!(labels(&nested("", "initial \u{a7}")), ["First", "Second"]);
    assert_eq!(labels(&nested("}\ninitial \u{a7}\nstate B {", "")), ["A", "B"]);
}

#[test]
fn a_state_in_another_knows_its_arguments_and_memory_but_not_what_its_statements_name() {
    let has = |inside: &str, name: &str| {
        let text = nested("", &format!("state Third {{\n {inside} }}"));
        labels(&text).contains(&name.to_owned())
    };
    for name in ["w", "n"] {
        assert!(has("let y = \u{a7}", name), "{name}");
    }
    assert!(has("set \u{a7}", "n") && !has("let y = \u{a7}", "known"));
    assert!(labels(&nested("", "if \u{a7}")).contains(&"known".to_owned()));
}

#[test]
fn a_mark_is_no_name_and_takes_lost_or_found() {
    assert_eq!(labels(&nested("mark \u{a7}", "")), ["lost", "found"]);
    assert!(labels(&nested("mark lost \u{a7}", "")).contains(&"r0".to_owned()));
    let index = index(MARKING);
    let at = |part: &str| MARKING.find(part).unwrap();
    assert_eq!(index.definition(at("mark lost") + 5), None);
    assert!(index.hover(at("mark lost") + 5).unwrap().text.contains("at an edge"));
    assert_eq!(index.references(at("lost =")).len(), 3);
    assert!(matches!(index.rename(at("mark found") + 5, "x"), Err(RenameError::BuiltIn(_))));
}

#[test]
fn a_test_is_completed_by_parameters_and_by_what_is_known_of_a_run() {
    let test = |inside: &str| labels(&format!("{}test \"t\" in \"s.yaml\" {{\n  {inside}\n}}\n", nested("", "")));
    assert_eq!(test("\u{a7}"), ["set", "expect"]);
    assert_eq!(test("set speed = 10 mm/s\n  ex\u{a7}"), ["set", "expect"]);
    assert_eq!(test("set \u{a7}"), ["speed"]);
    assert_eq!(test("set speed = \u{a7}"), [""; 0]);
    assert!(test("expect run.\u{a7}").contains(&"error_mean".to_owned()));
    assert_eq!(test("expect run.visits(\u{a7}"), ["A", "Outer", "First", "Second", "Deep"]);
    let values = test("expect \u{a7}");
    let has = |name: &str| values.contains(&name.to_owned());
    assert!(has("run") && has("speed") && has("not") && has("abs"));
    assert!(!has("r0") && !has("body") && !has("time") && !has("A"));
    assert!(test("expect run.completed \u{a7}").contains(&"and".to_owned()));
    assert_eq!(labels("machine m\ntest \"t\" \u{a7}"), ["in"]);
    assert_eq!(labels(&nested("let x = run.\u{a7}", "")), [""; 0]);
}
