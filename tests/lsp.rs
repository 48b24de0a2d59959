//! The language server over its real protocol: the program as a child, messages through its standard input and output.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]
#![allow(clippy::needless_pass_by_value, reason = "JSON literals read better without `&`")]

#[path = "common/editor.rs"]
mod editor;

use std::process::Command;

use editor::{Editor, URI, covered, edited, position, position_of};
use proptest::prelude::*;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};
use serde_json::{Value, json};
use vibrissa::diagnostic::Source;
use vibrissa::policy::compile;

const THESIS: &str = include_str!("../policies/thesis.fsm");
const BANG: &str = include_str!("../policies/bang.fsm");

fn labels(answer: &Value) -> Vec<&str> {
    answer["result"].as_array().unwrap().iter().map(|item| item["label"].as_str().unwrap()).collect()
}

fn code(answer: &Value) -> &Value {
    &answer["error"]["code"]
}

#[test]
fn a_session_from_the_first_word_to_the_last() {
    let mut editor = Editor::open(THESIS);
    assert_eq!(editor.diagnostics, json!({"uri": URI, "version": 0, "diagnostics": []}));

    // A fault comes and goes.
    let broken = THESIS.replace("-> Swiping(r0)", "-> Swiping(r0, 1)");
    editor.rewrite(&broken);
    let fault = &editor.diagnostics["diagnostics"][0];
    assert_eq!(
        (&fault["code"], &fault["severity"], &fault["source"]),
        (&json!("P0304"), &json!(1), &json!("vibrissa"))
    );
    assert_eq!(covered(&broken, &fault["range"]), "Swiping(r0, 1)");
    assert!(fault["message"].as_str().unwrap().contains("help: write `Swiping(w)`"), "{fault}");
    let related = &fault["relatedInformation"][0];
    assert_eq!(covered(&broken, &related["location"]["range"]), "Swiping");
    editor.rewrite(THESIS);
    assert_eq!(editor.diagnostics["diagnostics"], json!([]));

    let hover = editor.ask_at("hover", &position(THESIS, "speed", 1), json!({}));
    let text = hover["result"]["contents"]["value"].as_str().unwrap();
    assert!(text.contains("param speed = 50 mm/s in 1 .. 200 mm/s") && text.contains("a speed, in mm/s"), "{text}");
    assert_eq!(hover["result"]["contents"]["kind"], "markdown");
    assert_eq!(covered(THESIS, &hover["result"]["range"]), "speed");

    let definition = editor.ask_at("definition", &position(THESIS, "speed", 1), json!({}));
    assert_eq!(definition["result"]["range"]["start"], position(THESIS, "speed", 0));
    assert_eq!(definition["result"]["uri"], URI);

    let at = position(THESIS, "touching for lost", 0);
    let members = editor.ask_at("completion", &at, json!({}));
    assert!(labels(&members).contains(&"deflection") && !labels(&members).contains(&"clamp"), "{members}");

    // `lost` is the name of a parameter, and a word of comments and of the reasons of failures.
    let rename = editor.ask_at("rename", &position(THESIS, "for lost", 0), json!({"newName": "gone"}));
    assert!(rename["error"]["message"].as_str().unwrap().contains("belongs to the language"), "{rename}");
    let at = position(THESIS, "lost ", 0);
    let prepared = editor.ask_at("prepareRename", &at, json!({}));
    assert_eq!(prepared["result"]["placeholder"], "lost");
    let rename = editor.ask_at("rename", &at, json!({"newName": "gone"}));
    let renamed = edited(THESIS, &rename["result"]["changes"][URI]);
    assert!(renamed.contains("for gone ->") && renamed.contains("the contour is lost"), "{renamed}");
    let program = |text: &str| compile(&Source::new("a", text)).unwrap();
    let mut expected = program(THESIS);
    expected.parameters[3].name = "gone".to_owned();
    assert_eq!(program(&renamed), expected);

    // A layout of its own.
    let wide = BANG.replace(" = ", "   =").replace("{\n", "{\n\n\n");
    editor.rewrite(&wide);
    let options = json!({"textDocument": {"uri": URI}, "options": {"tabSize": 8, "insertSpaces": false}});
    let formatting = editor.ask("textDocument/formatting", options);
    let file = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("lsp_formatting.fsm");
    std::fs::write(&file, &wide).unwrap();
    let fmt = Command::new(env!("CARGO_BIN_EXE_vibrissa")).arg("fmt").arg(&file).output().unwrap();
    assert!(fmt.status.success());
    assert_eq!(edited(&wide, &formatting["result"]), std::fs::read_to_string(&file).unwrap());

    editor.tell("textDocument/didClose", json!({"textDocument": {"uri": URI}}));
    editor.hear();
    assert_eq!(editor.diagnostics["diagnostics"], json!([]));
    assert_eq!(editor.leave().code(), Some(0));
}

