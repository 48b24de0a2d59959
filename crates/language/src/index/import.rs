//! Imported files and names.
//!
//! They are read from tokens, so the names of a file are known while its `use` is being typed.

use std::ops::Range;

use crate::ast::{From, Name, Use};
use crate::path;
use crate::token::{Kind as TokenKind, Token};
use crate::types::{Choices, Compound, Type};
use vibrissa_text::diagnostic::{Source, Span};

use super::code_tokens;
use super::declare::declare;
use super::symbol::{Symbol, SymbolKind};

/// A `use`, complete or not.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Import {
    /// The tokens of the `use`, including the keyword.
    pub(super) tokens: Range<usize>,
    /// First byte of the `use`.
    pub(super) start: usize,
    /// Span of the file's name.
    pub(super) from: Span,
    /// The name of the file, if it is valid.
    pub(super) file: Option<String>,
    /// The imported names. `None` if the whole file is imported.
    pub(super) names: Option<Vec<Span>>,
}

impl Import {
    /// The part of a source that contains the file.
    pub(super) fn part(&self, source: &Source) -> Option<usize> {
        let name = self.file.as_deref()?;
        (1..source.count()).find(|&part| source.part_name(part) == name && source.absence(part).is_none())
    }
}

/// Every `use` among the tokens of the file `name`.
pub(super) fn imports(name: &str, tokens: &[Token<'_>]) -> Vec<Import> {
    let words = tokens.iter().enumerate().filter(|(_, token)| token.kind == TokenKind::Keyword && token.text == "use");
    words.filter_map(|(index, _)| import(name, tokens, index)).collect()
}

fn import(using: &str, tokens: &[Token<'_>], word: usize) -> Option<Import> {
    let first = tokens.get(word + 1)?;
    let mut next = word + 2;
    let from = match first.kind {
        TokenKind::Text => From::Path(first.text.trim_matches('"').to_owned()),
        TokenKind::Name => {
            let mut names = vec![named(*first)];
            while let Some([dot, part]) = tokens.get(next..next + 2)
                && dot.is(".")
                && part.kind == TokenKind::Name
            {
                names.push(named(*part));
                next += 2;
            }
            From::Module(names)
        }
        _ => return None,
    };
    let span = first.span().to(tokens[next - 1].span());
    let mut names = None;
    if tokens.get(next).is_some_and(|token| token.is("(")) {
        let listed = tokens[next + 1..].iter().take_while(|token| token.kind == TokenKind::Name || token.is(","));
        let listed: Vec<Token<'_>> = listed.copied().collect();
        next += 1 + listed.len();
        next += usize::from(tokens.get(next).is_some_and(|token| token.is(")")));
        names =
            Some(listed.into_iter().filter(|token| token.kind == TokenKind::Name).map(|token| token.span()).collect());
    }
    let used = Use { from, span, names: None };
    let file = path::resolve(using, &used).ok();
    Some(Import { tokens: word..next, start: tokens[word].start, from: span, file, names })
}

fn named(token: Token<'_>) -> Name {
    Name { text: token.text.to_owned(), span: token.span() }
}

/// Appends the symbols that a `use` imports. The first `own` symbols are those of the text itself.
pub(super) fn add_imported(source: &Source, import: &Import, symbols: &mut Vec<Symbol>, own: usize) {
    let Some(part) = import.part(source) else { return };
    let everywhere = source.part_span(0);
    let declared = declared(source, part);
    // The index of each declared symbol among all.
    let mut places: Vec<Option<usize>> = Vec::with_capacity(declared.len());
    for symbol in declared {
        let is_chosen =
            || import.names.as_ref().is_none_or(|names| names.iter().any(|&name| source.slice(name) == symbol.name));
        let owner = symbol.owner.and_then(|owner| places.get(owner).copied().flatten());
        // Parts of a symbol, such as the exits of a behaviour, are known only together with it.
        let visible = if is_export(&symbol) { everywhere } else { Span::new(0, 0) };
        let is_inner = is_part(&symbol);
        let is_wanted = if is_export(&symbol) { is_chosen() } else { is_inner && owner.is_some() };
        let known = symbols[own..].iter().position(|known| known.span == symbol.span).map(|index| own + index);
        places.push(match known {
            None if is_wanted => {
                symbols.push(Symbol { owner, visible, ..symbol });
                Some(symbols.len() - 1)
            }
            known => known,
        });
    }
}

/// True if a symbol is known only together with its owner.
fn is_part(symbol: &Symbol) -> bool {
    use SymbolKind::{Argument, Choice, Event, Exit, Field, Memory, State};
    matches!(symbol.kind, Choice | Field | Argument | State | Exit | Event | Memory)
}

/// True if other files can use a symbol of a file.
fn is_export(symbol: &Symbol) -> bool {
    use SymbolKind::{Behaviour, Compound, Derived, Enumeration, Law, Monitor};
    matches!(symbol.kind, Law | Derived | Enumeration | Compound | Behaviour | Monitor) && symbol.owner.is_none()
}

/// The exported symbols of a part of a source: its laws, derived values, enumerations, behaviours and monitors.
pub(super) fn exports(source: &Source, part: usize) -> Vec<Symbol> {
    declared(source, part).into_iter().filter(is_export).collect()
}

/// All symbols of a part of a source.
fn declared(source: &Source, part: usize) -> Vec<Symbol> {
    let span = source.part_span(part);
    let text = source.slice(span);
    let symbols = declare(text, &code_tokens(text), true).finish(text).into_iter();
    let moved = |inner: Span| Span::new(span.start + inner.start, span.start + inner.end);
    let moved_type = |r#type| match r#type {
        Type::Choice(choices) => Type::Choice(Choices { declared: moved(choices.declared), ..choices }),
        Type::Compound(compound) => Type::Compound(Compound { declared: moved(compound.declared), ..compound }),
        other => other,
    };
    let moved = |symbol: Symbol| {
        let (span, whole, r#type) = (moved(symbol.span), moved(symbol.whole), symbol.r#type.map(moved_type));
        Symbol { span, whole, r#type, ..symbol }
    };
    symbols.map(moved).collect()
}

/// The description of a file in the comment at its beginning.
pub(super) fn heading(text: &str) -> String {
    let lines = text.lines().map_while(|line| line.strip_prefix('#')).map(str::trim);
    lines.collect::<Vec<_>>().join(" ")
}
