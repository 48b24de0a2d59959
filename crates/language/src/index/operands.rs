//! The operands before a `.` and the calls around a position.

use std::collections::HashMap;

use crate::builtins;
use crate::token::{Kind as TokenKind, Token};
use crate::types::Type;

use super::symbol::{Meaning, Symbol, SymbolKind};

/// The operand before a `.`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Owner {
    /// A value of this type.
    Value(Type),
    /// This symbol, a state, a monitor or an argument that is a monitor.
    State(usize),
    /// This symbol, an enumeration.
    Enumeration(usize),
}

/// An open parenthesis.
#[derive(Debug, Clone, Copy, Default)]
struct Parenthesis {
    /// The operand before it, if it begins a call.
    called: Option<Owner>,
    /// The symbol before it.
    callee: Option<usize>,
    /// The last operand in it that has members. It counts as the value of a group.
    inside: Option<Owner>,
}

/// The operands up to a position that moves through the tokens.
pub(super) struct Operands<'s> {
    symbols: &'s [Symbol],
    /// The operand that ends with the previous token.
    pub(super) last: Option<Owner>,
    /// The symbol that is the previous token.
    symbol: Option<usize>,
    open: Vec<Parenthesis>,
}

impl<'s> Operands<'s> {
    pub(super) fn new(symbols: &'s [Symbol]) -> Self {
        Self { symbols, last: None, symbol: None, open: Vec::new() }
    }

    /// The argument with this name of the law, derived value or state whose values are being read.
    pub(super) fn argument(&self, name: &str) -> Option<usize> {
        let callee = self.open.last()?.callee?;
        let behind = self.symbols.iter().enumerate().skip(callee + 1);
        let mut arguments =
            behind.take_while(|(_, symbol)| matches!(symbol.kind, SymbolKind::Argument | SymbolKind::Field));
        arguments.find(|(_, symbol)| symbol.owner == Some(callee) && symbol.name == name).map(|(index, _)| index)
    }

    /// Notes that the last token is an argument that is a monitor, if it is one. `contents` has the contents of monitors.
    pub(super) fn note_monitor(&mut self, argument: usize, contents: &HashMap<usize, usize>) {
        if self.symbols[argument].kind == SymbolKind::Argument && contents.contains_key(&argument) {
            self.last = Some(Owner::State(argument));
        }
    }

    /// Moves past a token. `before` is the previous one.
    pub(super) fn advance(&mut self, before: Option<Token<'_>>, token: Token<'_>, meaning: Option<Meaning>) {
        self.last = match (token.kind, token.text, meaning) {
            (TokenKind::Mark, ".", _) => self.last,
            (TokenKind::Mark, "(", _) => {
                let is_call = before.is_some_and(|before| before.kind == TokenKind::Name);
                let called = self.last.filter(|_| is_call);
                self.open.push(Parenthesis { called, callee: self.symbol, inside: None });
                None
            }
            (TokenKind::Mark, ")", _) => {
                let closed = self.open.pop().unwrap_or_default();
                closed.called.or(closed.inside)
            }
            (TokenKind::Mark, "{" | "}", _) => {
                self.open.clear();
                None
            }
            (TokenKind::Keyword, "body", _) => Some(Owner::Value(Type::Body)),
            (TokenKind::Name, "map", Some(Meaning::Keyword(_))) => Some(Owner::Value(Type::Map)),
            (TokenKind::Name, "run", Some(Meaning::Keyword(_))) => Some(Owner::Value(Type::Run)),
            (_, _, Some(Meaning::Symbol(symbol, _))) => match self.symbols[symbol].kind {
                SymbolKind::State | SymbolKind::Monitor => Some(Owner::State(symbol)),
                SymbolKind::Enumeration => Some(Owner::Enumeration(symbol)),
                _ => self.symbols[symbol].r#type.map(Owner::Value),
            },
            (_, _, Some(Meaning::Member(_, member))) => Some(Owner::Value(member.r#type)),
            (_, _, Some(Meaning::ListMember(list, _))) => match token.text {
                "count" => Some(Owner::Value(Type::NUMBER)),
                "with" => self.last,
                // The type of a list's symbol is that of its elements.
                _ => self.symbols[list].r#type.map(Owner::Value),
            },
            _ => None,
        };
        self.symbol = match meaning {
            Some(Meaning::Symbol(symbol, _)) => Some(symbol),
            _ => None,
        };
        if let (Some(parenthesis), Some(Owner::Value(owner))) = (self.open.last_mut(), self.last)
            && !builtins::members(owner).is_empty()
        {
            parenthesis.inside = self.last;
        }
    }
}
