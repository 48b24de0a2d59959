//! What the server answers, and texts to ask about.

use serde_json::Value;

pub(crate) const THESIS: &str = include_str!("../../fixtures/editor/thesis.fsm");
pub(crate) const BANG: &str = include_str!("../../../policies/bang.fsm");

pub(crate) fn labels(answer: &Value) -> Vec<&str> {
    answer["result"].as_array().unwrap().iter().map(|item| item["label"].as_str().unwrap()).collect()
}

pub(crate) fn code(answer: &Value) -> &Value {
    &answer["error"]["code"]
}
