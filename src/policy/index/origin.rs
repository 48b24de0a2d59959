//! What names stand for, told across files.

use crate::diagnostic::Span;

use super::symbol::{Meaning, Role, Symbol};
use super::{Index, RenameError};

/// Where a name is given: the same for every text in which it stands for the same.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Origin {
    /// The name of the file, as the [source](Index::source) of the one that uses it has it.
    pub file: String,
    /// The place in that file.
    pub place: Span,
}

impl Index {
    /// Where the name at a byte is given; `None` if it is no name that files give.
    #[must_use]
    pub fn origin(&self, at: usize) -> Option<Origin> {
        self.symbol_at(at).map(|(_, index)| self.origin_of(&self.symbols[index]))
    }

    /// Every place in the text of what is given at `origin`, in their order.
    #[must_use]
    pub fn references_to(&self, origin: &Origin) -> Vec<(Span, Role)> {
        self.given_at(origin).map_or_else(Vec::new, |index| self.places(index))
    }

    /// The places in the text at which `name` must be written for what is given at `origin` to be called so.
    ///
    /// # Errors
    /// The name cannot be changed, or not to this one.
    pub fn rename_to(&self, origin: &Origin, name: &str) -> Result<Vec<Span>, RenameError> {
        self.given_at(origin).map_or(Ok(Vec::new()), |index| self.renamed(index, name))
    }

    /// Every place in the text of a symbol, in their order.
    pub(super) fn places(&self, wanted: usize) -> Vec<(Span, Role)> {
        let places = self.resolved.uses.iter().filter_map(|known| match known.meaning {
            Meaning::Symbol(index, role) if index == wanted => Some((known.span, role)),
            _ => None,
        });
        places.collect()
    }

    fn given_at(&self, origin: &Origin) -> Option<usize> {
        self.symbols.iter().position(|symbol| self.origin_of(symbol) == *origin)
    }

    fn origin_of(&self, symbol: &Symbol) -> Origin {
        let part = self.source.part_at(symbol.span.start);
        let start = self.source.part_span(part).start;
        let place = Span::new(symbol.span.start - start, symbol.span.end - start);
        Origin { file: self.source.part_name(part).to_owned(), place }
    }
}