#[test]
fn an_exit_without_a_shutdown_and_an_editor_that_goes_away_have_exit_status_1() {
    let mut editor = Editor::with(&json!({})).0;
    editor.tell("exit", Value::Null);
    assert_eq!(editor.ended().code(), Some(1));
    assert_eq!(Editor::new().ended().code(), Some(1));
    let mut editor = Editor::open(THESIS);
    editor.send_bytes(b"Content-Length: 100\r\n\r\n{");
    assert_eq!(editor.ended().code(), Some(1));
}

#[test]
fn garbage_does_not_keep_the_server_from_answering_nor_from_ending() {
    let mut editor = Editor::open(THESIS);
    editor.send_bytes(&vec![0xff; 100_000]);
    editor.send_bytes(b"\nGET / HTTP/1.1\r\n\r\n");
    assert!(editor.ask_at("hover", &position(THESIS, "speed", 0), json!({}))["result"].is_object());
    editor.send_bytes(b"Content-Length: 5\r\n\r\n{\"a\":");
    assert_eq!(code(&editor.receive()), -32700);
    for body in ["[]", "{}", r#"{"jsonrpc": "2.0", "id": {}, "method": 3}"#] {
        editor.send_bytes(format!("Content-Length: {}\r\n\r\n{body}", body.len()).as_bytes());
        assert_eq!(code(&editor.receive()), -32600);
    }
    editor.send(&json!({"jsonrpc": "2.0", "id": 77, "result": null}));
    assert!(editor.ask_at("hover", &position(THESIS, "speed", 0), json!({}))["result"].is_object());
    assert_eq!(editor.leave().code(), Some(0));

    let mut editor = Editor::new();
    editor.send_bytes(b"Content-Length: 18446744073709551615\r\n\r\n{}");
    assert_eq!(editor.ended().code(), Some(1));
}

#[test]
fn what_the_server_does_not_know_is_refused_and_what_needs_no_answer_has_none() {
    let mut editor = Editor::open(THESIS);
    assert_eq!(code(&editor.ask("textDocument/somersault", json!({}))), -32601);
    assert_eq!(code(&editor.ask("textDocument/hover", json!({"textDocument": 3}))), -32602);
    assert_eq!(code(&editor.ask("textDocument/hover", Value::Null)), -32602);
    let elsewhere = json!({"textDocument": {"uri": "file:///other.fsm"}, "position": {"line": 0, "character": 0}});
    assert_eq!(code(&editor.ask("textDocument/hover", elsewhere)), -32602);
    assert_eq!(code(&editor.ask("initialize", json!({"capabilities": {}}))), -32600);
    // Wild notifications are passed over, a cancellation that comes too late is one of them.
    for method in ["$/cancelRequest", "$/setTrace", "textDocument/didSave", "textDocument/didOpen", "workspace/nothing"]
    {
        editor.tell(method, json!({"id": 1}));
        editor.tell(method, json!([7, "x", null]));
    }
    let change = json!({"textDocument": {"uri": "file:///other.fsm", "version": 1}, "contentChanges": [{"text": ""}]});
    editor.tell("textDocument/didChange", change);
    editor.tell("textDocument/didClose", json!({"textDocument": {"uri": "file:///other.fsm"}}));
    assert_eq!(editor.ask_at("hover", &json!({"line": 9999, "character": 9999}), json!({}))["result"], Value::Null);
    assert!(editor.ask("shutdown", Value::Null).get("error").is_none());
    assert_eq!(code(&editor.ask_at("hover", &position(THESIS, "speed", 0), json!({}))), -32600);
    editor.tell("exit", Value::Null);
    assert_eq!(editor.ended().code(), Some(0));
}

