//! What is known of every place in a policy's text: for editors, which ask while it is being written.
//!
//! [`Index::new`] reads any text, with faults or without. `declare` finds the names that it gives and where they are known,
//! `resolve` what each word means; both work on tokens, so that a fault hides nothing but itself. Only types of derived and local
//! values come from the compiler, and of a text that it cannot read, from the index before.

mod candidate;
mod context;
mod declare;
mod description;
mod hover;
mod meaning;
mod rename;
mod resolve;
mod symbol;
mod words;

use std::collections::HashMap;

use crate::diagnostic::{Source, Span};

use super::format::{Token, TokenKind, tokens};
use super::types::Type;
use super::{lower, parse};

use resolve::Resolved;
use symbol::{Meaning, Use};

pub use candidate::{Candidate, CandidateKind};
pub use hover::Hover;
pub use rename::RenameError;
pub use symbol::{Role, Symbol, SymbolKind};

/// What is known of a policy's text.
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
    symbols: Vec<Symbol>,
    resolved: Resolved,
    /// Whether the text could be read in full.
    is_read: bool,
}

impl Index {
    /// Reads a text. Where it cannot be compiled, types come from what was known of it `before`.
    #[must_use]
    pub fn new(source: &Source, before: Option<&Self>) -> Self {
        let tokens = code_tokens(&source.text);
        let mut symbols = declare::declare(&source.text, &tokens).finish(&source.text);
        let file = parse::parse(source).ok();
        if let Some(file) = &file {
            let types = lower::types(file);
            for symbol in &mut symbols {
                symbol.r#type = symbol.r#type.or_else(|| types.get(&symbol.span).copied());
            }
        } else if let Some(before) = before {
            let known = before.types();
            for index in 0..symbols.len() {
                let r#type = known.get(&identity(&symbols, &symbols[index])).copied();
                symbols[index].r#type = symbols[index].r#type.or(r#type);
            }
        }
        let resolved = resolve::resolve(&tokens, &symbols);
        Self { source: source.clone(), symbols, resolved, is_read: file.is_some() }
    }

    /// The names that the text gives, in their order. [`Symbol::owner`] is a place in this list.
    #[must_use]
    pub fn symbols(&self) -> &[Symbol] {
        &self.symbols
    }

    /// Where the name at a byte is given.
    #[must_use]
    pub fn definition(&self, at: usize) -> Option<Span> {
        self.symbol_at(at).map(|(_, index)| self.symbols[index].span)
    }

    /// Every place of what the name at a byte stands for, in their order; none if it stands for nothing that the text gives.
    #[must_use]
    pub fn references(&self, at: usize) -> Vec<(Span, Role)> {
        let Some((_, wanted)) = self.symbol_at(at) else { return Vec::new() };
        let places = self.resolved.uses.iter().filter_map(|known| match known.meaning {
            Meaning::Symbol(index, role) if index == wanted => Some((known.span, role)),
            _ => None,
        });
        places.collect()
    }

    /// How a symbol is written, without its braces and on one line: `law swipe(w: whisker)`.
    #[must_use]
    pub fn head(&self, symbol: &Symbol) -> String {
        let whole = self.source.slice(symbol.whole);
        let until = match symbol.kind {
            SymbolKind::Whisker => return format!("whisker {}", symbol.name),
            SymbolKind::Law | SymbolKind::State => whole.find('{').unwrap_or(whole.len()),
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

    /// The word at a byte; the one that ends there, if none begins.
    fn use_at(&self, at: usize) -> Option<Use> {
        let uses = &self.resolved.uses;
        let behind = uses.partition_point(|known| known.span.start <= at);
        let before = behind.checked_sub(1).and_then(|index| uses.get(index))?;
        (at <= before.span.end).then_some(*before)
    }

    /// The name at a byte and what it stands for, if the text gives it.
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

/// By what a symbol is known again when the text has changed: its name, and that of what it stands in.
type Identity<'s> = (&'s str, Option<&'s str>);

fn identity<'s>(symbols: &'s [Symbol], symbol: &'s Symbol) -> Identity<'s> {
    (&symbol.name, symbol.owner.and_then(|owner| symbols.get(owner)).map(|owner| owner.name.as_str()))
}

/// The tokens of a text without its comments.
fn code_tokens(text: &str) -> Vec<Token<'_>> {
    tokens(text).into_iter().filter(|token| token.kind != TokenKind::Comment).collect()
}
