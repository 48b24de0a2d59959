//! The life of the server, and the documents that are open.

use std::collections::HashMap;
use std::io::{self, BufRead, Write};

use gen_lsp_types::json_rpc::{Error, Id, RequestObject, ResponseObject};
use gen_lsp_types::{
    DidChangeTextDocumentParams, DidCloseTextDocumentParams, DidOpenTextDocumentParams, ErrorCodes, InitializeRequest,
    LspNotificationMethod as Method, PublishDiagnosticsNotification, PublishDiagnosticsParams, ShutdownRequest,
    TextDocumentPositionParams, Uri,
};
use serde::de::DeserializeOwned;
use serde_json::Value;

use super::capabilities::{Client, initialized};
use super::diagnose::diagnostics;
use super::document::Document;
use super::wire::{self, Incoming, error};

/// How a server ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ended {
    /// As the protocol has it: told to shut down, then to exit.
    Orderly,
    /// Told to exit without being told to shut down, or left by the editor.
    Abrupt,
}

/// Where a server is in its life.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Phase {
    Uninitialized,
    Running,
    ShutDown,
}

/// A server.
#[derive(Debug)]
pub(super) struct Server {
    phase: Phase,
    pub(super) client: Client,
    documents: HashMap<Uri, Document>,
}

/// Serves an editor until it says that it is done or its end of `input` is closed.
///
/// # Errors
/// Reading or writing failed: the editor is gone.
pub fn serve(input: &mut dyn BufRead, output: &mut dyn Write) -> io::Result<Ended> {
    let mut server = Server { phase: Phase::Uninitialized, client: Client::default(), documents: HashMap::new() };
    loop {
        match wire::read(input)? {
            Incoming::Message(message) => {
                let (method, id, parameters) = message.into_parts();
                let parameters = parameters.unwrap_or_default();
                match id {
                    Some(id) => wire::write(output, &server.request(id, &method, parameters))?,
                    None if Method::from(method.as_str()) == Method::Exit => {
                        let is_orderly = server.phase == Phase::ShutDown;
                        return Ok(if is_orderly { Ended::Orderly } else { Ended::Abrupt });
                    }
                    None if server.phase == Phase::Running => {
                        if let Some(news) = server.notification(&method, parameters) {
                            wire::write(output, &news)?;
                        }
                    }
                    None => {}
                }
            }
            Incoming::Faulty(id, error) => wire::write(output, &ResponseObject::from_error(id, error))?,
            Incoming::Nothing => {}
            Incoming::End => return Ok(Ended::Abrupt),
        }
    }
}

impl Server {
    fn request(&mut self, id: Id, method: &str, parameters: Value) -> ResponseObject {
        let refuse = |id, code, message: &str| ResponseObject::from_error(id, error(code, message));
        match (self.phase, method) {
            (Phase::Uninitialized, "initialize") => {
                self.client = Client::new(&parameters);
                self.phase = Phase::Running;
                ResponseObject::from_success::<InitializeRequest>(id, initialized(self.client))
            }
            (Phase::Uninitialized, _) => refuse(id, ErrorCodes::ServerNotInitialized, "send `initialize` first"),
            (Phase::Running, "initialize") => refuse(id, ErrorCodes::InvalidRequest, "the server is initialized"),
            (Phase::Running, "shutdown") => {
                self.phase = Phase::ShutDown;
                ResponseObject::from_success::<ShutdownRequest>(id, ())
            }
            (Phase::Running, _) => self.answer(id, method, parameters),
            (Phase::ShutDown, _) => refuse(id, ErrorCodes::InvalidRequest, "the server is shut down"),
        }
    }

    /// Takes note of what the editor says, and gives what there is to say of it. What cannot be understood is passed over:
    /// nobody waits for an answer.
    fn notification(&mut self, method: &str, parameters: Value) -> Option<RequestObject> {
        match Method::from(method) {
            Method::TextDocumentDidOpen => {
                let opened = read::<DidOpenTextDocumentParams>(parameters)?.text_document;
                let document = Document::new(opened.uri.as_ref(), opened.version, opened.text, self.client.encoding);
                let news = diagnostics(&opened.uri, &document, self.client);
                self.documents.insert(opened.uri, document);
                Some(publish(news))
            }
            Method::TextDocumentDidChange => {
                let changed: DidChangeTextDocumentParams = read(parameters)?;
                let uri = changed.text_document.text_document_identifier.uri;
                let document = self.documents.get_mut(&uri)?;
                document.change(changed.text_document.version, changed.content_changes);
                Some(publish(diagnostics(&uri, document, self.client)))
            }
            Method::TextDocumentDidClose => {
                let uri = read::<DidCloseTextDocumentParams>(parameters)?.text_document.uri;
                self.documents.remove(&uri)?;
                Some(publish(PublishDiagnosticsParams { uri, version: None, diagnostics: Vec::new() }))
            }
            _ => None,
        }
    }

    pub(super) fn document(&self, uri: &Uri) -> Result<&Document, Error> {
        let unknown = || error(ErrorCodes::InvalidParams, format!("`{uri}` is not open"));
        self.documents.get(uri).ok_or_else(unknown)
    }

    /// The document and the byte of a place in it.
    pub(super) fn place(&self, place: &TextDocumentPositionParams) -> Result<(&Document, usize), Error> {
        let document = self.document(&place.text_document.uri)?;
        Ok((document, document.byte(place.position)))
    }
}

fn read<T: DeserializeOwned>(parameters: Value) -> Option<T> {
    serde_json::from_value(parameters).ok()
}

fn publish(news: PublishDiagnosticsParams) -> RequestObject {
    RequestObject::from_notification::<PublishDiagnosticsNotification>(news)
}
