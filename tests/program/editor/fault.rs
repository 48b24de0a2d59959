//! Faults, warnings, and what mends them.

use serde_json::json;

use super::answer::{THESIS, labels};
use super::client::{Editor, URI, edited, position};

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
    assert!(fault["message"].as_str().unwrap().contains(&format!("line {line}: declared here")), "{fault}");
    let targets = editor.ask_at("completion", &position(&text, "Swiping\n", 0), json!({}));
    assert_eq!(labels(&targets), ["Exploring", "Swiping", "Success", "Failure"]);
    for item in targets["result"].as_array().unwrap() {
        assert_eq!((&item["insertTextFormat"], &item["textEdit"]["newText"]), (&json!(1), &item["label"]));
    }
}
