//! A language server without a transport, for a program that has its editor beside it.

use super::server::{Library, Phase, Server};
use super::transport::Incoming;

/// A language server whose messages are texts without headers. Documents are analysed as soon as they change, and no file can be read.
pub struct Session {
    server: Server<'static>,
}

impl Session {
    /// A server that waits for `initialize`. `absent` gives the error of a policy that uses a file.
    #[must_use]
    pub fn new(absent: &'static Library<'static>) -> Self {
        Self { server: Server::new(absent) }
    }

    /// Handles a message of the editor. The result has the messages for the editor, in their order.
    pub fn handle(&mut self, message: &str) -> Vec<String> {
        match super::transport::message(message.as_bytes()) {
            Incoming::Message(message) => {
                let (method, id, parameters) = message.into_parts();
                let parameters = parameters.unwrap_or_default();
                match id {
                    Some(id) => text(&self.server.request(id, &method, parameters)).into_iter().collect(),
                    None if self.server.phase == Phase::Running => {
                        self.server.notification(&method, parameters);
                        self.server.changed().iter().filter_map(text).collect()
                    }
                    None => Vec::new(),
                }
            }
            Incoming::Faulty(id, error) => {
                text(&gen_lsp_types::json_rpc::ResponseObject::from_error(id, error)).into_iter().collect()
            }
            Incoming::Nothing | Incoming::End => Vec::new(),
        }
    }
}

/// A message as text. Those of the server always have one.
fn text(message: &impl serde::Serialize) -> Option<String> {
    serde_json::to_string(message).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_changed_text_has_its_diagnostics_at_once_and_what_is_no_message_is_refused() {
        let mut session = Session::new(&|_| Err("there are no files".to_owned()));
        assert!(session.handle("{").join("").contains("error"));
        let opened = r#"{"jsonrpc":"2.0","method":"textDocument/didOpen","params":{"textDocument":{"uri":"file:///a.fsm","languageId":"fsm","version":1,"text":"machine a  initial B"}}}"#;
        assert_eq!(session.handle(opened), Vec::<String>::new());
        let answers = session.handle(r#"{"jsonrpc":"2.0","id":1,"method":"initialize","params":{"capabilities":{}}}"#);
        assert!(answers.join("").contains("hoverProvider"), "{answers:?}");
        let told = session.handle(opened).join("");
        assert!(told.contains("publishDiagnostics") && told.contains("P0"), "{told}");
    }
}
