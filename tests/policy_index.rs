//! What editors are told of the places in a policy.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::path::Path;

use proptest::prelude::*;
use vibrissa::diagnostic::{Source, Span};
use vibrissa::machine::Program;
use vibrissa::policy::compile;
use vibrissa::policy::index::{Index, RenameError, Symbol, SymbolKind};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");
const THESIS: &str = include_str!("../policies/thesis.fsm");

fn index(text: &str) -> Index {
    Index::new(&Source::new("test.fsm", text), None)
}

/// Every policy of the project that compiles, with its name.
fn policies() -> Vec<(String, String)> {
    let folders =
        ["policies", "tests/fixtures/policies/warn", "tests/fixtures/policies/format", "tests/fixtures/charts"];
    let files = folders.iter().flat_map(|folder| std::fs::read_dir(Path::new(ROOT).join(folder)).unwrap());
    let texts = files.map(|file| file.unwrap().path()).filter(|path| path.extension().is_some_and(|is| is == "fsm"));
    let mut texts: Vec<(String, String)> =
        texts.map(|path| (path.display().to_string(), std::fs::read_to_string(path).unwrap())).collect();
    let page = include_str!("../docs/language.md");
    for (number, example) in page.split("```fsm\n").skip(1).enumerate() {
        let example = example.split("```").next().unwrap();
        let text = if example.starts_with("machine") {
            example.to_owned()
        } else {
            format!("machine example {example}\ninitial Still\nstate Still {{ stop }}\n")
        };
        texts.push((format!("example {number} of the page"), text));
    }
    texts.retain(|(name, text)| compile(&Source::new(name.as_str(), text.as_str())).is_ok());
    texts.sort();
    texts
}

/// A text with a name in other places.
fn replaced(text: &str, places: &[Span], name: &str) -> String {
    let mut text = text.to_owned();
    for place in places.iter().rev() {
        text.replace_range(place.start..place.end, name);
    }
    text
}

/// A program without the names that its policy gives to things.
fn nameless(mut program: Program) -> String {
    program.name.clear();
    program.whiskers.iter_mut().for_each(String::clear);
    program.parameters.iter_mut().for_each(|parameter| parameter.name.clear());
    program.states.iter_mut().for_each(|state| state.name = "".into());
    format!("{program:?}")
}

#[test]
fn whatever_is_renamed_the_machine_stays_the_same() {
    let mut renamed = 0;
    for (name, text) in policies() {
        let before = compile(&Source::new(name.as_str(), text.as_str())).unwrap();
        let index = index(&text);
        for symbol in index.symbols() {
            let places = index.rename(symbol.span.start, "fresh_name").unwrap();
            assert!(places.contains(&symbol.span));
            let after = replaced(&text, &places, "fresh_name");
            let program = compile(&Source::new("renamed.fsm", after.as_str()))
                .unwrap_or_else(|faults| panic!("{name}, {}: {faults:?}\n{after}", symbol.name));
            assert_eq!(nameless(program), nameless(before.clone()), "{name}, {}", symbol.name);
            renamed += 1;
        }
    }
    assert!(renamed > 150, "{renamed}");
}

#[test]
fn every_place_of_a_name_leads_to_where_it_is_given_and_is_explained() {
    for (name, text) in policies() {
        let index = index(&text);
        for symbol in index.symbols() {
            let places = index.references(symbol.span.start);
            for (place, _) in places {
                assert_eq!(index.definition(place.start), Some(symbol.span), "{name}, {}", symbol.name);
                assert_eq!(index.definition(place.end), Some(symbol.span), "{name}, {}", symbol.name);
                let hover = index.hover(place.start).unwrap();
                assert_eq!((hover.span, hover.text.contains(&symbol.name)), (place, true), "{name}");
            }
        }
    }
}

#[test]
fn every_word_of_a_policy_that_compiles_is_explained() {
    for (name, text) in policies() {
        let index = index(&text);
        let mut at = 0;
        // Comments and texts have no meaning.
        let code: String = text.lines().map(|line| line.split('#').next().unwrap().to_owned() + "\n").collect();
        assert!(code.len() <= text.len() + 1);
        for line in text.split_inclusive('\n') {
            let mut in_text = false;
            for (offset, letter) in line.char_indices() {
                in_text ^= letter == '"';
                if letter == '#' && !in_text {
                    break;
                }
                let begins = !line[..offset].ends_with(|before: char| before.is_ascii_alphanumeric() || before == '_');
                if letter.is_ascii_alphabetic() && begins && !in_text && !line[..offset].ends_with(['/', '^']) {
                    assert!(index.hover(at + offset).is_some(), "{name}: {}", &line[offset..]);
                }
            }
            at += line.len();
        }
    }
}

