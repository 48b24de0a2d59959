//! Policies of several files: what they may use, and what is said when they do it wrong.

use std::cell::RefCell;

use crate::snapshots::snapshots;
use proptest::prelude::*;
use vibrissa_language::{Checked, check, compile, compile_with_warnings, format, gather};
use vibrissa_text::diagnostic::{Colour, Diagnostic, Source, records, terminal};

const FIXTURES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/fixtures/policies/use");

/// A source with files that are given as names and texts.
fn gathered(text: &str, files: &[(&str, String)]) -> Source {
    let file = |path: &str| files.iter().find(|(name, _)| *name == path).map(|(_, text)| text.clone());
    gather(&Source::new("main.fsm", text), &mut |path| file(path).ok_or("there is none".to_owned()))
}

fn faults(text: &str, files: &[(&str, String)]) -> Vec<Diagnostic> {
    compile(&gathered(text, files)).err().unwrap_or_default()
}

fn codes(text: &str, files: &[(&str, String)]) -> Vec<&'static str> {
    faults(text, files).iter().map(|fault| fault.code).collect()
}

const STILL: &str = "initial Still state Still { stop }";

#[test]
fn every_use_is_answered_as_reviewed() {
    snapshots("policies").bind(|| {
        insta::glob!("../fixtures/policies/use", "*.fsm", |path| {
            let name = path.file_name().unwrap().to_string_lossy();
            let source = Source::new(name, std::fs::read_to_string(path).unwrap());
            let source = gather(&source, &mut |path| {
                std::fs::read_to_string(format!("{FIXTURES}/{path}")).map_err(|_| "there is no such file".to_owned())
            });
            let told = match check(&source) {
                Ok(Checked::Machine(compiled)) => compiled.warnings,
                Ok(Checked::Library { warnings, .. }) => warnings,
                Err(faults) => faults,
            };
            insta::assert_snapshot!("use", terminal(&source, &told, Colour::Plain));
        });
    });
}

#[test]
fn a_law_means_the_same_wherever_it_stands() {
    let laws =
        "let half = 0.5  law creep(s: speed) { steer body along direction(body.yaw) at half * s turning 0 deg/s }";
    let state = "initial Going state Going { do creep(50 mm/s) }";
    let alone = compile(&Source::new("main.fsm", format!("machine m {laws} {state}"))).unwrap();
    for used in ["use \"a/creep.fsm\"", "use \"a/creep.fsm\" (creep)", "use \"./b/../a/creep.fsm\" (creep)"] {
        let files = [("a/creep.fsm", format!("library creep {laws}"))];
        assert_eq!(compile(&gathered(&format!("machine m {used} {state}"), &files)).unwrap(), alone);
    }
}

#[test]
fn a_test_file_has_the_machine_that_it_names_and_its_own_tests() {
    let machine = "machine m param patience = 2 s in 1 .. 60 s param speed = 50 mm/s in 1 .. 200 mm/s initial Still state Still { stop after patience -> Failure(\"late\") }
        test \"of the machine\" in \"disk.yaml\" { expect run.failed }";
    let files = [("machines/m.fsm", machine.to_owned())];
    let text = "tests of \"machines/m.fsm\"
        test \"of the file\" in \"../disk.yaml\" { set patience = 5 s expect run.time_in(Still) > patience - 100 ms }
        property \"of all\" over convex-corner { expect not run.completed }";
    let compiled = compile_with_warnings(&gathered(text, &files)).unwrap();
    assert!(compiled.is_test_file && compiled.warnings.is_empty());
    let titles: Vec<&str> = compiled.tests.iter().map(|test| test.title.as_str()).collect();
    assert_eq!(titles, ["of the file", "of all"]);
    assert_eq!(compiled.artifact.program, compile(&gathered(machine, &[])).unwrap());
    let own = compile_with_warnings(&gathered(machine, &[])).unwrap();
    assert!(!own.is_test_file && own.tests.len() == 1);
}

