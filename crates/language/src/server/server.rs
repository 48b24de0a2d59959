//! The life cycle of the server, and its open documents.

use std::collections::HashMap;
use std::io::{self, BufRead, Write};
use std::time::Duration;

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
use super::queue::Queue;
use super::transport::{self, Incoming, error};
use super::uri;

/// The time without messages after which a changed text is analysed without a request.
const QUIET_TIME: Duration = Duration::from_millis(10);

/// The manner in which a server ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ended {
    /// Shutdown and then exit, as the protocol requires.
    Orderly,
    /// Exit without shutdown, or end of the input.
    Abrupt,
}

/// The phase of a server's life cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Phase {
    Uninitialized,
    Running,
    ShutDown,
}

/// Returns the text of a file that is not open in the editor, or the reason for which there is none.
pub type Library<'l> = dyn Fn(&str) -> Result<String, String> + 'l;

/// The language server.
pub(super) struct Server<'l> {
    pub(super) phase: Phase,
    pub(super) client: Client,
    documents: HashMap<Uri, Document>,
    /// Documents that were changed or closed since their last analysis.
    changed: Vec<Uri>,
    library: &'l Library<'l>,
}

/// Serves an editor until it asks for the end or closes `input`. `library` provides the files that policies use and
/// that are not open.
///
/// # Errors
/// Reading or writing failed, because the editor has gone.
pub fn serve(input: impl BufRead + Send + 'static, output: &mut dyn Write, library: &Library<'_>) -> io::Result<Ended> {
    let mut server = Server::new(library);
    let mut queue = Queue::read_from(input)?;
    loop {
        let patience = (!server.changed.is_empty()).then_some(QUIET_TIME);
        let Some(incoming) = queue.next(patience) else {
            server.publish_changed(output)?;
            continue;
        };
        match incoming? {
            Incoming::Message(message) => {
                let (method, id, parameters) = message.into_parts();
                let parameters = parameters.unwrap_or_default();
                match id {
                    Some(id) => {
                        server.publish_changed(output)?;
                        transport::write(output, &server.request(id, &method, parameters))?;
                    }
                    None if Method::from(method.as_str()) == Method::Exit => {
                        let is_orderly = server.phase == Phase::ShutDown;
                        return Ok(if is_orderly { Ended::Orderly } else { Ended::Abrupt });
                    }
                    None if server.phase == Phase::Running => server.notification(&method, parameters),
                    None => {}
                }
            }
            Incoming::Faulty(id, error) => transport::write(output, &ResponseObject::from_error(id, error))?,
            Incoming::Nothing => {}
            Incoming::End => {
                server.publish_changed(output)?;
                return Ok(Ended::Abrupt);
            }
        }
    }
}

impl<'l> Server<'l> {
    /// A server that waits for `initialize`.
    pub(super) fn new(library: &'l Library<'l>) -> Self {
        let (phase, client) = (Phase::Uninitialized, Client::default());
        Self { phase, client, documents: HashMap::new(), changed: Vec::new(), library }
    }
}