/// The labels of what can be written at the `§` of a text.
fn labels(text: &str) -> Vec<String> {
    let at = text.find('\u{a7}').unwrap();
    let candidates = index(&text.replace('\u{a7}', "")).candidates(at).1;
    candidates.into_iter().map(|candidate| candidate.label).collect()
}

/// A policy with `inside` in the second of its states, and no end.
fn writing(inside: &str) -> String {
    format!(
        "machine m\nwhisker r0, l0\nparam speed = 50 mm/s\nlet half(x: length) = x / 2\nlaw follow(w: whisker) {{ hold }}\n\
         initial Begin\nstate Begin {{ stop }}\nstate Go(w: whisker, far: length) {{\n  var worst = 0 rad\n  let dir = w.contour\n  \
         {inside}"
    )
}

#[test]
fn behind_a_point_come_the_members_of_what_stands_before_it() {
    let members =
        ["deflection", "touching", "yaw", "side", "sense", "length", "tip", "tip_base", "base", "tip_at", "contour"];
    for place in [
        "w.\u{a7}",
        "w.ti\u{a7}p",
        "when r0.\u{a7}\n  when l0.touching -> Begin\n}",
        "when |w.\u{a7}",
        "record w.\u{a7}\n}",
    ] {
        assert_eq!(labels(&writing(place)), members, "{place}");
    }
    for place in ["let x = w.contour.\u{a7}", "steer body along r0.contour.\u{a7} at speed"] {
        assert_eq!(labels(&writing(place)), ["ready", "tangent", "end", "curvature"], "{place}");
    }
    assert_eq!(labels(&writing("let x = body.\u{a7}")), ["yaw", "position"]);
    for place in ["let x = speed.\u{a7}", "let x = 1.\u{a7}", "let x = nobody.\u{a7}", "let x = w.tip.\u{a7}"] {
        assert_eq!(labels(&writing(place)), [""; 0], "{place}");
    }
}

#[test]
fn behind_an_arrow_come_the_states_and_failure() {
    for place in
        ["when true -> \u{a7}", "when true -> B\u{a7}\n}", "after 5 s ->\u{a7}", "}\nalways when true -> \u{a7}"]
    {
        assert_eq!(labels(&writing(place)), ["Begin", "Go", "Failure"], "{place}");
    }
    assert_eq!(labels(&writing("}\ninitial \u{a7}")), ["Begin"]);
    assert_eq!(labels(&writing("do \u{a7}")), ["follow"]);
    assert_eq!(labels(&writing("set \u{a7}")), ["worst"]);
}

#[test]
fn a_statement_a_transition_and_an_item_begin_with_their_words() {
    let has = |place: &str, word: &str| labels(&writing(place)).contains(&word.to_owned());
    for (place, yes, no) in [
        ("\u{a7}", "when", "param"),
        ("hold\n  \u{a7}", "steer", "law"),
        ("hold\n  st\u{a7}", "steer", "state"),
        ("if true {\n \u{a7}", "record", "when"),
        ("entry {\n \u{a7}", "set", "when"),
        ("}\n\n\u{a7}", "param", "when"),
        ("}\n\nlaw other() {\n  \u{a7}", "steer", "when"),
        ("}\n\npa\u{a7}", "param", "steer"),
        ("steer body \u{a7}", "along", "at"),
        ("steer body along w.tip \u{a7}", "at", "along"),
        ("steer body along w.tip at speed \u{a7}", "facing", "at"),
        ("when w.touching \u{a7}", "->", "along"),
        ("when w.touching for 1 s \u{a7}", "->", "for"),
        ("if true { hold } \u{a7}", "else", "facing"),
        ("}\nparam x = 3 mm \u{a7}", "in", "when"),
        ("}\nalways \u{a7}", "when", "param"),
    ] {
        assert!(has(place, yes), "{place}: {:?}", labels(&writing(place)));
        assert!(!has(place, no), "{place}: {:?}", labels(&writing(place)));
    }
    assert_eq!(labels("\u{a7}"), ["machine"]);
}

