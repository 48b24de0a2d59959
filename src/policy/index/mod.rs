//! The index of a policy's text: names, types, references and completion for editors.
//!
//! [`Index::new`] reads any text, with errors or without. `declare` finds declarations and their visibility. `import`
//! adds the names of other files. `resolve` finds the meaning of each word. All of them work on tokens, so an error
//! hides nothing but itself. Only the types of derived and local values come from the compiler. If it cannot determine
//! one, the type comes from the previous index.
//!
//! Why: docs/decisions/editors.md#the-index-for-editors-reads-tokens.

mod applied;
mod candidate;
mod context;
mod declare;
mod hover;
mod import;
mod keyword;
mod operands;
mod origin;
mod rename;
mod resolve;
mod state;
mod symbol;
mod type_name;

use std::collections::HashMap;

use crate::diagnostic::{Source, Span};

use super::format::{Token, TokenKind, tokens};
use super::load::{self, FILE_LIMIT, Library};
use super::lower;
use super::types::Type;

use import::Import;
use resolve::Resolved;
use symbol::{Meaning, Use};

pub use candidate::{Candidate, CandidateKind};
pub use hover::Hover;
pub use origin::Origin;
pub use rename::RenameError;
pub use symbol::{Role, Symbol, SymbolKind};

/// The index of a policy's text.
///
/// ```
/// use vibrissa::{diagnostic::Source, policy::index::Index};
/// let source = Source::new("still.fsm", "machine still  initial Still  state Still { stop }");
/// let index = Index::new(&source, None);
/// let used = source.text.find("Still").unwrap();
/// assert_eq!(source.slice(index.definition(used).unwrap()), "Still");
/// assert_eq!(index.references(used).len(), 2);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Index {
    source: Source,
    /// The symbols of the text, and then the imported ones.
    symbols: Vec<Symbol>,
    /// Number of the text's own symbols.
    own: usize,
    imports: Vec<Import>,
    /// For every part of the source, the `use` that leads to it.
    root_uses: Vec<Option<Span>>,
    resolved: Resolved,
    /// True if the text has no syntax errors.
    is_read: bool,
}

/// Adds all used files to a source as parts, as [`gather`](super::gather) does. It includes files of an incomplete
/// `use` with an error after the file's name.
#[must_use]
pub fn gather(source: &Source, library: &mut Library<'_>) -> Source {
    complete(load::load(source, library).source, library)
}

/// Adds the files of each `use` with an error.
fn complete(mut source: Source, library: &mut Library<'_>) -> Source {
    let files = import::imports(&source.name, &code_tokens(text(&source))).into_iter().filter_map(|import| import.file);
    let files: Vec<String> = files.take(FILE_LIMIT).collect();
    for name in files {
        let is_known = (0..source.count()).any(|part| source.part_name(part) == name);
        if !is_known && let Ok(text) = load::text_of(&source, &name, library) {
            source.add(name, Ok(&text));
        }
    }
    source
}

/// The text of the first part.
fn text(source: &Source) -> &str {
    source.slice(source.part_span(0))
}

impl Index {
    /// Indexes a text. It may use the standard library and the parts of the source. Types that the compiler cannot
    /// determine come from `before`, the previous index.
    #[must_use]
    pub fn new(source: &Source, before: Option<&Self>) -> Self {
        let refuse = &mut |_: &str| Err(String::new());
        let loaded = load::load(source, refuse);
        let (is_read, root_uses) = (loaded.is_read(), loaded.root_uses());
        let (source, files) = loaded.known();
        let source = complete(source, refuse);
        let text = text(&source);
        let tokens = code_tokens(text);
        let mut symbols = declare::declare(text, &tokens, declare::is_balanced(&tokens)).finish(text);
        let own = symbols.len();
        let imports = import::imports(&source.name, &tokens);
        for import in imports.iter().take(FILE_LIMIT) {
            import::add_imported(&source, import, &mut symbols, own);
        }
        let types = files.as_ref().map(lower::types).unwrap_or_default();
        let known = before.map(Self::types).unwrap_or_default();
        for index in 0..symbols.len() {
            let symbol = &symbols[index];
            let of_before = || known.get(&identity(&symbols, symbol)).copied().filter(|_| symbol.kind.is_value());
            symbols[index].r#type = symbol.r#type.or_else(|| types.get(&symbol.span).copied()).or_else(of_before);
        }
        let resolved = resolve::resolve(&source, &tokens, &symbols, own, &imports);
        Self { source, symbols, own, imports, root_uses, resolved, is_read }
    }

