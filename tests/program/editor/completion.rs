//! What can be written at a place.

use serde_json::json;

use super::answer::THESIS;
use super::client::{Editor, covered, position};

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
    let ends = [2, 3].map(|index| &targets["result"][index]["textEdit"]["newText"]);
    assert_eq!(ends, ["Success(\"${1:reason}\")", "Failure(\"${1:reason}\")"]);
}
