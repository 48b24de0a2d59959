//! Messages as the protocol has them, and as it has not.

use serde_json::{Value, json};

use super::answer::{THESIS, code};
use super::client::{Editor, URI, position};

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
fn of_changes_that_wait_the_last_is_looked_at() {
    let mut editor = Editor::open(THESIS);
    let changed = |index: usize| THESIS.replacen("whisker r0, l0", &format!("whisker r0, l{index}"), 1);
    let change = |index: usize, text: &str| {
        let document = json!({"uri": URI, "version": index});
        let parameters = json!({"textDocument": document, "contentChanges": [{"text": text}]});
        json!({"jsonrpc": "2.0", "method": "textDocument/didChange", "params": parameters})
    };
    let mut bytes = Vec::new();
    for index in 1..=1000 {
        let body = change(index, &changed(index)).to_string();
        bytes.extend(format!("Content-Length: {}\r\n\r\n{body}", body.len()).into_bytes());
    }
    editor.send_bytes(&bytes);
    let asked = json!({"textDocument": {"uri": URI}});
    editor.send(&json!({"jsonrpc": "2.0", "id": 1, "method": "textDocument/documentSymbol", "params": asked}));
    let mut told = 0;
    let answer = loop {
        let message = editor.receive();
        if message["id"] == 1 {
            break message;
        }
        told += 1;
    };
    assert!(answer.to_string().contains("l1000"), "{answer}");
    assert_eq!(editor.diagnostics["version"], 1000);
    // One; more where what sends them is kept waiting.
    assert!(told < 100, "{told} times");
    assert_eq!(editor.leave().code(), Some(0));
}

#[test]
fn a_request_that_is_taken_back_while_it_waits_is_refused() {
    let mut editor = Editor::open(THESIS);
    let asked = json!({"textDocument": {"uri": URI}, "position": position(THESIS, "speed", 0)});
    let hover = |id: &str| json!({"jsonrpc": "2.0", "id": id, "method": "textDocument/hover", "params": asked});
    let document = json!({"uri": URI, "version": 1});
    let change = json!({"textDocument": document, "contentChanges": [{"text": THESIS}]});
    let change = json!({"jsonrpc": "2.0", "method": "textDocument/didChange", "params": change});
    let cancel = json!({"jsonrpc": "2.0", "method": "$/cancelRequest", "params": {"id": "second"}});
    // Each change makes the server compile for the request behind it. The second request waits for all of them, so that it
    // is taken back before its turn even if the server reads slowly.
    let waited_for = (0..20).flat_map(|_| [change.clone(), hover("first")]);
    let messages: Vec<Value> = waited_for.chain([hover("second"), cancel, hover("third")]).collect();
    let frame = |message: &Value| format!("Content-Length: {}\r\n\r\n{message}", message.to_string().len());
    editor.send_bytes(messages.iter().map(frame).collect::<String>().as_bytes());
    let mut answers = std::iter::repeat_with(|| editor.receive()).filter(|message| message.get("id").is_some());
    for first in answers.by_ref().take(20) {
        assert!(first["id"] == "first" && first["result"].is_object(), "{first}");
    }
    let [second, third] = std::array::from_fn(|_| answers.next().unwrap());
    assert!(second["id"] == "second" && code(&second) == -32800, "{second}");
    assert!(third["id"] == "third" && third["result"].is_object(), "{third}");
    drop(answers);
    assert_eq!(editor.leave().code(), Some(0));
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
