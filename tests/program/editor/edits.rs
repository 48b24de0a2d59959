//! Random edits.

use proptest::prelude::*;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};
use serde_json::json;
use vibrissa::diagnostic::Source;

use super::answer::{THESIS, code};
use super::client::{Editor, position_of};

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