#[test]
fn a_value_is_one_that_is_known_at_the_place() {
    let has = |place: &str, word: &str| labels(&writing(place)).contains(&word.to_owned());
    for value in ["w", "far", "worst", "dir", "speed", "half", "r0", "l0", "time", "body", "not", "clamp", "pid"] {
        assert!(has("let x = \u{a7}", value), "{value}");
        assert!(has("let x = clamp(1, \u{a7}", value), "{value}");
    }
    // Transitions are tried before the statements, and other items do not know what a state does.
    assert!(!has("when \u{a7}", "dir") && has("when \u{a7}", "worst"));
    assert!(!has("}\nlet x = \u{a7}", "w") && !has("}\nlet x = \u{a7}", "worst") && has("}\nlet x = \u{a7}", "speed"));
    assert!(!has("let x = \u{a7}", "x") && !has("let x = \u{a7}", "Go"));
    assert!(!has("if true { let inner = 1 }\n let x = \u{a7}", "inner"));
    assert!(has("if true { let inner = 1\n let x = \u{a7}", "inner"));
}

#[test]
fn units_follow_numbers_and_types_follow_colons() {
    for place in ["let x = 50 \u{a7}", "let x = 50 m\u{a7}", "after 5 \u{a7}", "}\nparam x = 1 \u{a7}"] {
        let labels = labels(&writing(place));
        assert!(
            ["mm", "m", "urad", "ms", "mm/s", "deg/s", "N*m"].iter().all(|unit| labels.contains(&(*unit).to_owned()))
        );
    }
    let types = labels(&writing("}\nlaw other(a: \u{a7}"));
    assert!(types.contains(&"whisker".to_owned()) && types.contains(&"angular_speed".to_owned()));
    assert_eq!(labels(&writing("}\nlaw other(a: vector \u{a7}")), ["of"]);
    assert!(!labels(&writing("}\nlaw other(a: vector of \u{a7}")).contains(&"whisker".to_owned()));
}

#[test]
fn where_anything_may_be_written_nothing_is_offered() {
    for place in [
        "# w.\u{a7}",
        "when true -> Failure(\"w.\u{a7}\")",
        "let \u{a7}",
        "var x\u{a7}",
        "}\nlaw \u{a7}",
        "}\nlaw l(\u{a7}",
        "}\nparam x = \u{a7}",
        "let x = 50\u{a7}",
    ] {
        assert_eq!(labels(&writing(place)), [""; 0], "{place}");
    }
}

#[test]
fn a_text_with_a_fault_is_known_but_for_the_fault() {
    let good = index(THESIS);
    let broken = THESIS.replace("let tangent = w.contour.tangent", "let tangent = w.contour.");
    let before = Index::new(&Source::new("thesis.fsm", broken.as_str()), Some(&good));
    let names = |index: &Index| index.symbols().iter().map(|symbol| symbol.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&before), names(&good));
    let at = broken.find("do swipe").unwrap() + 3;
    assert_eq!(
        before.definition(at),
        Some(Span::new(broken.find("swipe(w").unwrap(), broken.find("swipe(w").unwrap() + 5))
    );
    // Types of before are remembered.
    let pull = broken.find("pull * unit").unwrap();
    assert!(before.hover(pull).unwrap().text.contains("a plain number"));
    assert!(!index(&broken).hover(pull).unwrap().text.contains("a plain number"));
    assert_eq!(before.rename(at, "other"), Err(RenameError::Unreadable));
}

#[test]
fn a_state_within_another_is_found_by_its_path_and_knows_what_the_other_knows() {
    let text = "machine m\nwhisker r0\ninitial A\nstate A {\n  when r0.touching -> Outer(r0).Inner\n}\n\nstate Outer(w: whisker) {\n  var n = 0\n  \
                state Inner {\n    when w.touching -> A\n    set n = n + 1\n  }\n}\n";
    let index = index(text);
    let inner = index.symbols().iter().find(|symbol| symbol.name == "Inner").unwrap();
    assert_eq!(inner.owner.map(|owner| index.symbols()[owner].name.as_str()), Some("Outer"));
    assert_eq!(index.definition(text.find("Inner").unwrap()), Some(inner.span));
    assert_eq!(index.references(text.find("w: ").unwrap()).len(), 2);
    assert_eq!(index.references(text.find("n = 0").unwrap()).len(), 3);
}

