//! What the words of a text mean, given what it declares.

use std::collections::HashMap;

use crate::diagnostic::Span;
use crate::policy::builtins;
use crate::policy::format::{Token, TokenKind};
use crate::policy::types::Type;
use crate::units::parse_unit;

use super::declare::place;
use super::symbol::{Meaning, Role, Symbol, SymbolKind, Use};
use super::words::word;

/// The words of a text with their meanings, in their order.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Resolved {
    pub(super) uses: Vec<Use>,
    /// The type of what stands before each `.`, where it is known, by the byte of the `.`.
    pub(super) owners: HashMap<usize, Type>,
}

/// Finds the meaning of every word among `tokens`, among which there are no comments.
pub(super) fn resolve(tokens: &[Token<'_>], symbols: &[Symbol]) -> Resolved {
    let mut names = Names::new(symbols);
    let mut resolved = Resolved::default();
    // The type of the operand that ends with the token before, and of what each open parenthesis is called on.
    let (mut operand, mut calls): (Option<Type>, Vec<Option<Type>>) = (None, Vec::new());
    for (index, token) in tokens.iter().enumerate() {
        let before = index.checked_sub(1).map(|before| tokens[before]);
        let is_before = |mark: &str| before.is_some_and(|before| before.text == mark);
        names.advance(token.start);
        let meaning = match token.kind {
            // A member, or a state within another: `-> Outer(w).Inner`.
            TokenKind::Name if is_before(".") => member(operand, token.text)
                .or_else(|| names.state(token.text).map(|state| Meaning::Symbol(state, Role::Reads))),
            TokenKind::Name | TokenKind::Keyword if is_before(":") || is_before("of") => {
                type_at(tokens, index).map(Meaning::Type)
            }
            TokenKind::Name => {
                let role = if is_before("set") { Role::Writes } else { Role::Reads };
                names.meaning(place(*token), token.text, role)
            }
            TokenKind::Keyword => word(token.text).map(|word| Meaning::Word(word.text)),
            TokenKind::Unit => {
                parse_unit(&token.text.replace('*', " ")).ok().map(|unit| Meaning::Unit(unit.dimension()))
            }
            _ => None,
        };
        operand = match (token.kind, token.text, meaning) {
            (TokenKind::Mark, ".", _) => {
                resolved.owners.extend(operand.map(|owner| (token.start, owner)));
                operand
            }
            (TokenKind::Mark, "(", _) => {
                let is_call = before.is_some_and(|before| before.kind == TokenKind::Name);
                calls.push(operand.filter(|_| is_call));
                None
            }
            (TokenKind::Mark, ")", _) => calls.pop().flatten(),
            (TokenKind::Keyword, "body", _) => Some(Type::Body),
            (_, _, Some(Meaning::Symbol(symbol, _))) => symbols[symbol].r#type,
            (_, _, Some(Meaning::Member(_, member))) => Some(member.r#type),
            _ => None,
        };
        let is_name = matches!(token.kind, TokenKind::Name | TokenKind::Keyword | TokenKind::Unit);
        if is_name {
            resolved.uses.push(Use { span: place(*token), meaning: meaning.unwrap_or(Meaning::Unknown) });
        }
    }
    resolved
}

fn member(owner: Option<Type>, name: &str) -> Option<Meaning> {
    let owner = owner?;
    let member = builtins::members(owner).iter().find(|member| member.name == name)?;
    Some(Meaning::Member(owner, *member))
}

/// The type that the token names, with the `of` behind it.
fn type_at(tokens: &[Token<'_>], index: usize) -> Option<Type> {
    let base = tokens.get(index)?.text;
    match tokens.get(index + 1..index + 3) {
        Some([of, dimension]) if of.text == "of" => Type::named(base, Some(dimension.text)),
        _ => Type::named(base, None),
    }
}

/// The names that are known at a place that moves through the text.
struct Names<'s> {
    symbols: &'s [Symbol],
    declared: HashMap<Span, usize>,
    /// Symbols in the order in which they come to be known, and how many of them are.
    order: Vec<usize>,
    begun: usize,
    /// For every name the symbols that it stands for, the innermost last; some may be known no longer.
    known: HashMap<&'s str, Vec<usize>>,
}

impl<'s> Names<'s> {
    fn new(symbols: &'s [Symbol]) -> Self {
        // Nothing can refer to the machine.
        let mut order: Vec<usize> =
            (0..symbols.len()).filter(|&index| symbols[index].kind != SymbolKind::Machine).collect();
        order.sort_by_key(|&index| symbols[index].visible.start);
        let declared = symbols.iter().enumerate().map(|(index, symbol)| (symbol.span, index)).collect();
        Self { symbols, declared, order, begun: 0, known: HashMap::new() }
    }

    fn advance(&mut self, at: usize) {
        while let Some(&index) = self.order.get(self.begun)
            && self.symbols[index].visible.start <= at
        {
            self.known.entry(&self.symbols[index].name).or_default().push(index);
            self.begun += 1;
        }
    }

    fn meaning(&mut self, span: Span, name: &str, role: Role) -> Option<Meaning> {
        if let Some(&declared) = self.declared.get(&span) {
            return Some(Meaning::Symbol(declared, Role::Declares));
        }
        if let Some(known) = self.known.get_mut(name) {
            // Braces are nested, so that what came to be known last ceases to be known first.
            while known.last().is_some_and(|&index| self.symbols[index].visible.end <= span.start) {
                known.pop();
            }
            if let Some(&index) = known.last() {
                return Some(Meaning::Symbol(index, role));
            }
        }
        match builtins::function(name) {
            Some((function, usage)) => Some(Meaning::Function(function, usage)),
            None => word(name).map(|word| Meaning::Word(word.text)),
        }
    }

    fn state(&self, name: &str) -> Option<usize> {
        self.known.get(name)?.iter().copied().rfind(|&index| self.symbols[index].kind == SymbolKind::State)
    }
}
