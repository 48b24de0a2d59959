//! A session from the first word to the last.

use std::process::Command;

use serde_json::json;
use vibrissa::diagnostic::Source;
use vibrissa::policy::compile;

use super::answer::{BANG, THESIS, labels};
use super::client::{Editor, URI, covered, edited, position};

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
    assert!(labels(&members).contains(&"base_angle") && !labels(&members).contains(&"clamp"), "{members}");

    // `lost` is the name of a parameter, and a word of comments and of the reasons of failures.
    let rename = editor.ask_at("rename", &position(THESIS, "for lost", 0), json!({"newName": "gone"}));
    assert!(rename["error"]["message"].as_str().unwrap().contains("a name of the language"), "{rename}");
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