#[test]
fn what_cannot_be_renamed_says_why() {
    let index = index(THESIS);
    let rename = |part: &str, name: &str| index.rename(THESIS.find(part).unwrap(), name).unwrap_err();
    assert_eq!(rename("clamp", "x"), RenameError::BuiltIn("clamp".to_owned()));
    assert_eq!(rename("touching", "x"), RenameError::BuiltIn("touching".to_owned()));
    assert_eq!(rename("# The", "x"), RenameError::NoName);
    assert_eq!(rename("lost ", "limit"), RenameError::Taken { name: "limit".to_owned(), line: 12 });
    assert_eq!(rename("lost ", "tangent"), RenameError::Taken { name: "tangent".to_owned(), line: 19 });
    assert_eq!(rename("tangent = w", "lost"), RenameError::Taken { name: "lost".to_owned(), line: 13 });
    assert_eq!(rename("lost ", "state"), RenameError::Reserved("state".to_owned()));
    assert_eq!(rename("lost ", "Failure"), RenameError::Reserved("Failure".to_owned()));
    for name in ["", "1a", "a b", "\u{e4}", "a-b"] {
        assert_eq!(rename("lost ", name), RenameError::Malformed(name.to_owned()));
    }
}

#[test]
fn a_hover_says_type_unit_range_and_description() {
    let hover = |part: &str| index(THESIS).hover(THESIS.find(part).unwrap()).unwrap().text;
    assert_eq!(
        hover("target * sign"),
        "```fsm\nparam target = 300 urad in 50 .. 800 urad\n```\n\nan angle, in deg, rad, mrad, urad\n\nbase angle at which the tip \
         is known best"
    );
    assert_eq!(hover("tangent = w"), "```fsm\nlet tangent = w.contour.tangent\n```\n\na vector of plain numbers");
    assert_eq!(hover("swipe(w: "), "```fsm\nlaw swipe(w: whisker)\n```");
    assert_eq!(hover("w.contour"), "```fsm\nw: whisker\n```\n\na whisker");
    assert!(hover("clamp(").starts_with("```fsm\nclamp(x, low, high)\n```\n\nA number"));
    assert!(hover("contour.ready").starts_with("```fsm\nwhisker.contour\n```\n\na contour\n\n"));
    assert_eq!(hover("mm/s "), "```fsm\nmm/s\n```\n\na unit of a speed: 0.001 m/s");
    assert!(hover("hold").starts_with("```fsm\nhold\n```"));
}

#[test]
fn the_examples_of_the_editors_page_are_described_as_it_says() {
    let page = include_str!("../docs/editor.md");
    let example = page.split("```fsm\n").nth(1).unwrap().split("```").next().unwrap();
    let index = index(example);
    let described: Vec<String> = index.symbols().iter().map(|symbol| index.description(symbol)).collect();
    assert_eq!(
        described,
        ["How fast the body moves, in every state.", "time without touch after which the contour is lost"]
    );
}

fn kinds(index: &Index) -> Vec<(String, SymbolKind)> {
    index.symbols().iter().map(|Symbol { name, kind, .. }| (name.clone(), *kind)).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn any_text_has_an_index_and_answers_everywhere(
        (start, length) in (0..THESIS.len(), 0_usize..60),
        insert in "[-a-z0-9:{}()|\"#*/.,<>= \n\u{b5}]{0,8}",
        at in 0..THESIS.len(),
    ) {
        let mut text = THESIS.to_owned();
        text.replace_range(start..(start + length).min(THESIS.len()), &insert);
        let index = Index::new(&Source::new("test.fsm", text.as_str()), Some(&index(THESIS)));
        for at in [at, start, start + insert.len(), text.len(), text.len() + 9] {
            let _ = (index.hover(at), index.rename(at, "x"), index.references(at));
            let (typed, _) = index.candidates(at);
            prop_assert!(text.get(typed.start..typed.end).is_some());
        }
        for symbol in index.symbols() {
            for span in [symbol.span, symbol.whole] {
                prop_assert!(text.get(span.start..span.end).is_some(), "{symbol:?}");
            }
            prop_assert!(symbol.whole.start <= symbol.span.start && symbol.span.end <= symbol.whole.end);
            prop_assert!(symbol.owner.is_none_or(|owner| owner < index.symbols().len()));
        }
    }
}

#[test]
fn the_layout_of_a_policy_does_not_change_what_it_declares() {
    for (name, text) in policies() {
        let formatted = vibrissa::policy::format(&Source::new(name.as_str(), text.as_str())).unwrap();
        assert_eq!(kinds(&index(&text)), kinds(&index(&formatted)), "{name}");
    }
}

#[test]
fn large_texts_are_indexed_without_end_to_memory_or_stack() {
    for unit in [
        "a.",
        "{",
        "let a = a\n",
        "state S {",
        "whisker a, ",
        "law l(a: vector of length, ",
        "{let a = a}",
        "(a",
        "# \n",
    ] {
        let text = unit.repeat(250_000 / unit.len());
        let index = index(&text);
        let _ = (index.hover(9), index.candidates(text.len()));
    }
}
