//! Dispatch of requests.

use gen_lsp_types::json_rpc::{Error, Id, ResponseObject};
use gen_lsp_types::{
    CodeActionRequest, CompletionRequest, DefinitionRequest, DocumentFormattingRequest, DocumentHighlightRequest,
    DocumentSymbolRequest, ErrorCodes, HoverRequest, LspRequestMethod as Method, PrepareRenameRequest,
    ReferencesRequest, RenameRequest, Request,
};
use serde_json::Value;

use super::server::Server;
use super::transport::error;

impl Server<'_> {
    /// Answers a request about documents.
    pub(super) fn answer(&self, id: Id, method: &str, parameters: Value) -> ResponseObject {
        match Method::from(method) {
            Method::TextDocumentHover => call::<HoverRequest>(id, parameters, |asked| self.hover(&asked)),
            Method::TextDocumentDefinition => {
                call::<DefinitionRequest>(id, parameters, |asked| self.definition(&asked))
            }
            Method::TextDocumentReferences => {
                call::<ReferencesRequest>(id, parameters, |asked| self.references(&asked))
            }
            Method::TextDocumentDocumentHighlight => {
                call::<DocumentHighlightRequest>(id, parameters, |asked| self.highlights(&asked))
            }
            Method::TextDocumentDocumentSymbol => {
                call::<DocumentSymbolRequest>(id, parameters, |asked| self.symbols(&asked))
            }
            Method::TextDocumentCompletion => call::<CompletionRequest>(id, parameters, |asked| self.complete(&asked)),
            Method::TextDocumentPrepareRename => {
                call::<PrepareRenameRequest>(id, parameters, |asked| self.prepare_rename(&asked))
            }
            Method::TextDocumentRename => call::<RenameRequest>(id, parameters, |asked| self.rename(&asked)),
            Method::TextDocumentFormatting => {
                call::<DocumentFormattingRequest>(id, parameters, |asked| self.format(&asked))
            }
            Method::TextDocumentCodeAction => call::<CodeActionRequest>(id, parameters, |asked| self.actions(&asked)),
            _ => {
                let message = format!("the server does not know `{method}`");
                ResponseObject::from_error(id, error(ErrorCodes::MethodNotFound, message))
            }
        }
    }
}

fn call<R: Request>(
    id: Id,
    parameters: Value,
    answer: impl FnOnce(R::Params) -> Result<R::Result, Error>,
) -> ResponseObject {
    let asked = serde_json::from_value(parameters).map_err(|fault| error(ErrorCodes::InvalidParams, fault.to_string()));
    match asked.and_then(answer) {
        Ok(result) => ResponseObject::from_success::<R>(id, result),
        Err(error) => ResponseObject::from_error(id, error),
    }
}