#[test]
fn a_test_file_with_anything_else_is_an_error() {
    let machine = ("m.fsm", format!("machine m use \"l.fsm\" {STILL}"));
    let files = [machine, ("l.fsm", "library l let half = 0.5".to_owned()), ("t.fsm", "tests of \"m.fsm\"".to_owned())];
    for item in ["param x = 1", "let x = 1", "use std.swipe", "state Going { stop }", "var x = 1", "record r0"] {
        assert_eq!(codes(&format!("tests of \"m.fsm\" {item}"), &files), ["P0603"], "{item}");
    }
    // Only a machine can be tested, and no file can use tests.
    for text in ["tests of \"l.fsm\"", "tests of \"t.fsm\"", &format!("machine m use \"t.fsm\" {STILL}")] {
        assert_eq!(codes(text, &files), ["P0603"], "{text}");
    }
    assert_eq!(codes("tests of \"main.fsm\"", &files), ["P0604"]);
    assert_eq!(codes("tests of \"none.fsm\"", &files), ["P0602"]);
    assert_eq!(
        codes("tests of \"m.fsm\" test \"no\" in \"a.yaml\" { expect run.visits(Going) == 0 }", &files),
        ["P0201"]
    );
    assert_eq!(codes("tests of \"m.fsm\"", &files), [""; 0]);
}

