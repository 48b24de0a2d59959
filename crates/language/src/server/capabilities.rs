//! Capabilities of client and server.

use gen_lsp_types::{
    CodeActionKind, CodeActionOptions, CompletionOptions, InitializeResult, PositionEncodingKind, RenameOptions,
    ServerCapabilities, ServerInfo, TextDocumentSync, TextDocumentSyncKind, TextDocumentSyncOptions,
};
use serde_json::Value;

use super::position::Encoding;

/// The capabilities of the client that matter here.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Client {
    pub(super) encoding: Encoding,
    /// The client supports snippets with placeholders.
    pub(super) snippets: bool,
    /// The client shows related positions of a diagnostic.
    pub(super) related: bool,
}

impl Client {
    /// Reads the parameters of `initialize`. Missing capabilities are taken as unsupported.
    pub(super) fn new(parameters: &Value) -> Self {
        let can = |path: &str| parameters.pointer(&format!("/capabilities/{path}")).cloned().unwrap_or_default();
        let encodings: Vec<PositionEncodingKind> =
            serde_json::from_value(can("general/positionEncodings")).unwrap_or_default();
        Self {
            encoding: Encoding::choose(&encodings),
            snippets: can("textDocument/completion/completionItem/snippetSupport") == true,
            related: can("textDocument/publishDiagnostics/relatedInformation") == true,
        }
    }
}

/// The capabilities of the server.
pub(super) fn initialized(client: Client) -> InitializeResult {
    let capabilities = ServerCapabilities {
        position_encoding: Some(client.encoding.kind()),
        text_document_sync: Some(TextDocumentSync::Options(TextDocumentSyncOptions {
            open_close: Some(true),
            change: Some(TextDocumentSyncKind::Incremental),
            ..Default::default()
        })),
        completion_provider: Some(CompletionOptions {
            trigger_characters: Some([".", ">", " ", ":"].map(str::to_owned).to_vec()),
            ..Default::default()
        }),
        hover_provider: Some(true.into()),
        definition_provider: Some(true.into()),
        references_provider: Some(true.into()),
        document_highlight_provider: Some(true.into()),
        document_symbol_provider: Some(true.into()),
        code_action_provider: Some(
            CodeActionOptions { code_action_kinds: Some(vec![CodeActionKind::QuickFix]), ..Default::default() }.into(),
        ),
        document_formatting_provider: Some(true.into()),
        rename_provider: Some(RenameOptions { prepare_provider: Some(true), ..Default::default() }.into()),
        ..Default::default()
    };
    let version = Some(env!("CARGO_PKG_VERSION").to_owned());
    InitializeResult { capabilities, server_info: Some(ServerInfo { name: "vibrissa".to_owned(), version }) }
}
