//! What editors are told of the places in a policy.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::path::Path;

use proptest::prelude::*;
use vibrissa::diagnostic::{Source, Span};
use vibrissa::machine::Program;
use vibrissa::policy::index::{Candidate, CandidateKind, Index, RenameError, Symbol, SymbolKind, gather};
use vibrissa::policy::{Checked, check};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");
const THESIS: &str = include_str!("../policies/thesis.fsm");
const SWIPE: &str = include_str!("../policies/std/swipe.fsm");

fn index(text: &str) -> Index {
    Index::new(&Source::new("test.fsm", text), None)
}

/// A source with the files of the fixtures that it uses.
fn gathered(text: &str) -> Source {
    let file = |path: &str| {
        let path = Path::new(ROOT).join("tests/fixtures/policies/use").join(path);
        std::fs::read_to_string(path).map_err(|_| "there is none".to_owned())
    };
    gather(&Source::new("test.fsm", text), &mut { file })
}

/// Every policy and library of the project that has no fault, with its name.
fn policies() -> Vec<(String, String)> {
    let folders = [
        "policies",
        "policies/std",
        "tests/fixtures/policies/warn",
        "tests/fixtures/policies/format",
        "tests/fixtures/charts",
    ];
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
    texts.push(("with another file".to_owned(), USING.to_owned()));
    texts.push(("marks".to_owned(), MARKING.to_owned()));
    texts.retain(|(_, text)| check(&gathered(text)).is_ok());
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

const USING: &str = r#"machine m

use "laws/corner.fsm" (wait, sharp)
use std.guards

whisker r0

let blunt = 2 * sharp

initial Waiting

state Waiting {
  do wait(r0)
  when lost(r0) and angle(r0.base) > blunt -> Failure("it is lost")
}
"#;

const MARKING: &str = r#"machine m

whisker r0

param lost = 100 ms in 0 .. 1 s

initial Waiting

state Waiting {
  mark lost r0
  mark found r0
  when not r0.touching for lost -> Failure("it is lost")
}

test "lost" in "lost.yaml" {
  set lost = 200 ms
  expect run.failed and run.visits(Waiting) == 1
}
"#;

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
        let before = check(&gathered(&text)).unwrap();
        let index = Index::new(&gathered(&text), None);
        for symbol in index.symbols() {
            let places = index.rename(symbol.span.start, "fresh_name").unwrap();
            assert!(places.contains(&symbol.span));
            let after = replaced(&text, &places, "fresh_name");
            let after = check(&gathered(&after))
                .unwrap_or_else(|faults| panic!("{name}, {}: {faults:?}\n{after}", symbol.name));
            match (after, &before) {
                (Checked::Machine(after), Checked::Machine(before)) => {
                    let [after, before] = [after.artifact.program, before.artifact.program.clone()].map(nameless);
                    assert_eq!(after, before, "{name}, {}", symbol.name);
                }
                (after, before) => {
                    assert!(matches!((after, before), (Checked::Library { .. }, Checked::Library { .. })));
                }
            }
            renamed += 1;
        }
    }
    assert!(renamed > 250, "{renamed}");
}

