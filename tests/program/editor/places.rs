//! The places of a name, and the outline.

use serde_json::{Value, json};

use super::answer::THESIS;
use super::client::{Editor, URI, covered, position};

#[test]
fn references_highlights_and_the_outline_show_all_places() {
    let mut editor = Editor::open(THESIS);
    let at = position(THESIS, "limit  =", 0);
    let all = editor.ask_at("references", &at, json!({"context": {"includeDeclaration": true}}));
    let used = editor.ask_at("references", &at, json!({"context": {"includeDeclaration": false}}));
    assert_eq!((all["result"].as_array().unwrap().len(), used["result"].as_array().unwrap().len()), (3, 2));
    for place in all["result"].as_array().unwrap() {
        assert_eq!(covered(THESIS, &place["range"]), "limit");
    }
    let highlights = editor.ask_at("documentHighlight", &at, json!({}));
    let kinds: Vec<&Value> = highlights["result"].as_array().unwrap().iter().map(|place| &place["kind"]).collect();
    assert_eq!(kinds, [3, 2, 2]);

    let symbols = editor.ask("textDocument/documentSymbol", json!({"textDocument": {"uri": URI}}));
    let symbols = symbols["result"].as_array().unwrap();
    let named: Vec<&Value> = symbols.iter().map(|symbol| &symbol["name"]).collect();
    assert_eq!(named, ["r0", "l0", "speed", "target", "limit", "lost", "Exploring", "Swiping"]);
    let swiping = covered(THESIS, &symbols[7]["range"]);
    assert!(swiping.starts_with("state Swiping(w: whisker) {") && swiping.ends_with("object\")\n}"), "{swiping}");
    assert_eq!(symbols[7]["detail"], "state Swiping(w: whisker)");
}

#[test]
fn states_in_states_are_a_tree_in_the_outline() {
    let text = include_str!("../../fixtures/charts/nested.fsm");
    let mut editor = Editor::open(text);
    let symbols = editor.ask("textDocument/documentSymbol", json!({"textDocument": {"uri": URI}}));
    let mut found = Vec::new();
    states(&mut found, 0, &symbols["result"]);
    let written = text.lines().filter_map(|line| Some((line, line.trim_start().strip_prefix("state ")?)));
    let written = written.map(|(line, state)| {
        // Every level is two blanks.
        let depth = (line.len() - line.trim_start().len()) / 2;
        (depth, state.split(|letter: char| !letter.is_alphanumeric()).next().unwrap().to_owned())
    });
    assert_eq!(found, written.collect::<Vec<_>>());
}

/// The states among symbols of an outline and in them, with how deep each lies.
fn states(found: &mut Vec<(usize, String)>, depth: usize, symbols: &Value) {
    for symbol in symbols.as_array().into_iter().flatten().filter(|symbol| symbol["kind"] == 5) {
        found.push((depth, symbol["name"].as_str().unwrap().to_owned()));
        states(found, depth + 1, &symbol["children"]);
    }
}
