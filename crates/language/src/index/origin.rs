//! Identity of symbols across files.

use vibrissa_text::diagnostic::Span;

use super::symbol::{Meaning, Role, Symbol};
use super::{Index, RenameError};

/// The declaration of a symbol. It is the same in every text that refers to the symbol.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Origin {
    /// The name of the file in the [source](Index::source) of a file that uses it.
    pub file: String,
    /// Span in that file.
    pub span: Span,
}

impl Index {
    /// The declaration of the name at a byte. `None` if no file declares it.
    #[must_use]
    pub fn origin(&self, at: usize) -> Option<Origin> {
        self.symbol_at(at).map(|(_, index)| self.origin_of(&self.symbols[index]))
    }

    /// All uses of the symbol of `origin` in the text, in order.
    #[must_use]
    pub fn references_to(&self, origin: &Origin) -> Vec<(Span, Role)> {
        self.given_at(origin).map_or_else(Vec::new, |index| self.uses_of(index))
    }

    /// The spans in this text to replace with `name` when the symbol of `origin` is renamed.
    ///
    /// # Errors
    /// The name cannot be changed, or not to `name`.
    pub fn rename_to(&self, origin: &Origin, name: &str) -> Result<Vec<Span>, RenameError> {
        self.given_at(origin).map_or(Ok(Vec::new()), |index| self.renamed(index, name))
    }

    /// All uses of a symbol in the text, in order.
    pub(super) fn uses_of(&self, wanted: usize) -> Vec<(Span, Role)> {
        let uses = self.resolved.uses.iter().filter_map(|known| match known.meaning {
            Meaning::Symbol(index, role) if index == wanted => Some((known.span, role)),
            _ => None,
        });
        uses.collect()
    }

    fn given_at(&self, origin: &Origin) -> Option<usize> {
        self.symbols.iter().position(|symbol| self.origin_of(symbol) == *origin)
    }

    fn origin_of(&self, symbol: &Symbol) -> Origin {
        let part = self.source.part_at(symbol.span.start);
        let start = self.source.part_span(part).start;
        let span = Span::new(symbol.span.start - start, symbol.span.end - start);
        Origin { file: self.source.part_name(part).to_owned(), span }
    }
}