#[test]
fn every_place_of_a_name_leads_to_where_it_is_given_and_is_explained() {
    for (name, text) in policies() {
        let index = Index::new(&gathered(&text), None);
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
        let index = Index::new(&gathered(&text), None);
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
    candidates(text).into_iter().map(|candidate| candidate.label).collect()
}

/// What can be written at the `§` of a text.
fn candidates(text: &str) -> Vec<Candidate> {
    let at = text.find('\u{a7}').unwrap();
    Index::new(&gathered(&text.replace('\u{a7}', "")), None).candidates(at).1
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
    let members = [
        "deflection",
        "touching",
        "yaw",
        "side",
        "sense",
        "length",
        "tip",
        "tip_base",
        "tip_spread",
        "base",
        "tip_at",
        "contour",
    ];
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
        assert_eq!(labels(&writing(place)), ["ready", "tangent", "normal", "end", "point", "curvature"], "{place}");
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
        ("hold\n  st\u{a7}", "steer", "param"),
        ("hold\n  st\u{a7}", "state", "always"),
        ("hold\n  \u{a7}", "failsafe", "use"),
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
    assert_eq!(labels("\u{a7}"), ["machine", "library"]);
    assert_eq!(labels("library l\n\u{a7}"), ["use", "law", "let"]);
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
    let good = index(SWIPE);
    let broken = SWIPE.replace("let tangent = w.contour.tangent", "let tangent = w.contour.");
    let before = Index::new(&Source::new("swipe.fsm", broken.as_str()), Some(&good));
    let names = |index: &Index| index.symbols().iter().map(|symbol| symbol.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&before), names(&good));
    let at = broken.find("do swipe_tilted").unwrap() + 3;
    let given = broken.find("swipe_tilted(w: ").unwrap();
    assert_eq!(before.definition(at), Some(Span::new(given, given + "swipe_tilted".len())));
    // What the fault leaves has its types; for the rest, types of before are remembered.
    let pull = broken.find("pull * unit").unwrap();
    assert!(index(&broken).hover(pull).unwrap().text.contains("a plain number"));
    let tangent = broken.find("tangent at speed").unwrap();
    assert!(before.hover(tangent).unwrap().text.contains("a vector of plain numbers"));
    assert!(!index(&broken).hover(tangent).unwrap().text.contains("a vector of plain numbers"));
    assert_eq!(before.rename(at, "other"), Err(RenameError::Unreadable));
    // A fault of meaning hides no place of a name.
    let wrong = SWIPE.replace("0 deg)", "0 mm)");
    assert!(check(&Source::new("a", wrong.as_str())).is_err());
    assert_eq!(
        index(&wrong).rename(wrong.find("swipe_tilted(w: ").unwrap(), "other").map(|places| places.len()),
        Ok(2)
    );
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
    let in_swipe = |part: &str, name: &str| self::index(SWIPE).rename(SWIPE.find(part).unwrap(), name).unwrap_err();
    assert_eq!(in_swipe("clamp", "x"), RenameError::BuiltIn("clamp".to_owned()));
    assert_eq!(rename("touching", "x"), RenameError::BuiltIn("touching".to_owned()));
    assert_eq!(rename("# The", "x"), RenameError::NoName);
    assert_eq!(rename("std.guards", "x"), RenameError::NoName);
    assert_eq!(rename("lost ", "limit"), RenameError::Taken { name: "limit".to_owned(), line: 15 });
    let line = |part: &str| SWIPE[..SWIPE.find(part).unwrap()].matches('\n').count() + 1;
    let taken = |name: &str, line| RenameError::Taken { name: name.to_owned(), line };
    assert_eq!(in_swipe("tilt: angle", "tangent"), taken("tangent", line("let tangent")));
    assert_eq!(in_swipe("tangent = w", "tilt"), taken("tilt", line("tilt: angle")));
    let (name, file) = ("at_limit".to_owned(), "std.guards".to_owned());
    assert_eq!(rename("at_limit(r0", "x"), RenameError::Foreign { name: name.clone(), file: file.clone() });
    assert_eq!(rename("at_limit, ", "x"), RenameError::Foreign { name: name.clone(), file: file.clone() });
    assert_eq!(rename("lost ", "at_limit"), RenameError::Brought { name, file });
    assert_eq!(rename("lost ", "state"), RenameError::Reserved("state".to_owned()));
    assert_eq!(rename("lost ", "Failure"), RenameError::Reserved("Failure".to_owned()));
    for name in ["", "1a", "a b", "\u{e4}", "a-b"] {
        assert_eq!(rename("lost ", name), RenameError::Malformed(name.to_owned()));
    }
}

#[test]
fn a_hover_says_type_unit_range_and_description() {
    let of = |text: &str, part: &str| index(text).hover(text.find(part).unwrap()).unwrap().text;
    assert_eq!(
        of(THESIS, "target, speed"),
        "```fsm\nparam target = 300 urad in 50 .. 800 urad\n```\n\nan angle, in deg, rad, mrad, urad\n\nbase angle at which the tip \
         is known best"
    );
    assert_eq!(of(SWIPE, "tangent = w"), "```fsm\nlet tangent = w.contour.tangent\n```\n\na vector of plain numbers");
    let law = "```fsm\nlaw swipe(w: whisker, target: angle, speed: speed)\n```\n\nAlgorithm 3.";
    assert!(of(SWIPE, "swipe(w: ").starts_with(law));
    assert!(of(THESIS, "swipe(w, ").starts_with(law) && of(THESIS, "swipe(w, ").ends_with("from `std.swipe`"));
    assert!(
        of(THESIS, "std.swipe").contains("algorithms 1 to 3") && of(THESIS, "std.swipe").contains("law swipe_tilted(")
    );
    assert_eq!(of(SWIPE, "w.contour"), "```fsm\nw: whisker\n```\n\na whisker");
    assert_eq!(
        of(SWIPE, "clamp("),
        "```fsm\nclamp(x, low, high)\n```\n\n`min(max(x, low), high)`\n\nIt takes three numbers of one dimension: what to clamp, the \
         least, the greatest."
    );
    assert!(of(SWIPE, "contour.ready").starts_with("```fsm\nwhisker.contour\n```\n\na contour\n\nwhat `record`"));
    assert!(of(SWIPE, "tip_at(").starts_with("```fsm\nwhisker.tip_at(deflection)\n```"));
    assert!(
        of(SWIPE, "tangent\n").starts_with("```fsm\ncontour.tangent\ncontour.tangent(distance behind the end)\n```")
    );
    assert!(of(THESIS, "visits(").starts_with("```fsm\nrun.visits(State)\n```"));
    assert_eq!(of(THESIS, "mm/s "), "```fsm\nmm/s\n```\n\na unit of a speed: 0.001 m/s");
    assert!(of(SWIPE, "hold\n").starts_with("```fsm\nhold\n```"));
    let products = "library l\nlet x(a: angular_speed / length, b: vector of length / time) = a * |b|";
    assert!(of(products, "a: ").starts_with("```fsm\na: angular_speed / length\n```\n\n"));
    assert!(of(products, "time)").ends_with("a time, in s, ms, us"), "{}", of(products, "time)"));
}