impl Server<'_> {
    pub(super) fn request(&mut self, id: Id, method: &str, parameters: Value) -> ResponseObject {
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

    /// Handles a notification. Unintelligible ones are ignored, because nobody waits for an answer.
    pub(super) fn notification(&mut self, method: &str, parameters: Value) {
        if let Some(uri) = self.apply(method, parameters)
            && !self.changed.contains(&uri)
        {
            self.changed.push(uri);
        }
    }

    /// Handles a notification. Returns the document whose text it changed.
    fn apply(&mut self, method: &str, parameters: Value) -> Option<Uri> {
        match Method::from(method) {
            Method::TextDocumentDidOpen => {
                let opened = read::<DidOpenTextDocumentParams>(parameters)?.text_document;
                let (uri, encoding) = (opened.uri, self.client.encoding);
                let library = &mut |path: &str| self.text(path);
                let document = Document::new(uri.clone(), opened.version, opened.text, encoding, library);
                self.documents.insert(uri.clone(), document);
                Some(uri)
            }
            Method::TextDocumentDidChange => {
                let changed: DidChangeTextDocumentParams = read(parameters)?;
                let uri = changed.text_document.text_document_identifier.uri;
                let document = self.documents.get_mut(&uri)?;
                document.change(changed.text_document.version, changed.content_changes);
                Some(uri)
            }
            Method::TextDocumentDidClose => {
                let uri = read::<DidCloseTextDocumentParams>(parameters)?.text_document.uri;
                self.documents.remove(&uri)?;
                Some(uri)
            }
            _ => None,
        }
    }

    /// Analyses all changed documents and publishes their diagnostics.
    fn publish_changed(&mut self, output: &mut dyn Write) -> io::Result<()> {
        self.changed().iter().try_for_each(|message| transport::write(output, message))
    }

    /// Analyses all changed documents. The result has the messages with their diagnostics.
    pub(super) fn changed(&mut self) -> Vec<RequestObject> {
        let changed = std::mem::take(&mut self.changed);
        changed.iter().flat_map(|changed| self.diagnostics_after(changed)).collect()
    }

    /// The messages to publish after a document was changed or closed: for it, and for the documents that use it.
    fn diagnostics_after(&mut self, changed: &Uri) -> Vec<RequestObject> {
        if self.documents.get(changed).is_some_and(Document::is_stale) {
            self.analyse(changed);
        }
        let none = || PublishDiagnosticsParams { uri: changed.clone(), version: None, diagnostics: Vec::new() };
        let own = self.documents.get(changed).map(|document| diagnostics(changed, document, self.client));
        let mut messages = vec![publish(own.unwrap_or_else(none))];
        let path = uri::path(changed);
        let uses = |document: &Document| path.as_deref().is_some_and(|path| document.uses(path));
        let users = self.documents.iter().filter(|(uri, document)| *uri != changed && uses(document));
        let mut users: Vec<Uri> = users.map(|(uri, _)| uri.clone()).collect();
        users.sort_by(|a, b| a.as_ref().cmp(b.as_ref()));
        for user in users {
            self.analyse(&user);
            messages
                .extend(self.documents.get(&user).map(|document| publish(diagnostics(&user, document, self.client))));
        }
        messages
    }

    /// Analyses a document.
    fn analyse(&mut self, uri: &Uri) {
        if let Some((uri, mut document)) = self.documents.remove_entry(uri) {
            document.analyse(&mut |path: &str| self.text(path));
            self.documents.insert(uri, document);
        }
    }

    /// The text of a used file. If the file is open in the editor, its current text.
    fn text(&self, path: &str) -> Result<String, String> {
        let open = self.documents.iter().find(|(uri, _)| uri::path(uri).as_deref() == Some(path));
        match open {
            Some((_, document)) => Ok(document.source.text.clone()),
            None if uri::of_path(path).is_none() => {
                Err("save this file first: a path leads from where it is".to_owned())
            }
            None => (self.library)(path),
        }
    }

    /// Every known file: `first`, the other open files, and all files that these use. All are analysed again, so that
    /// positions across files are valid.
    pub(super) fn known_documents(&self, first: &Document) -> Vec<Document> {
        let mut open: Vec<&Document> = self.documents.values().filter(|document| document.uri != first.uri).collect();
        open.sort_by(|a, b| a.uri.as_ref().cmp(b.uri.as_ref()));
        let analyse = |uri: Uri, version, text: &str| {
            let library = &mut |path: &str| self.text(path);
            Document::new(uri, version, text.to_owned(), self.client.encoding, library)
        };
        let open = std::iter::once(first).chain(open);
        let mut known: Vec<Document> =
            open.map(|document| analyse(document.uri.clone(), document.version, &document.source.text)).collect();
        for index in 0..known.len() {
            let source = known[index].index.source().clone();
            for part in (1..source.count()).filter(|&part| source.absence(part).is_none()) {
                let name = source.part_name(part);
                // The standard library has no URI.
                if let Some(uri) = uri::of_path(name)
                    && known.iter().all(|document| document.source.name != name)
                {
                    known.push(analyse(uri, 0, source.slice(source.part_span(part))));
                }
            }
        }
        known
    }

    pub(super) fn document(&self, uri: &Uri) -> Result<&Document, Error> {
        let unknown = || error(ErrorCodes::InvalidParams, format!("`{uri}` is not open"));
        self.documents.get(uri).ok_or_else(unknown)
    }

    /// The document, and the byte of a position in it.
    pub(super) fn position(&self, asked: &TextDocumentPositionParams) -> Result<(&Document, usize), Error> {
        let document = self.document(&asked.text_document.uri)?;
        Ok((document, document.byte(asked.position)))
    }
}

fn read<T: DeserializeOwned>(parameters: Value) -> Option<T> {
    serde_json::from_value(parameters).ok()
}

fn publish(messages: PublishDiagnosticsParams) -> RequestObject {
    RequestObject::from_notification::<PublishDiagnosticsNotification>(messages)
}