#[test]
fn nothing_is_answered_before_the_editor_has_introduced_itself() {
    let mut editor = Editor::new();
    assert_eq!(code(&editor.ask("textDocument/hover", json!({}))), -32002);
    assert_eq!(code(&editor.ask("shutdown", Value::Null)), -32002);
    assert!(editor.ask("initialize", json!({"capabilities": {}}))["result"]["capabilities"].is_object());
    assert_eq!(editor.leave().code(), Some(0));
}

#[test]
fn columns_are_counted_as_agreed() {
    let text = "machine m\ninitial S\nstate S { stop } # \u{1f980}\u{e4}\nstate T { when true -> S } # \u{1f980} S\n";
    for (offered, expected) in [(json!(["utf-8", "utf-16"]), "utf-8"), (json!([]), "utf-16"), (json!(null), "utf-16")] {
        let (mut editor, capabilities) = Editor::with(&json!({"general": {"positionEncodings": offered}}));
        assert_eq!(capabilities["positionEncoding"], expected);
        let item = json!({"uri": URI, "languageId": "fsm", "version": 0, "text": text});
        editor.tell("textDocument/didOpen", json!({"textDocument": item}));
        editor.hear();
        // Behind the crab of the third line, and there a letter is put in.
        let column = if expected == "utf-8" { 23 } else { 21 };
        let place = json!({"line": 2, "character": column});
        editor.change(json!([{"range": {"start": place, "end": place}, "text": "\nlet a = 1 #"}]));
        let symbols = editor.ask("textDocument/documentSymbol", json!({"textDocument": {"uri": URI}}));
        let names: Vec<&Value> = symbols["result"].as_array().unwrap().iter().map(|symbol| &symbol["name"]).collect();
        assert_eq!(names, ["S", "a", "T"]);
        let whole = &symbols["result"][1]["range"];
        assert_eq!(whole, &json!({"start": {"line": 3, "character": 0}, "end": {"line": 3, "character": 9}}));
    }
}

#[test]
fn what_nothing_uses_is_faded_and_what_is_misspelt_can_be_mended() {
    let mut editor = Editor::open(&THESIS.replace("initial", "param idle = 1 mm\ninitial"));
    let unused = &editor.diagnostics["diagnostics"][0];
    assert_eq!((&unused["code"], &unused["severity"], &unused["tags"]), (&json!("P0504"), &json!(2), &json!([1])));

    let broken = THESIS.replace("do swipe(w,", "do swpie(w,").replacen("r0.touching", "r0.tuoching", 1);
    editor.rewrite(&broken);
    let mut mended = broken.clone();
    for misspelt in ["tuoching", "swpie"] {
        let at = position(&broken, misspelt, 0);
        let range = json!({"start": at, "end": at});
        let asked = json!({"textDocument": {"uri": URI}, "range": range, "context": {"diagnostics": []}});
        let actions = editor.ask("textDocument/codeAction", asked);
        let action = &actions["result"][0];
        assert_eq!(action["kind"], "quickfix");
        let edit = &action["edit"]["changes"][URI];
        assert_eq!(edited(&broken, edit).len(), broken.len());
        // Both replace a word by one of its length.
        mended = edited(&mended, edit);
    }
    assert_eq!(mended.matches("r0.touching").count(), THESIS.matches("r0.touching").count());
    assert!(mended.contains("do swipe(w,"));
}

