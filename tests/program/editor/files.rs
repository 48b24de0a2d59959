//! Policies of several files.

use std::collections::BTreeMap;

use serde_json::{Value, json};
use vibrissa::diagnostic::Source;
use vibrissa::policy::{compile, gather};

use super::answer::THESIS;
use super::client::{Editor, covered, edited, position};

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
    let refused = ask(&mut editor, "rename", "lost(r0");
    assert!(refused["error"]["message"].as_str().unwrap().contains("belongs to the standard library"), "{refused}");

    // The library is opened, with a fault; then it is closed, and counts as it lies on the disk.
    let faulty = corner.replace("stop", "steer body along w.tip_base at 3 mm turning 0 deg/s");
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

/// Files that use one another, by their names; the first two are open in the editor.
const FILES: [(&str, &str); 4] = [
    (
        "main.fsm",
        "machine m\nuse \"laws/corner.fsm\" (wait)\nuse \"laws/both.fsm\"\nuse std.guards (lost)\nwhisker r0\ninitial S\nstate S {\n  \
         do wait(r0)\n  do twice(r0)\n  when lost(r0) -> Failure(\"lost\")\n}\n",
    ),
    (
        "other.fsm",
        "machine o\nuse \"laws/corner.fsm\"\nwhisker r0\ninitial S\nstate S {\n  var taken = 0 s\n  set taken = time\n  do wait(r0)\n  \
         when taken > 1 s -> Failure(\"done\")\n}\n",
    ),
    ("laws/corner.fsm", "library corner\n\nlaw wait(w: whisker) { stop }\n"),
    ("laws/both.fsm", "library both\nuse \"corner.fsm\"\nlaw twice(w: whisker) {\n  do wait(w)\n  do wait(w)\n}\n"),
];

/// An editor with the first two of the files open, and the address of the folder of all.
fn across(folder: &str) -> (Editor, String) {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(folder);
    std::fs::create_dir_all(folder.join("laws")).unwrap();
    let root = format!("file://{}", folder.display());
    let mut editor = Editor::open(THESIS);
    for (name, text) in FILES {
        std::fs::write(folder.join(name), text).unwrap();
    }
    for (name, text) in &FILES[..2] {
        let item = json!({"uri": format!("{root}/{name}"), "languageId": "fsm", "version": 0, "text": text});
        editor.tell("textDocument/didOpen", json!({"textDocument": item}));
        editor.hear();
        assert_eq!(editor.diagnostics["diagnostics"], json!([]), "{name}");
    }
    (editor, root)
}

fn text_of(name: &str) -> &'static str {
    FILES.iter().find(|(known, _)| *known == name).unwrap().1
}

/// What the server answers about the first `part` of a file.
fn ask(editor: &mut Editor, root: &str, file: &str, method: &str, (part, new_name): (&str, &str)) -> Value {
    let at = position(text_of(file), part, 0);
    let context = json!({"includeDeclaration": true});
    let asked = json!({
        "textDocument": {"uri": format!("{root}/{file}")}, "position": at, "newName": new_name, "context": context,
    });
    editor.ask(&format!("textDocument/{method}"), asked)
}

#[test]
fn references_lead_to_every_file_that_is_open_or_used() {
    let (mut editor, root) = across("lsp_references");
    for (file, part) in [("main.fsm", "wait(r0"), ("main.fsm", "wait)"), ("other.fsm", "wait(r0")] {
        let answer = ask(&mut editor, &root, file, "references", (part, ""));
        let mut found: BTreeMap<String, usize> = BTreeMap::new();
        for place in answer["result"].as_array().unwrap() {
            let name = place["uri"].as_str().unwrap().strip_prefix(&format!("{root}/")).unwrap().to_owned();
            assert_eq!(covered(text_of(&name), &place["range"]), "wait");
            *found.entry(name).or_default() += 1;
        }
        let expected = [("laws/both.fsm", 2), ("laws/corner.fsm", 1), ("main.fsm", 2), ("other.fsm", 1)];
        assert_eq!(found, expected.map(|(name, count)| (name.to_owned(), count)).into(), "{file}");
    }
    // What the standard library gives is declared in no file, and used in one.
    let standard = ask(&mut editor, &root, "main.fsm", "references", ("lost(r0", ""));
    assert_eq!(standard["result"].as_array().unwrap().len(), 2);
    // One name may stand for two things in two files.
    let whisker = ask(&mut editor, &root, "main.fsm", "references", ("r0\n", ""));
    assert!(whisker["result"].as_array().unwrap().iter().all(|place| place["uri"] == format!("{root}/main.fsm")));
    assert_eq!(editor.leave().code(), Some(0));
}

#[test]
fn a_name_is_changed_in_every_file_that_is_known_and_the_machines_stay_the_same() {
    let (mut editor, root) = across("lsp_rename");
    let prepared = ask(&mut editor, &root, "main.fsm", "prepareRename", ("wait(r0", ""));
    assert_eq!(prepared["result"]["placeholder"], "wait");
    let renamed = ask(&mut editor, &root, "main.fsm", "rename", ("wait(r0", "pause"));
    let changes = renamed["result"]["changes"].as_object().unwrap();
    assert_eq!(changes.len(), 4, "{renamed}");
    let after: BTreeMap<&str, String> =
        FILES.iter().map(|&(name, text)| (name, edited(text, &changes[&format!("{root}/{name}")]))).collect();
    assert!(after.values().all(|text| !text.contains("wait") && text.contains("pause")), "{after:?}");
    for machine in ["main.fsm", "other.fsm"] {
        let program = |text: &dyn Fn(&str) -> String| {
            compile(&gather(&Source::new(machine, text(machine)), &mut |path| Ok(text(path)))).unwrap()
        };
        assert_eq!(program(&|name| after[name].clone()), program(&|name| text_of(name).to_owned()));
    }
    assert_eq!(editor.leave().code(), Some(0));
}

#[test]
fn a_name_that_another_file_needs_as_it_is_keeps_it_and_says_which() {
    let (mut editor, root) = across("lsp_refusals");
    let mut refused = |part: &str, new_name: &str, expected: &[&str]| {
        let answer = ask(&mut editor, &root, "main.fsm", "rename", (part, new_name));
        let message = answer["error"]["message"].as_str().unwrap_or_else(|| panic!("{answer}"));
        assert!(expected.iter().all(|expected| message.contains(expected)), "{message}");
    };
    refused("lost(r0", "x", &["`lost` belongs to the standard library (`std.guards`)"]);
    refused("lost)", "x", &["belongs to the standard library"]);
    refused("wait(r0", "taken", &["other.fsm", "`taken` is already declared in line 6"]);
    refused("wait(r0", "twice", &["`twice`", "choose another name"]);
    refused("wait(r0", "state", &["`state` is reserved"]);
    // A file with a fault may have more places than can be found.
    let uri = format!("{root}/other.fsm");
    let broken = text_of("other.fsm").replace("do wait(r0)", "do wait(r0");
    let change = json!({"textDocument": {"uri": uri, "version": 1}, "contentChanges": [{"text": broken}]});
    editor.tell("textDocument/didChange", change);
    editor.hear();
    let answer = ask(&mut editor, &root, "main.fsm", "rename", ("wait(r0", "pause"));
    let message = answer["error"]["message"].as_str().unwrap();
    assert!(message.contains("other.fsm") && message.contains("syntax error"), "{message}");
    assert_eq!(editor.leave().code(), Some(0));
}
