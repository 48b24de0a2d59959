//! Framing of messages: JSON after a header with its length.

use std::io::{self, BufRead, Read, Write};

use gen_lsp_types::ErrorCodes;
use gen_lsp_types::json_rpc::{Error, Id, RequestObject};
use serde::Serialize;
use serde_json::Value;

/// The maximum size of a message (bytes). A policy has at most 256 KiB, but an editor may send other files.
const MESSAGE_LIMIT: usize = 64 << 20;
/// The maximum length of a header line (bytes).
const LINE_LIMIT: u64 = 4096;

/// A message from the editor.
#[derive(Debug, PartialEq)]
pub(super) enum Incoming {
    Message(RequestObject),
    /// A request that must be answered with an error.
    Faulty(Id, Error),
    /// A message that needs no answer.
    Nothing,
    /// The end of the input.
    End,
}

/// Reads the next message. Text before a header is ignored.
pub(super) fn read(input: &mut dyn BufRead) -> io::Result<Incoming> {
    let Some(length) = read_header(input)? else { return Ok(Incoming::End) };
    if length > MESSAGE_LIMIT {
        io::copy(&mut input.take(length as u64), &mut io::sink())?;
        let message = format!("the message is longer than {} MiB", MESSAGE_LIMIT >> 20);
        return Ok(Incoming::Faulty(Id::Null, error(ErrorCodes::InvalidRequest, message)));
    }
    let mut body = Vec::new();
    input.take(length as u64).read_to_end(&mut body)?;
    Ok(if body.len() < length { Incoming::End } else { message(&body) })
}

/// Reads a header up to its empty line. Returns the length of the message.
fn read_header(input: &mut dyn BufRead) -> io::Result<Option<usize>> {
    let mut length = None;
    let mut line = Vec::new();
    loop {
        line.clear();
        if input.take(LINE_LIMIT).read_until(b'\n', &mut line)? == 0 {
            return Ok(None);
        }
        let field = String::from_utf8_lossy(&line);
        match field.trim().split_once(':') {
            Some((name, value)) if name.eq_ignore_ascii_case("Content-Length") => length = value.trim().parse().ok(),
            None if field.trim().is_empty() && length.is_some() => return Ok(length),
            _ => {}
        }
    }
}

/// The message of a body.
pub(super) fn message(body: &[u8]) -> Incoming {
    let value: Value = match serde_json::from_slice(body) {
        Ok(value) => value,
        Err(fault) => return Incoming::Faulty(Id::Null, error(ErrorCodes::ParseError, fault.to_string())),
    };
    if value.get("method").is_none() && (value.get("result").is_some() || value.get("error").is_some()) {
        // A response without a request.
        return Incoming::Nothing;
    }
    let id = value.get("id").cloned().and_then(|id| serde_json::from_value(id).ok()).unwrap_or(Id::Null);
    match serde_json::from_value(value) {
        Ok(request) => Incoming::Message(request),
        Err(fault) => Incoming::Faulty(id, error(ErrorCodes::InvalidRequest, fault.to_string())),
    }
}

/// Writes a message.
pub(super) fn write(output: &mut dyn Write, message: &impl Serialize) -> io::Result<()> {
    let body = serde_json::to_string(message)?;
    write!(output, "Content-Length: {}\r\n\r\n{body}", body.len())?;
    output.flush()
}

pub(super) fn error(code: impl Into<i32>, message: impl Into<String>) -> Error {
    Error { code: ErrorCodes::from(code.into()), message: message.into(), data: None }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_all(mut bytes: &[u8]) -> Vec<Incoming> {
        let mut all = Vec::new();
        while let Ok(incoming) = read(&mut bytes) {
            if incoming == Incoming::End {
                break;
            }
            all.push(incoming);
        }
        all
    }

    fn framed(body: &str) -> String {
        format!("Content-Length: {}\r\n\r\n{body}", body.len())
    }

    #[test]
    fn what_is_no_message_is_passed_over_or_refused_and_the_next_is_read() {
        let good = framed(r#"{"jsonrpc": "2.0", "id": 1, "method": "shutdown"}"#);
        let garbage = "x".repeat(10_000);
        for before in ["", "\n\n", "hello\r\n", "Content-Length: many\r\n\r\n", "Content-Type: x\r\n", &garbage] {
            let read = read_all(format!("{before}\n{good}").as_bytes());
            assert!(
                matches!(read.as_slice(), [Incoming::Message(request)] if request.method() == "shutdown"),
                "{before}"
            );
        }
        for before in ["{", "[]", "3", r#"{"jsonrpc": "1.0", "id": 2, "method": "x"}"#, r#"{"id": 2}"#] {
            let read = read_all(format!("{}{good}", framed(before)).as_bytes());
            assert!(matches!(read.as_slice(), [Incoming::Faulty(..), Incoming::Message(_)]), "{before}: {read:?}");
        }
    }

    #[test]
    fn a_length_that_is_not_true_ends_the_input_without_taking_memory() {
        for length in ["10", "99999999", "18446744073709551615"] {
            let read = read_all(format!("Content-Length: {length}\r\n\r\n{{}}").as_bytes());
            assert!(read.len() <= 1, "{read:?}");
        }
    }

    #[test]
    fn what_is_written_can_be_read() {
        let mut wire = Vec::new();
        let sent = serde_json::json!({"jsonrpc": "2.0", "id": "\u{e4}", "method": "m", "params": {"a": 1}});
        assert!(write(&mut wire, &sent).is_ok());
        let read = read_all(&wire);
        assert!(
            matches!(read.as_slice(), [Incoming::Message(request)] if request.id() == Some(&Id::String("\u{e4}".into())))
        );
    }
}
