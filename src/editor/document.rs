//! A policy that is open in the editor.

use gen_lsp_types::{self as lsp, TextDocumentContentChangeEvent};

use crate::diagnostic::{Diagnostic, Source, Span};
use crate::policy::compile_with_warnings;
use crate::policy::index::Index;

use super::position::{Encoding, Lines};

/// A text and all that is known of it.
#[derive(Debug)]
pub(super) struct Document {
    pub(super) source: Source,
    /// The editor's number of the text.
    pub(super) version: i32,
    pub(super) index: Index,
    /// Its faults, or what it is warned of.
    pub(super) faults: Vec<Diagnostic>,
    lines: Lines,
    encoding: Encoding,
}

impl Document {
    pub(super) fn new(name: &str, version: i32, text: String, encoding: Encoding) -> Self {
        let source = Source::new(name, text);
        let (lines, index, faults) = (Lines::new(&source.text), Index::new(&source, None), faults(&source));
        Self { source, version, index, faults, lines, encoding }
    }

    /// Carries out changes one after the other, and looks at the text anew.
    pub(super) fn change(&mut self, version: i32, changes: Vec<TextDocumentContentChangeEvent>) {
        let mut text = std::mem::take(&mut self.source.text);
        for change in changes {
            match change {
                TextDocumentContentChangeEvent::TextDocumentContentChangePartial(change) => {
                    let Span { start, end } = Lines::new(&text).span(&text, change.range, self.encoding);
                    text.replace_range(start..end, &change.text);
                }
                TextDocumentContentChangeEvent::TextDocumentContentChangeWholeDocument(change) => text = change.text,
            }
        }
        self.source = Source::new(std::mem::take(&mut self.source.name), text);
        self.version = version;
        self.lines = Lines::new(&self.source.text);
        self.index = Index::new(&self.source, Some(&self.index));
        self.faults = faults(&self.source);
    }

    pub(super) fn byte(&self, position: lsp::Position) -> usize {
        self.lines.byte(&self.source.text, position, self.encoding)
    }

    pub(super) fn span(&self, range: lsp::Range) -> Span {
        self.lines.span(&self.source.text, range, self.encoding)
    }

    pub(super) fn range(&self, span: Span) -> lsp::Range {
        self.lines.range(&self.source.text, span, self.encoding)
    }
}

fn faults(source: &Source) -> Vec<Diagnostic> {
    match compile_with_warnings(source) {
        Ok(compiled) => compiled.warnings,
        Err(faults) => faults,
    }
}
