//! Requests for changes of a policy: renaming, formatting, quick fixes.

use std::collections::HashMap;
use std::fmt::Display;

use gen_lsp_types::json_rpc::Error;
use gen_lsp_types::{
    CodeAction, CodeActionKind, CodeActionParams, CodeActionResponse, DocumentFormattingParams, LspErrorCodes,
    PrepareRenameParams, PrepareRenamePlaceholder, PrepareRenameResult, RenameParams, TextEdit, Uri, WorkspaceEdit,
};

use crate::format;
use vibrissa_text::diagnostic::Span;

use super::diagnose::diagnostic;
use super::server::Server;
use super::transport::error;

impl Server<'_> {
    pub(super) fn prepare_rename(&self, asked: &PrepareRenameParams) -> Result<Option<PrepareRenameResult>, Error> {
        let (document, at) = self.position(&asked.text_document_position_params)?;
        let span = document.index.renamable(at).map_err(|refusal| refused(&refusal))?;
        let placeholder = document.source.slice(span).to_owned();
        Ok(Some(PrepareRenamePlaceholder { range: document.range(span), placeholder }.into()))
    }

    pub(super) fn rename(&self, asked: &RenameParams) -> Result<Option<WorkspaceEdit>, Error> {
        let position = &asked.text_document_position_params;
        let (document, at) = self.position(position)?;
        let known = self.known_documents(document);
        let asked_in = known.first().map_or(&document.index, |document| &document.index);
        // A refusal has its reason in the file of the request, so this file is asked before the others.
        asked_in.rename(at, &asked.new_name).map_err(|refusal| refused(&refusal))?;
        let Some(origin) = asked_in.origin(at) else { return Ok(None) };
        let mut changes = HashMap::new();
        for document in &known {
            let spans = document.index.rename_to(&origin, &asked.new_name);
            let spans = spans.map_err(|refusal| refused(&format_args!("in {}: {refusal}", document.source.name)))?;
            let edit = |span| TextEdit { range: document.range(span), new_text: asked.new_name.clone() };
            if !spans.is_empty() {
                changes.insert(document.uri.clone(), spans.into_iter().map(edit).collect());
            }
        }
        Ok(Some(WorkspaceEdit { changes: Some(changes), ..Default::default() }))
    }

    /// Formats the text. A text with syntax errors is not changed, and its diagnostics are already published.
    pub(super) fn format(&self, asked: &DocumentFormattingParams) -> Result<Option<Vec<TextEdit>>, Error> {
        let document = self.document(&asked.text_document.uri)?;
        let Ok(formatted) = format(&document.source) else { return Ok(None) };
        if formatted == document.source.text {
            return Ok(Some(Vec::new()));
        }
        let everything = Span::new(0, document.source.text.len());
        Ok(Some(vec![TextEdit { range: document.range(everything), new_text: formatted }]))
    }

    pub(super) fn actions(&self, asked: &CodeActionParams) -> Result<Option<Vec<CodeActionResponse>>, Error> {
        let uri = &asked.text_document.uri;
        let document = self.document(uri)?;
        let wanted = document.span(asked.range);
        let only = asked.context.only.as_ref();
        if only.is_some_and(|only| !only.contains(&CodeActionKind::QuickFix)) {
            return Ok(Some(Vec::new()));
        }
        let touched = document.faults.iter().filter(|fault| {
            let Span { start, end } = fault.primary.span;
            start <= wanted.end && wanted.start <= end
        });
        let actions = touched.flat_map(|fault| {
            let meant = fault.hints.iter().filter_map(|hint| hint.strip_prefix("did you mean `")?.strip_suffix("`?"));
            meant.map(|meant| {
                let edit = TextEdit { range: document.range(fault.primary.span), new_text: meant.to_owned() };
                CodeActionResponse::CodeAction(CodeAction {
                    title: format!("Write `{meant}`"),
                    kind: Some(CodeActionKind::QuickFix),
                    diagnostics: Some(diagnostic(document, fault, self.client).into_iter().collect()),
                    is_preferred: Some(true),
                    edit: Some(changes(uri, vec![edit])),
                    ..Default::default()
                })
            })
        });
        Ok(Some(actions.collect()))
    }
}

fn changes(uri: &Uri, edits: Vec<TextEdit>) -> WorkspaceEdit {
    WorkspaceEdit { changes: Some(HashMap::from([(uri.clone(), edits)])), ..Default::default() }
}

fn refused(refusal: &impl Display) -> Error {
    error(LspErrorCodes::RequestFailed, refusal.to_string())
}