#[test]
fn names_of_a_library_are_its_own() {
    let files = [
        ("a.fsm", "library a use \"b.fsm\" (scale) let gain = 2 law act(x: speed) { do drive(scale * gain * x) } law drive(y: speed) { steer body along vector(1, 0) at y turning 0 rad/s }".to_owned()),
        ("b.fsm", "library b let gain = 10 let scale = gain".to_owned()),
    ];
    // The machine's own `gain`, `drive`, `x` and `y` are others.
    let text = "machine m use \"a.fsm\" (act) param gain = 100 let x = gain law drive() { stop }
        initial Going state Going { var y = x do drive() do act(1 m/s) when y > gain -> Failure(\"no\") }";
    let program = compile(&gathered(text, &files)).unwrap();
    let machine = &mut vibrissa_runtime::machine::Machine::new(std::sync::Arc::new(program));
    let mut senses = crate::common::Script::touches("x");
    let vibrissa_runtime::machine::Action::Steer { speed, .. } = machine.tick(&mut senses).action else { panic!() };
    assert!((speed - 20.0).abs() < 1e-12, "{speed}");
    // What a library uses is not handed on.
    assert_eq!(codes(&format!("machine m use \"a.fsm\" let z = scale {STILL}"), &files), ["P0201"]);
}

#[test]
fn a_file_that_is_used_twice_is_read_once() {
    let files = [
        ("a.fsm", "library a use \"c.fsm\" let a = c"),
        ("b.fsm", "library b use \"./c.fsm\" use \"c.fsm\" (c) let b = c"),
        ("c.fsm", "library c let c = 1"),
    ];
    let read = RefCell::new(Vec::new());
    let text = format!("machine m use \"a.fsm\" use \"b.fsm\" let d = a + b {STILL}");
    let source = gather(&Source::new("main.fsm", text), &mut |path| {
        read.borrow_mut().push(path.to_owned());
        files.iter().find(|(name, _)| *name == path).map(|(_, text)| (*text).to_owned()).ok_or(String::new())
    });
    assert_eq!(read.take(), ["a.fsm", "b.fsm", "c.fsm"]);
    assert!(compile(&source).is_ok());
    let again = gather(&source, &mut |path| panic!("{path} is there already"));
    assert_eq!(again, source);
}

#[test]
fn a_fault_in_a_library_is_told_with_its_file_and_line() {
    let files = [("laws/a.fsm", "library a\nlet x = 1 m +\n  2 s\n".to_owned())];
    let source = gathered(&format!("machine m\nuse \"laws/a.fsm\"\n{STILL}"), &files);
    let records = records(&source, &compile(&source).unwrap_err());
    let [record] = records.as_slice() else { panic!("{records:?}") };
    assert_eq!((record.primary.file.as_str(), record.primary.line, record.primary.column), ("laws/a.fsm", 3, 3));
    assert_eq!((record.secondary[0].file.as_str(), record.secondary[0].line), ("laws/a.fsm", 2));
}

#[test]
fn without_its_parts_a_source_is_told_of_places_in_itself_only() {
    let source = Source::new("main.fsm", format!("machine m use std.swipe law l() {{ do swipe() }} {STILL}"));
    let faults = compile(&source).unwrap_err();
    assert!(faults.iter().all(|fault| fault.secondary.iter().all(|label| label.span.end <= source.text.len())));
    let whole = gather(&source, &mut |_| unreachable!());
    assert!(compile(&whole).unwrap_err()[0].secondary[0].span.start > source.text.len());
}

#[test]
fn the_origin_of_a_machine_covers_every_text() {
    let hash = |text: &str| {
        let files = [("a.fsm", format!("library a {text}"))];
        let source = gathered(&format!("machine m use \"a.fsm\" let b = a {STILL}"), &files);
        compile_with_warnings(&source).unwrap().artifact.origin.text_sha256
    };
    assert_eq!(hash("let a = 1"), hash("let a = 1"));
    assert_ne!(hash("let a = 1"), hash("let a = 2"));
    assert_ne!(hash("let a = 1"), hash("let a = 1 # one"));
}

#[test]
fn how_much_a_policy_may_use_is_bounded() {
    let chain: Vec<(String, String)> = (0..100)
        .map(|index| (format!("{index}.fsm"), format!("library l{index} use \"{}.fsm\" let v{index} = 1", index + 1)))
        .collect();
    let files: Vec<(&str, String)> = chain.iter().map(|(name, text)| (name.as_str(), text.clone())).collect();
    assert_eq!(codes(&format!("machine m use \"0.fsm\" {STILL}"), &files), ["P0602"]);

    let comment = format!("# {}\n", "x".repeat(250_000));
    let names = ["a", "b", "c", "d", "e"];
    let files = ["a.fsm", "b.fsm", "c.fsm", "d.fsm", "e.fsm"].map(|name| (name, format!("{comment}library l")));
    let uses: Vec<String> = names.iter().map(|name| format!("use \"{name}.fsm\"")).collect();
    assert_eq!(codes(&format!("machine m {} {STILL}", uses.join(" ")), &files), ["P0602"]);
}

#[test]
fn a_library_is_laid_out_like_a_policy() {
    let text = "library  l\nuse  \"a b.fsm\"(c,d)\nuse std . swipe(swipe)\nlaw a( ){hold}";
    let laid_out = "library l\nuse \"a b.fsm\" (c, d)\nuse std.swipe (swipe)\nlaw a() { hold }\n";
    assert_eq!(format(&Source::new("l.fsm", text)).unwrap(), laid_out);
    assert_eq!(format(&Source::new("l.fsm", laid_out)).unwrap(), laid_out);
}

proptest! {
    #[test]
    fn any_files_that_use_one_another_get_an_answer(links in prop::collection::vec(prop::collection::vec(0_usize..8, 0..4), 8)) {
        let texts: Vec<String> = links.iter().enumerate().map(|(index, links)| {
            let uses: Vec<String> = links.iter().map(|link| format!("use \"{link}.fsm\"")).collect();
            format!("library l{index} {} let v{index} = {index}", uses.join(" "))
        }).collect();
        let source = gather(&Source::new("main.fsm", format!("machine m use \"0.fsm\" {STILL}")), &mut |path| {
            Ok(texts[path.trim_end_matches(".fsm").parse::<usize>().unwrap()].clone())
        });
        // Whether a file is reached from itself, found the plain way.
        let reached = |from: usize| {
            let mut seen = vec![false; 8];
            let mut open = links[from].clone();
            while let Some(next) = open.pop() {
                if !std::mem::replace(&mut seen[next], true) {
                    open.extend(&links[next]);
                }
            }
            seen
        };
        let is_used = |index: usize| index == 0 || reached(0)[index];
        let has_cycle = (0..8).any(|index| is_used(index) && reached(index)[index]);
        let codes: Vec<&str> = compile(&source).err().unwrap_or_default().iter().map(|fault| fault.code).collect();
        prop_assert_eq!(codes, if has_cycle { vec!["P0604"] } else { vec![] });
    }
}