#[test]
fn every_built_in_is_explained_by_the_words_of_the_reference_page() {
    let page = include_str!("../docs/reference.md").replace('`', "");
    let inside = candidates("library l\nlaw l(w: whisker) { let x = \u{a7}");
    let members = candidates("library l\nlaw l(w: whisker) { let x = w.\u{a7}");
    let functions = inside.into_iter().filter(|candidate| candidate.kind == CandidateKind::Function);
    let mut explained = 0;
    for candidate in members.into_iter().chain(functions) {
        assert!(page.contains(&candidate.meaning.replace('`', "")), "{candidate:?}");
        assert!(!candidate.meaning.is_empty());
        explained += 1;
    }
    assert_eq!(explained, 12 + 24);
}

#[test]
fn names_of_other_files_lead_there_and_are_explained() {
    let index = Index::new(&gathered(USING), None);
    let at = |part: &str| USING.find(part).unwrap();
    let source = index.source();
    for part in ["wait(r0", "wait, sharp"] {
        let place = index.definition(at(part)).unwrap();
        assert_eq!(source.part_name(source.part_at(place.start)), "laws/corner.fsm");
        assert_eq!(source.slice(place), "wait");
        let hover = index.hover(at(part)).unwrap().text;
        assert_eq!(hover, "```fsm\nlaw wait(w: whisker)\n```\n\nStops, and says nothing.\n\nfrom `laws/corner.fsm`");
        assert_eq!(index.references(at(part)).len(), 2);
    }
    let corner = source.part_at(index.definition(at("wait(r0")).unwrap().start);
    assert_eq!(
        index.definition(at("\"laws")),
        Some(Span::new(source.part_span(corner).start, source.part_span(corner).start))
    );
    assert!(index.hover(at("sharp\n")).unwrap().text.contains("an angle"));
    assert!(index.hover(at("blunt =")).unwrap().text.contains("an angle"));
    // The file that the used one uses.
    let signs = (1..source.count()).find(|&part| source.part_name(part) == "laws/signs.fsm").unwrap();
    assert_eq!(index.way_to(signs).map(|way| source.slice(way).trim_matches('"')), Some("laws/corner.fsm"));
    assert_eq!(index.way_to(0), None);
    let refused = index.rename(at("wait(r0"), "x").unwrap_err();
    assert_eq!(refused.to_string(), "`wait` is given in `laws/corner.fsm` and keeps its name here; rename it there");
    assert!(matches!(index.rename(at("blunt ="), "is_near"), Err(RenameError::Brought { .. })));
}

#[test]
fn a_use_is_completed_by_modules_and_by_the_names_of_the_file() {
    let modules = ["guards", "retrieval", "swipe", "tunnel"];
    assert_eq!(labels("machine m\nuse \u{a7}"), modules.map(|module| format!("std.{module}")));
    assert_eq!(labels("machine m\nuse std.\u{a7}"), modules);
    assert_eq!(labels("machine m\nuse std.sw\u{a7}\nwhisker r0"), modules);
    for list in ["(\u{a7}", "(\u{a7})", "(swipe, \u{a7})\nwhisker r0\n", "(sw\u{a7}"] {
        assert_eq!(labels(&format!("machine m\nuse std.swipe {list}")), ["swipe", "swipe_tilted"], "{list}");
        assert_eq!(labels(&format!("machine m\nuse \"laws/corner.fsm\" {list}")), ["sharp", "wait"], "{list}");
    }
    let has = |text: &str, name: &str| labels(text).contains(&name.to_owned());
    let using = |inside: &str| USING.replace("  do wait(r0)\n", inside);
    assert!(has(&using("do \u{a7}"), "wait") && !has(&using("do \u{a7}"), "sharp"));
    assert!(has(&using("let x = \u{a7}\n"), "sharp") && has(&using("let x = \u{a7}\n"), "is_near"));
    // What the used file uses itself is not known.
    assert!(!has(&using("let x = \u{a7}\n"), "bent"));
}

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
    let ends = [("resume", "resume ${1:State}"), ("Failure", "Failure(\"${1:reason}\")")];
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
    assert!(index.hover(at("mark lost") + 5).unwrap().text.contains("the object's edge"));
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
        "state S {}",
        "use std.swipe (swipe, ",
        "use std.retrieval\n",
        "whisker a, ",
        "law l(a: vector of length, ",
        "{let a = a}",
        "(a",
        "# \n",
    ] {
        let text = unit.repeat(250_000 / unit.len());
        let index = index(&text);
        let _ = (index.hover(9), index.candidates(text.len()));
        let unfinished = self::index(&format!("{text} when true -> "));
        let _ = unfinished.candidates(unfinished.source().text.len());
    }
}
