//! Completion.

use gen_lsp_types::json_rpc::Error;
use gen_lsp_types::{
    CompletionItem, CompletionItemKind, CompletionParams, CompletionResponse, InsertTextFormat, MarkupContent,
    MarkupKind, Range, TextEdit,
};

use crate::index::{Candidate, CandidateKind, SymbolKind};

use super::server::Server;

impl Server<'_> {
    pub(super) fn complete(&self, asked: &CompletionParams) -> Result<Option<CompletionResponse>, Error> {
        let (document, at) = self.position(&asked.text_document_position_params)?;
        let (typed, candidates) = document.index.candidates(at);
        let range = document.range(typed);
        let items = candidates.into_iter().map(|candidate| item(candidate, range, self.client.snippets));
        Ok(Some(items.collect::<Vec<_>>().into()))
    }
}

fn item(candidate: Candidate, range: Range, snippets: bool) -> CompletionItem {
    let is_snippet = snippets && candidate.snippet != candidate.label;
    let new_text = if is_snippet { candidate.snippet } else { candidate.label.clone() };
    let documentation = MarkupContent { kind: MarkupKind::Markdown, value: candidate.meaning };
    CompletionItem {
        label: candidate.label,
        kind: Some(kind(candidate.kind)),
        detail: Some(candidate.detail).filter(|detail| !detail.is_empty()),
        documentation: Some(documentation).filter(|text| !text.value.is_empty()).map(Into::into),
        insert_text_format: Some(if is_snippet { InsertTextFormat::Snippet } else { InsertTextFormat::PlainText }),
        text_edit: Some(TextEdit { range, new_text }.into()),
        ..Default::default()
    }
}

/// The nearest kind of the protocol.
fn kind(kind: CandidateKind) -> CompletionItemKind {
    match kind {
        CandidateKind::Keyword => CompletionItemKind::Keyword,
        CandidateKind::Function => CompletionItemKind::Function,
        CandidateKind::Member | CandidateKind::Symbol(SymbolKind::Field) => CompletionItemKind::Field,
        CandidateKind::Type | CandidateKind::Symbol(SymbolKind::Compound) => CompletionItemKind::Struct,
        CandidateKind::Module | CandidateKind::Family | CandidateKind::Symbol(SymbolKind::Behaviour) => {
            CompletionItemKind::Module
        }
        CandidateKind::Unit => CompletionItemKind::Unit,
        CandidateKind::Symbol(SymbolKind::Enumeration) => CompletionItemKind::Enum,
        CandidateKind::Symbol(SymbolKind::Choice) => CompletionItemKind::EnumMember,
        CandidateKind::Symbol(SymbolKind::State) => CompletionItemKind::Class,
        CandidateKind::Symbol(SymbolKind::Exit | SymbolKind::Event) => CompletionItemKind::Event,
        CandidateKind::Symbol(SymbolKind::Law) => CompletionItemKind::Method,
        CandidateKind::Symbol(SymbolKind::Parameter | SymbolKind::Machine) => CompletionItemKind::Constant,
        CandidateKind::Symbol(SymbolKind::Memory) => CompletionItemKind::Property,
        CandidateKind::Symbol(_) => CompletionItemKind::Variable,
    }
}
