//! What holds for every text.

use proptest::prelude::*;
use vibrissa_language::index::{Index, Symbol, SymbolKind};
use vibrissa_text::diagnostic::Source;

use super::policies::{THESIS, index, policies};

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
        let formatted = vibrissa_language::format(&Source::new(name.as_str(), text.as_str())).unwrap();
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