#[test]
fn an_editor_without_snippets_or_related_places_is_served_in_plain_text() {
    let mut editor = Editor::with(&json!({})).0;
    let text = THESIS.replace("-> Swiping(r0)", "-> Swiping");
    editor.tell(
        "textDocument/didOpen",
        json!({"textDocument": {"uri": URI, "languageId": "fsm", "version": 0, "text": text}}),
    );
    editor.hear();
    let fault = &editor.diagnostics["diagnostics"][0];
    assert!(fault.get("relatedInformation").is_none());
    let line = position(&text, "state Swiping", 0)["line"].as_u64().unwrap() + 1;
    assert!(fault["message"].as_str().unwrap().contains(&format!("line {line}: made here")), "{fault}");
    let targets = editor.ask_at("completion", &position(&text, "Swiping\n", 0), json!({}));
    assert_eq!(labels(&targets), ["Exploring", "Swiping", "Failure"]);
    for item in targets["result"].as_array().unwrap() {
        assert_eq!((&item["insertTextFormat"], &item["textEdit"]["newText"]), (&json!(1), &item["label"]));
    }
}

#[test]
fn a_completion_takes_the_place_of_what_is_typed_and_has_fields_to_fill_in() {
    let text = THESIS.replace("-> Swiping(r0)", "-> Swi");
    let mut editor = Editor::open(&text);
    let mut at = position(&text, "Swi\n", 0);
    at["character"] = json!(at["character"].as_u64().unwrap() + 3);
    let targets = editor.ask_at("completion", &at, json!({}));
    let item = &targets["result"][1];
    assert_eq!((&item["label"], &item["insertTextFormat"]), (&json!("Swiping"), &json!(2)));
    assert_eq!(item["textEdit"]["newText"], "Swiping(${1:w})");
    assert_eq!(covered(&text, &item["textEdit"]["range"]), "Swi");
    assert_eq!(targets["result"][2]["textEdit"]["newText"], "Failure(\"${1:reason}\")");
}

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
    let text = include_str!("fixtures/charts/nested.fsm");
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

#[test]
fn used_files_are_read_from_the_editor_or_else_from_where_they_lie() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("lsp use");
    std::fs::create_dir_all(folder.join("laws")).unwrap();
    let corner = "library corner\n\n# Stops.\nlaw wait(w: whisker) { stop }\n";
    std::fs::write(folder.join("laws/corner.fsm"), corner).unwrap();
    let root = format!("file://{}", folder.display().to_string().replace(' ', "%20"));
    let (main_uri, corner_uri) = (format!("{root}/main.fsm"), format!("{root}/laws/corner.fsm"));
    let text = "machine m\nuse \"laws/corner.fsm\"\nuse std.guards (lost)\nwhisker r0\ninitial S\nstate S {\n  do wait(r0)\n  \
                when lost(r0) -> Failure(\"lost\")\n}\n";
    let mut editor = Editor::open(THESIS);
    let open = |editor: &mut Editor, uri: &str, text: &str| {
        let item = json!({"uri": uri, "languageId": "fsm", "version": 0, "text": text});
        editor.tell("textDocument/didOpen", json!({"textDocument": item}));
        editor.hear();
    };
    open(&mut editor, &main_uri, text);
    assert_eq!(editor.diagnostics, json!({"uri": main_uri, "version": 0, "diagnostics": []}));
    let at = |method: &str, part: &str| {
        (
            format!("textDocument/{method}"),
            json!({"textDocument": {"uri": main_uri}, "position": position(text, part, 0), "newName": "x"}),
        )
    };
    let ask = |editor: &mut Editor, method: &str, part: &str| {
        let (method, parameters) = at(method, part);
        editor.ask(&method, parameters)
    };
    let definition = ask(&mut editor, "definition", "wait(r0");
    assert_eq!(definition["result"]["uri"], corner_uri);
    assert_eq!(covered(corner, &definition["result"]["range"]), "wait");
    assert_eq!(ask(&mut editor, "definition", "\"laws")["result"]["uri"], corner_uri);
    assert_eq!(ask(&mut editor, "definition", "lost(r0")["result"], Value::Null);
    let hover = ask(&mut editor, "hover", "lost(r0");
    assert!(hover["result"]["contents"]["value"].as_str().unwrap().contains("let lost(w: whisker)"), "{hover}");
    let refused = ask(&mut editor, "rename", "wait(r0");
    assert!(refused["error"]["message"].as_str().unwrap().contains("keeps its name"), "{refused}");

    // The library is opened, with a fault; then it is closed, and counts as it lies on the disk.
    let faulty = corner.replace("stop", "steer body along w.base at 3 mm turning 0 deg/s");
    open(&mut editor, &corner_uri, &faulty);
    assert_eq!(editor.diagnostics["uri"], corner_uri);
    assert_eq!(covered(&faulty, &editor.diagnostics["diagnostics"][0]["range"]), "3 mm");
    editor.hear();
    assert_eq!(editor.diagnostics["uri"], main_uri);
    let fault = &editor.diagnostics["diagnostics"][0];
    assert_eq!(covered(text, &fault["range"]).trim_matches('"'), "laws/corner.fsm");
    assert!(fault["message"].as_str().unwrap().contains("in line 4 of"), "{fault}");
    assert_eq!(fault["relatedInformation"][0]["location"]["uri"], corner_uri);
    assert_eq!(covered(&faulty, &fault["relatedInformation"][0]["location"]["range"]), "3 mm");
    editor.tell("textDocument/didClose", json!({"textDocument": {"uri": corner_uri}}));
    editor.hear();
    assert_eq!(editor.diagnostics, json!({"uri": corner_uri, "diagnostics": []}));
    editor.hear();
    assert_eq!(editor.diagnostics, json!({"uri": main_uri, "version": 0, "diagnostics": []}));
    assert_eq!(editor.leave().code(), Some(0));
}

