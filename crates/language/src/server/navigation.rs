//! Navigation: definitions, references, hover texts, outlines.

use gen_lsp_types::json_rpc::Error;
use gen_lsp_types::{
    Definition, DefinitionParams, DefinitionResponse, DocumentHighlight, DocumentHighlightKind,
    DocumentHighlightParams, DocumentSymbol, DocumentSymbolParams, DocumentSymbolResponse, Hover, HoverParams,
    Location, MarkupContent, MarkupKind, ReferenceParams, SymbolKind as LspSymbolKind,
};

use crate::index::{Role, SymbolKind};

use super::document::Document;
use super::server::Server;

impl Server<'_> {
    pub(super) fn hover(&self, asked: &HoverParams) -> Result<Option<Hover>, Error> {
        let (document, at) = self.position(&asked.text_document_position_params)?;
        Ok(document.index.hover(at).map(|hover| Hover {
            contents: MarkupContent { kind: MarkupKind::Markdown, value: hover.text }.into(),
            range: Some(document.range(hover.span)),
        }))
    }

    pub(super) fn definition(&self, asked: &DefinitionParams) -> Result<Option<DefinitionResponse>, Error> {
        let (document, at) = self.position(&asked.text_document_position_params)?;
        let found = document.index.definition(at).and_then(|span| document.location(span));
        Ok(found.map(|found| DefinitionResponse::Definition(Definition::Location(found))))
    }

    pub(super) fn references(&self, asked: &ReferenceParams) -> Result<Option<Vec<Location>>, Error> {
        let (document, at) = self.position(&asked.text_document_position_params)?;
        let known = self.known_documents(document);
        let asked_in = known.first().map(|document| &document.index);
        let Some(origin) = asked_in.and_then(|index| index.origin(at)) else { return Ok(Some(Vec::new())) };
        let declared = known.first().filter(|_| asked.context.include_declaration);
        let declared = declared.and_then(|document| document.location(document.index.definition(at)?));
        let used = known.iter().flat_map(|document| {
            let uses = document.index.references_to(&origin).into_iter();
            uses.filter(|&(_, role)| role != Role::Declares).filter_map(|(span, _)| document.location(span))
        });
        Ok(Some(declared.into_iter().chain(used).collect()))
    }

    pub(super) fn highlights(&self, asked: &DocumentHighlightParams) -> Result<Option<Vec<DocumentHighlight>>, Error> {
        let (document, at) = self.position(&asked.text_document_position_params)?;
        let highlight = |(span, role)| DocumentHighlight {
            range: document.range(span),
            kind: Some(match role {
                Role::Declares | Role::Writes => DocumentHighlightKind::Write,
                Role::Reads => DocumentHighlightKind::Read,
            }),
        };
        Ok(Some(document.index.references(at).into_iter().map(highlight).collect()))
    }

    pub(super) fn symbols(&self, asked: &DocumentSymbolParams) -> Result<Option<DocumentSymbolResponse>, Error> {
        let document = self.document(&asked.text_document.uri)?;
        Ok(Some(DocumentSymbolResponse::DocumentSymbolList(outline(document))))
    }
}

/// The items of a policy as a tree. Declared names are children of the item that contains them.
fn outline(document: &Document) -> Vec<DocumentSymbol> {
    let symbols = document.index.symbols();
    let mut inside: Vec<Vec<DocumentSymbol>> = symbols.iter().map(|_| Vec::new()).collect();
    let mut items = Vec::new();
    for (index, symbol) in symbols.iter().enumerate().rev() {
        let Some(kind) = outline_kind(symbol.kind) else { continue };
        let mut children = std::mem::take(&mut inside[index]);
        children.reverse();
        let (range, selection) = (document.range(symbol.whole), document.range(symbol.span));
        let detail = Some(document.index.head(symbol));
        let outlined =
            DocumentSymbol::new(symbol.name.clone(), detail, kind, None, None, range, selection, Some(children));
        match symbol.owner.and_then(|owner| inside.get_mut(owner)) {
            Some(siblings) => siblings.push(outlined),
            None => items.push(outlined),
        }
    }
    items.reverse();
    items
}

/// The nearest kind of the protocol. `None` for names that are not in an outline.
fn outline_kind(kind: SymbolKind) -> Option<LspSymbolKind> {
    Some(match kind {
        SymbolKind::Whisker | SymbolKind::Contour | SymbolKind::Field => LspSymbolKind::Field,
        SymbolKind::Parameter => LspSymbolKind::Constant,
        SymbolKind::Enumeration => LspSymbolKind::Enum,
        SymbolKind::Choice => LspSymbolKind::EnumMember,
        SymbolKind::Compound => LspSymbolKind::Struct,
        SymbolKind::Derived => LspSymbolKind::Variable,
        SymbolKind::Law => LspSymbolKind::Function,
        SymbolKind::State => LspSymbolKind::Class,
        SymbolKind::Behaviour => LspSymbolKind::Module,
        SymbolKind::Monitor => LspSymbolKind::Object,
        SymbolKind::Exit | SymbolKind::Event => LspSymbolKind::Event,
        SymbolKind::Memory => LspSymbolKind::Property,
        SymbolKind::Machine | SymbolKind::Argument | SymbolKind::Local => return None,
    })
}
