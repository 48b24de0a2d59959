//! A policy that is open in the editor.

use gen_lsp_types::{self as lsp, Location, TextDocumentContentChangeEvent, Uri};

use crate::index::{Index, gather};
use crate::{Checked, Library, check};
use vibrissa_text::diagnostic::{Diagnostic, Source, Span};

use super::position::{Encoding, Lines};
use super::uri;

/// A text with the results of its analysis.
#[derive(Debug)]
pub(super) struct Document {
    pub(super) uri: Uri,
    /// The text without the files that it uses.
    pub(super) source: Source,
    /// The editor's version number of the text.
    pub(super) version: i32,
    pub(super) index: Index,
    /// The errors of the text and its used files, or else the warnings. Positions refer to the source of the index.
    pub(super) faults: Vec<Diagnostic>,
    /// True if the text has changed since its last analysis.
    is_stale: bool,
    lines: Lines,
    encoding: Encoding,
}

impl Document {
    pub(super) fn new(uri: Uri, version: i32, text: String, encoding: Encoding, library: &mut Library<'_>) -> Self {
        let name = uri::path(&uri).unwrap_or_else(|| uri.to_string());
        let source = Source::new(name, text);
        let whole = gather(&source, library);
        let (lines, index, faults) = (Lines::new(&source.text), Index::new(&whole, None), faults(&whole));
        Self { uri, source, version, index, faults, is_stale: false, lines, encoding }
    }

    /// Analyses the text and the files that it uses.
    pub(super) fn analyse(&mut self, library: &mut Library<'_>) {
        let whole = gather(&self.source, library);
        self.lines = Lines::new(&self.source.text);
        self.index = Index::new(&whole, Some(&self.index));
        self.faults = faults(&whole);
        self.is_stale = false;
    }

    /// True if the text must be analysed before requests are answered.
    pub(super) fn is_stale(&self) -> bool {
        self.is_stale
    }

    /// True if the document uses the file at a path. The file need not exist.
    pub(super) fn uses(&self, path: &str) -> bool {
        let source = self.index.source();
        (1..source.count()).any(|part| source.part_name(part) == path)
    }

    /// Applies changes one after the other. The index stays that of the old text until the next analysis.
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
        self.is_stale = true;
    }

    pub(super) fn byte(&self, position: lsp::Position) -> usize {
        self.lines.byte(&self.source.text, position, self.encoding)
    }

    pub(super) fn span(&self, range: lsp::Range) -> Span {
        self.lines.span(&self.source.text, range, self.encoding)
    }

    /// The range of a span in the document's own text.
    pub(super) fn range(&self, span: Span) -> lsp::Range {
        self.lines.range(&self.source.text, span, self.encoding)
    }

    /// The location of a span in the text or in a used file. `None` in the standard library, which is not a file.
    pub(super) fn location(&self, span: Span) -> Option<Location> {
        let source = self.index.source();
        let part = source.part_at(span.start);
        if part == 0 {
            return Some(Location { uri: self.uri.clone(), range: self.range(span) });
        }
        let uri = uri::of_path(source.part_name(part))?;
        let within = source.part_span(part);
        let text = source.slice(within);
        let span = Span::new(span.start - within.start, span.end.saturating_sub(within.start));
        Some(Location { uri, range: Lines::new(text).range(text, span, self.encoding) })
    }
}

fn faults(source: &Source) -> Vec<Diagnostic> {
    match check(source) {
        Ok(Checked::Machine(compiled)) => compiled.warnings,
        Ok(Checked::Library { warnings, .. }) => warnings,
        Err(faults) => faults,
    }
}
