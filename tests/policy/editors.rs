//! What is offered to editors: their grammar knows the words of the language, and no others; the extension is whole.

use std::collections::BTreeSet;
use std::process::Command;

use serde_json::{Value, json};
use vibrissa_language::scopes;

const EDITORS: &str = include_str!("../../editors/vscode/syntaxes/fsm.tmLanguage.json");

/// The editors' grammar with the words of the language in place of those that it lists. The list of a scope is the first
/// group of plain words in a rule with its name.
fn with_words_of_the_language(grammar: &str) -> String {
    let mut grammar = grammar.to_owned();
    for (scope, words) in scopes() {
        let list = grammar.match_indices(&format!("\"{scope}\"")).find_map(|(at, _)| {
            let rule = &grammar[at..at + grammar[at..].find('}')?];
            let open =
                rule.match_indices('(').find(|(open, _)| rule[open + 1..].starts_with(char::is_alphabetic))?.0 + 1;
            Some(at + open..at + open + rule[open..].find(')')?)
        });
        grammar.replace_range(list.unwrap_or_else(|| panic!("no words have the scope {scope}")), &words.join("|"));
    }
    grammar
}

#[test]
fn the_editors_words_are_those_of_the_language() {
    let generated = with_words_of_the_language(EDITORS);
    if std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
        std::fs::write(format!("{FOLDER}/syntaxes/fsm.tmLanguage.json"), &generated).unwrap();
    } else {
        assert_eq!(EDITORS, generated, "INSTA_UPDATE=always writes the words again");
    }
}

#[test]
fn every_rule_that_the_editors_grammar_includes_is_there() {
    fn included(value: &Value, into: &mut BTreeSet<String>) {
        into.extend(value["include"].as_str().map(str::to_owned));
        let inner =
            value.as_object().into_iter().flat_map(|map| map.values()).chain(value.as_array().into_iter().flatten());
        inner.for_each(|inner| included(inner, into));
    }
    let grammar: Value = serde_json::from_str(EDITORS).unwrap();
    let mut names = BTreeSet::new();
    included(&grammar, &mut names);
    assert!(names.len() >= 10);
    for name in names {
        assert!(grammar["repository"][name.strip_prefix('#').unwrap()].is_object(), "{name}");
    }
}

const EXTENSION: &str = include_str!("../../editors/vscode/extension.js");
const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../editors/vscode");

fn json(file: &str) -> Value {
    serde_json::from_str(&std::fs::read_to_string(format!("{FOLDER}/{file}")).unwrap()).unwrap()
}

#[test]
fn the_files_of_the_extension_are_there() {
    let package = json("package.json");
    let contributes = &package["contributes"];
    assert_eq!(contributes["languages"][0]["extensions"], json!([".fsm"]));
    assert_eq!(json(contributes["languages"][0]["configuration"].as_str().unwrap())["comments"]["lineComment"], "#");
    assert_eq!(json(contributes["grammars"][0]["path"].as_str().unwrap())["scopeName"], "source.fsm");
    assert_eq!(package["main"], "./extension.js");
    let packed = package["files"].as_array().unwrap();
    assert!(packed.contains(&json!("extension.js")));
    for file in packed {
        assert!(std::fs::exists(format!("{FOLDER}/{}", file.as_str().unwrap())).unwrap(), "{file}");
    }
}

/// The texts between `before` and the next quotation mark.
fn quoted<'t>(text: &'t str, before: &str) -> BTreeSet<&'t str> {
    text.split(before).skip(1).map(|behind| behind.split('"').next().unwrap()).collect()
}

#[test]
fn the_extension_reads_the_settings_and_has_the_commands_that_it_announces() {
    let package = json("package.json");
    let contributes = &package["contributes"];
    let settings = contributes["configuration"]["properties"].as_object().unwrap();
    for setting in settings.keys() {
        let (section, name) = setting.split_once('.').unwrap();
        assert!(EXTENSION.contains(&format!("getConfiguration(\"{section}\").get(\"{name}\")")), "{setting}");
        assert!(EXTENSION.contains(&format!("affectsConfiguration(\"{setting}\")")), "{setting}");
    }
    assert_eq!(quoted(EXTENSION, ".get(\"").len(), settings.len());
    let commands = contributes["commands"].as_array().unwrap();
    let commands: BTreeSet<&str> = commands.iter().map(|command| command["command"].as_str().unwrap()).collect();
    assert_eq!(quoted(EXTENSION, "registerCommand(\""), commands);
    let needed = quoted(EXTENSION, "require(\"").into_iter().map(|module| module.split('/').next().unwrap());
    let given = package["dependencies"].as_object().unwrap().keys().map(String::as_str);
    assert_eq!(needed.collect::<BTreeSet<_>>(), given.chain(["vscode"]).collect());
    let language = quoted(EXTENSION, "language: \"");
    assert_eq!(language, BTreeSet::from([contributes["languages"][0]["id"].as_str().unwrap()]));
}

#[test]
fn the_extension_is_javascript() {
    // Where there is no Node.js there is nobody to ask.
    if let Ok(output) = Command::new("node").arg("--check").arg(format!("{FOLDER}/extension.js")).output() {
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
}
