//! Other names for things.

use vibrissa_language::index::{Index, RenameError, Role, SymbolKind};
use vibrissa_language::{check, compile};
use vibrissa_runtime::machine::Program;
use vibrissa_text::diagnostic::{Diagnostic, Source, Span};

use super::policies::{SWIPE, THESIS, gathered, index, policies};

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
    program.contours.iter_mut().for_each(|contour| contour.name.clear());
    for parameter in &mut program.parameters {
        parameter.name.clear();
        parameter.choices.iter_mut().for_each(String::clear);
    }
    let mut contracts: Vec<_> = program.contracts.iter_mut().collect();
    for state in &mut program.states {
        state.name = "".into();
        contracts.extend(&mut state.contracts);
    }
    for contract in contracts {
        contract.text = "".into();
    }
    program.outputs.plots.iter_mut().for_each(|plot| plot.name.clear());
    for value in program.outputs.messages.iter_mut().flat_map(|message| &mut message.values) {
        value.name = "".into();
    }
    format!("{program:?}")
}

/// What a policy is without its names; `None` for a library without faults. Warnings, which take most of a check's time, are left out.
fn machine(source: &Source) -> Result<Option<String>, Vec<Diagnostic>> {
    match compile(source) {
        Ok(program) => Ok(Some(nameless(program))),
        Err(faults) if faults.iter().any(|fault| fault.code == "P0603") => check(source).map(|_| None),
        Err(faults) => Err(faults),
    }
}

#[test]
fn whatever_is_renamed_the_machine_stays_the_same() {
    let mut renamed = 0;
    for (name, text) in policies() {
        let before = machine(&gathered(&text)).unwrap_or_else(|faults| panic!("{name}: {faults:?}"));
        let index = Index::new(&gathered(&text), None);
        for symbol in index.symbols() {
            if symbol.name == "speed" && text.contains("\nproperty ") {
                let refused = index.rename(symbol.span.start, "fresh_name");
                assert_eq!(refused, Err(RenameError::SetByScenes("speed".to_owned())));
                continue;
            }
            let places = index.rename(symbol.span.start, "fresh_name").unwrap();
            assert!(places.contains(&symbol.span));
            let after = replaced(&text, &places, "fresh_name");
            let after = machine(&gathered(&after))
                .unwrap_or_else(|faults| panic!("{name}, {}: {faults:?}\n{after}", symbol.name));
            assert_eq!(after, before, "{name}, {}", symbol.name);
            renamed += 1;
        }
    }
    assert!(renamed > 250, "{renamed}");
}

#[test]
fn the_machines_memory_has_one_name_wherever_it_is_known() {
    let text = "machine m\nstate S {\n  set n = n + 1\n  stop\n}\nset n = 2 * n\nalways when n > limit -> S\nvar n = 0\n\
                param limit = 3\ninitial S\nlaw l(x: number) { stop }\n";
    let index = index(text);
    let at = text.rfind("n = 0").unwrap();
    let symbol = index.symbols().iter().find(|symbol| symbol.span.start == at).unwrap();
    assert_eq!((symbol.kind, symbol.owner), (SymbolKind::Memory, None));
    assert_eq!(index.references(at).iter().filter(|(_, role)| *role == Role::Writes).count(), 2);
    let renamed = replaced(text, &index.rename(at, "count").unwrap(), "count");
    assert_eq!(renamed.matches("count").count(), 6);
    assert!(compile(&Source::new("renamed.fsm", renamed)).is_ok());
    for taken in ["limit", "S", "x"] {
        assert!(matches!(index.rename(at, taken), Err(RenameError::Taken { .. })), "{taken}");
    }
}

#[test]
fn a_value_of_an_enumeration_and_an_argument_are_renamed_wherever_they_are_used() {
    let text = "machine m\nwhisker a\ntype Side = left or right\nparam side = Side.left\n\
                let is_left(which: Side, left: bool = true) = which == Side.left and left\ninitial S\n\
                state S { stop  when is_left(left: a.touching, which: side) -> T(left: 1 s) }\n\
                state T(left: time) { stop  after left -> S }\n\
                test \"it\" in \"a.yaml\" { set side = Side.left  expect run.completed }\n";
    let index = index(text);
    let renamed = |declared: &str| {
        let at = text.find(declared).unwrap();
        let renamed = replaced(text, &index.rename(at, "fresh").unwrap(), "fresh");
        assert!(compile(&Source::new("renamed.fsm", &*renamed)).is_ok(), "{renamed}");
        renamed.matches("fresh").count()
    };
    assert_eq!(["left or", "left: bool", "left: time", "Side ="].map(renamed), [4, 3, 3, 5]);
    let taken = index.rename(text.find("left or").unwrap(), "right").unwrap_err();
    assert_eq!(taken, RenameError::Taken { name: "right".to_owned(), line: 3 });
    let hover = |part: &str| index.hover(text.find(part).unwrap()).unwrap().text;
    assert!(hover("side =").contains("a `Side`") && hover("left and").contains("a `Side`"));
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
    let standard = RenameError::Standard { name: name.clone(), module: file.clone() };
    assert_eq!(rename("at_limit(r0", "x"), standard);
    assert_eq!(rename("at_limit, ", "x"), standard);
    assert_eq!(rename("lost ", "at_limit"), RenameError::Imported { name, file });
    assert_eq!(rename("lost ", "state"), RenameError::Reserved("state".to_owned()));
    assert_eq!(rename("lost ", "Failure"), RenameError::Reserved("Failure".to_owned()));
    for name in ["", "1a", "a b", "\u{e4}", "a-b"] {
        assert_eq!(rename("lost ", name), RenameError::Malformed(name.to_owned()));
    }
}