    /// The text, with the used files as parts.
    #[must_use]
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// The declared names, in order. [`Symbol::owner`] is an index into this list.
    #[must_use]
    pub fn symbols(&self) -> &[Symbol] {
        &self.symbols[..self.own]
    }

    /// The `use` in the text that leads to a part of the source, directly or through other files.
    #[must_use]
    pub fn use_leading_to(&self, part: usize) -> Option<Span> {
        self.root_uses.get(part).copied().flatten()
    }

    /// The file that declares a symbol, if it is another file.
    fn file_of(&self, symbol: &Symbol) -> Option<&str> {
        let part = self.source.part_at(symbol.span.start);
        (part > 0).then(|| self.source.part_name(part))
    }

    /// Span of the declaration of the name at a byte. It may be in another part of the [source](Self::source). For the
    /// name of a file, the beginning of that file.
    #[must_use]
    pub fn definition(&self, at: usize) -> Option<Span> {
        match self.use_at(at)?.meaning {
            Meaning::Symbol(index, _) => Some(self.symbols[index].span),
            Meaning::File(part) => {
                let start = self.source.part_span(part).start;
                Some(Span::new(start, start))
            }
            _ => None,
        }
    }

    /// All uses of the name at a byte, in order. Empty if no file declares it.
    #[must_use]
    pub fn references(&self, at: usize) -> Vec<(Span, Role)> {
        self.symbol_at(at).map_or_else(Vec::new, |(_, wanted)| self.uses_of(wanted))
    }

    /// The declaration of a symbol on one line, without its braces: `law swipe(w: whisker)`.
    #[must_use]
    pub fn head(&self, symbol: &Symbol) -> String {
        let whole = self.source.slice(symbol.whole);
        let until = match symbol.kind {
            SymbolKind::Whisker => return format!("whisker {}", symbol.name),
            SymbolKind::Law | SymbolKind::State | SymbolKind::Behaviour | SymbolKind::Monitor => {
                whole.find('{').unwrap_or(whole.len())
            }
            _ => whole.len(),
        };
        let mut words = String::new();
        for line in whole[..until].lines() {
            let code = line.split_once('#').map_or(line, |(code, _)| code);
            for word in code.split_whitespace() {
                words += if words.is_empty() { "" } else { " " };
                words += word;
            }
        }
        words
    }

    /// The word that begins or contains a byte, or else the word that ends there.
    fn use_at(&self, at: usize) -> Option<Use> {
        let uses = &self.resolved.uses;
        let behind = uses.partition_point(|known| known.span.start <= at);
        let before = behind.checked_sub(1).and_then(|index| uses.get(index))?;
        (at <= before.span.end).then_some(*before)
    }

    /// The name at a byte and its symbol, if the text declares it.
    fn symbol_at(&self, at: usize) -> Option<(Span, usize)> {
        let known = self.use_at(at)?;
        match known.meaning {
            Meaning::Symbol(index, _) => Some((known.span, index)),
            _ => None,
        }
    }

    fn types(&self) -> HashMap<Identity<'_>, Type> {
        let typed = self.symbols.iter().filter_map(|symbol| symbol.r#type.map(|r#type| (symbol, r#type)));
        typed.map(|(symbol, r#type)| (identity(&self.symbols, symbol), r#type)).collect()
    }
}

/// The identity of a symbol after a change of the text: its name, and the name of its owner.
type Identity<'s> = (&'s str, Option<&'s str>);

fn identity<'s>(symbols: &'s [Symbol], symbol: &'s Symbol) -> Identity<'s> {
    (&symbol.name, symbol.owner.and_then(|owner| symbols.get(owner)).map(|owner| owner.name.as_str()))
}

/// The tokens of a text without comments.
fn code_tokens(text: &str) -> Vec<Token<'_>> {
    tokens(text).into_iter().filter(|token| token.kind != TokenKind::Comment).collect()
}
