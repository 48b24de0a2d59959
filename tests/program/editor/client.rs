//! An editor: the other side of the language server's protocol.
#![allow(dead_code, unreachable_pub, reason = "every test file uses a part of it")]

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

/// The document that the editor has open.
pub const URI: &str = "file:///policies/thesis.fsm";
/// An answer is due within this time, even on a machine that does much else.
const PATIENCE: Duration = Duration::from_mins(1);

pub struct Editor {
    child: Child,
    input: Option<ChildStdin>,
    messages: Receiver<Value>,
    asked: i64,
    version: i64,
    /// What the server has said of the document last.
    pub diagnostics: Value,
}

impl Editor {
    /// An editor before it has said anything.
    pub fn new() -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_vibrissa"));
        let mut child = command.arg("lsp").stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
        let (input, mut output) = (child.stdin.take(), BufReader::new(child.stdout.take().unwrap()));
        let (sender, messages) = channel();
        thread::spawn(move || {
            while let Some(message) = read(&mut output) {
                if sender.send(message).is_err() {
                    break;
                }
            }
        });
        Self { child, input, messages, asked: 0, version: 0, diagnostics: Value::Null }
    }

    /// An editor that has introduced itself, with what it can do.
    pub fn with(capabilities: &Value) -> (Self, Value) {
        let mut editor = Self::new();
        let answer =
            editor.ask("initialize", json!({"processId": null, "rootUri": null, "capabilities": capabilities}));
        editor.tell("initialized", json!({}));
        (editor, answer["result"]["capabilities"].clone())
    }

    /// An editor that can do what editors usually can, with a text open.
    pub fn open(text: &str) -> Self {
        let capabilities = json!({"textDocument": {
            "completion": {"completionItem": {"snippetSupport": true}},
            "publishDiagnostics": {"relatedInformation": true},
        }});
        let mut editor = Self::with(&capabilities).0;
        editor.tell(
            "textDocument/didOpen",
            json!({"textDocument": {"uri": URI, "languageId": "fsm", "version": 0, "text": text}}),
        );
        editor.hear();
        editor
    }

    pub fn send_bytes(&mut self, bytes: &[u8]) {
        // A server that has ended does not read.
        let _ = self.input.as_mut().unwrap().write_all(bytes);
    }

    pub fn send(&mut self, message: &Value) {
        let body = message.to_string();
        self.send_bytes(format!("Content-Length: {}\r\n\r\n{body}", body.len()).as_bytes());
    }

    pub fn tell(&mut self, method: &str, parameters: Value) {
        self.send(&json!({"jsonrpc": "2.0", "method": method, "params": parameters}));
    }

    /// The next message.
    pub fn receive(&mut self) -> Value {
        let message = self.messages.recv_timeout(PATIENCE).expect("the server says nothing");
        if message["method"] == "textDocument/publishDiagnostics" {
            self.diagnostics = message["params"].clone();
        }
        message
    }

    /// Waits until the server has said something of the document.
    pub fn hear(&mut self) {
        while self.receive()["method"] != "textDocument/publishDiagnostics" {}
    }

    /// The answer to a request.
    pub fn ask(&mut self, method: &str, parameters: Value) -> Value {
        self.asked += 1;
        self.send(&json!({"jsonrpc": "2.0", "id": self.asked, "method": method, "params": parameters}));
        loop {
            let message = self.receive();
            if message["id"] == self.asked && message.get("method").is_none() {
                return message;
            }
        }
    }

    /// What the server answers to a question about a place in the document, with more to the question.
    pub fn ask_at(&mut self, method: &str, position: &Value, more: Value) -> Value {
        let mut parameters = json!({"textDocument": {"uri": URI}, "position": position});
        parameters.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        self.ask(&format!("textDocument/{method}"), parameters)
    }

    /// Changes the document, and waits for what the server says of it.
    pub fn change(&mut self, changes: Value) {
        self.version += 1;
        self.tell(
            "textDocument/didChange",
            json!({"textDocument": {"uri": URI, "version": self.version}, "contentChanges": changes}),
        );
        self.hear();
        assert_eq!(self.diagnostics["version"], self.version);
    }

    /// Gives the document another text.
    pub fn rewrite(&mut self, text: &str) {
        self.change(json!([{"text": text}]));
    }

    /// Ends the server as the protocol has it.
    pub fn leave(mut self) -> ExitStatus {
        let answer = self.ask("shutdown", Value::Null);
        assert!(answer["result"].is_null() && answer.get("error").is_none(), "{answer}");
        self.tell("exit", Value::Null);
        self.ended()
    }

    /// Says nothing more, and waits for the server to end.
    pub fn ended(mut self) -> ExitStatus {
        self.input = None;
        let start = Instant::now();
        loop {
            match self.child.try_wait().unwrap() {
                Some(status) => return status,
                None if start.elapsed() > PATIENCE => panic!("the server does not end"),
                None => thread::sleep(Duration::from_millis(5)),
            }
        }
    }
}

impl Drop for Editor {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn read(output: &mut impl BufRead) -> Option<Value> {
    let mut length = 0;
    loop {
        let mut line = String::new();
        if output.read_line(&mut line).ok()? == 0 {
            return None;
        }
        match line.trim().split_once(": ") {
            Some(("Content-Length", value)) => length = value.parse().unwrap(),
            _ if line.trim().is_empty() => break,
            _ => {}
        }
    }
    let mut body = vec![0; length];
    output.read_exact(&mut body).ok()?;
    Some(serde_json::from_slice(&body).unwrap())
}

/// The position of the `nth` occurrence of `part` in a text, in UTF-16.
pub fn position(text: &str, part: &str, nth: usize) -> Value {
    let at = text.match_indices(part).nth(nth).unwrap_or_else(|| panic!("no {part}")).0;
    position_of(text, at)
}

/// The position of a byte, in UTF-16.
pub fn position_of(text: &str, at: usize) -> Value {
    let line = text[..at].rsplit('\n').next().unwrap();
    json!({"line": text[..at].matches('\n').count(), "character": line.encode_utf16().count()})
}

/// The byte at a position in UTF-16.
pub fn byte_of(text: &str, position: &Value) -> usize {
    let number = |name: &str| usize::try_from(position[name].as_u64().unwrap()).unwrap();
    let start: usize = text.split_inclusive('\n').take(number("line")).map(str::len).sum();
    let mut left = number("character");
    let letters = text[start..].char_indices().find(|&(_, letter)| {
        let is_there = left == 0 || letter == '\n';
        left = left.saturating_sub(letter.len_utf16());
        is_there
    });
    letters.map_or(text.len(), |(at, _)| start + at)
}

/// The part of a text that a range covers.
pub fn covered<'t>(text: &'t str, range: &Value) -> &'t str {
    &text[byte_of(text, &range["start"])..byte_of(text, &range["end"])]
}

/// A text after edits, which do not overlap.
pub fn edited(text: &str, edits: &Value) -> String {
    let place = |edit: &Value| {
        let range = &edit["range"];
        (byte_of(text, &range["start"]), byte_of(text, &range["end"]), edit["newText"].as_str().unwrap().to_owned())
    };
    let mut edits: Vec<_> = edits.as_array().unwrap().iter().map(place).collect();
    edits.sort();
    let mut edited = text.to_owned();
    for (start, end, new_text) in edits.into_iter().rev() {
        edited.replace_range(start..end, &new_text);
    }
    edited
}
