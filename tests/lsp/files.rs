//! Policies of several files.

use serde_json::{Value, json};

use super::answer::THESIS;
use super::editor::{Editor, covered, position};

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