/// An edit of a text: from where, how much, what instead.
type Edit = (usize, usize, String);

fn edits() -> impl Strategy<Value = Vec<Edit>> {
    let words = prop::sample::select(vec![
        "",
        "}",
        "{",
        "\n",
        ".",
        " ",
        "w.",
        "when ",
        "state X(w: whisker) {\n",
        "-> ",
        "let a = 1 mm\n",
        "\u{1f980}",
        "#",
        "\"",
        "(",
        "|",
        "param p = 3 deg\r\n",
        "\t",
        "\r",
        "set x = ",
    ]);
    prop::collection::vec((any::<usize>(), 0_usize..30, words.prop_map(str::to_owned)), 1..40)
}

#[test]
fn a_session_of_random_edits_keeps_being_answered_and_the_texts_stay_the_same() {
    let rng = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let mut runner = TestRunner::new_with_rng(
        ProptestConfig { cases: 25, failure_persistence: None, ..ProptestConfig::default() },
        rng,
    );
    runner
        .run(&edits(), |edits| {
            let mut text = THESIS.to_owned();
            let mut editor = Editor::open(&text);
            for (at, length, new_text) in edits {
                let start = text.floor_char_boundary(at % (text.len() + 1));
                let end = text.floor_char_boundary((start + length).min(text.len()));
                // The other side counts lines by all that ends one.
                let is_plain = !text.contains('\r');
                if is_plain {
                    let range = json!({"start": position_of(&text, start), "end": position_of(&text, end)});
                    text.replace_range(start..end, &new_text);
                    editor.change(json!([{"range": range, "text": new_text}]));
                } else {
                    text = text.replace('\r', "");
                    editor.change(json!([{"text": text}]));
                }
                let at = position_of(&text.replace('\r', "\n"), text.floor_char_boundary(start));
                for method in ["hover", "completion", "definition", "documentHighlight", "prepareRename"] {
                    let answer = editor.ask_at(method, &at, json!({}));
                    prop_assert!(answer.get("result").is_some() || code(&answer) == -32803, "{method}: {answer}");
                }
                editor.ask_at("rename", &at, json!({"newName": "x"}));
            }
            // Wild ranges are cut to the text.
            let wild = json!({"line": u32::MAX, "character": u32::MAX});
            let start = json!({"line": 0, "character": u32::MAX});
            editor.change(json!([{"range": {"start": wild, "end": start}, "text": "\n"}]));
            editor.rewrite(&text);
            let expected = vibrissa::policy::compile_with_warnings(&Source::new("a", text.as_str()));
            let count = expected.map_or_else(|faults| faults.len(), |compiled| compiled.warnings.len());
            prop_assert_eq!(editor.diagnostics["diagnostics"].as_array().unwrap().len(), count);
            prop_assert_eq!(editor.leave().code(), Some(0));
            Ok(())
        })
        .unwrap();
}
