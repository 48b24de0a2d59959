//! Name resolution.

use std::collections::HashMap;

use crate::builtins::{self, FUNCTIONS, LIST_MEMBERS, MAP_EVENTS};
use crate::token::{Kind as TokenKind, Token};
use crate::types::{Compound, Type, dimension};
use vibrissa_declare::catalogue::{self, Entry};
use vibrissa_runtime::units::parse_unit;
use vibrissa_text::diagnostic::{Source, Span};

use super::applied::{self, Applied};
use super::import::Import;
use super::operands::{Operands, Owner};
use super::symbol::{Meaning, Role, Symbol, SymbolKind, Use};
use super::type_name::type_name;
use crate::word::{Position, Word};
use crate::words::word;

/// The words of a text with their meanings, in the order of the text.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Resolved {
    pub(super) uses: Vec<Use>,
    /// The owner before each `.`, if it is known, by the byte of the `.`.
    pub(super) owners: HashMap<usize, Owner>,
    /// The behaviour of each state that uses one, and the content of each monitor that uses another and of each argument
    /// that is a monitor.
    pub(super) behaviours: HashMap<usize, usize>,
}

/// Resolves every word of `tokens`. They are the tokens of the first part of a source, without comments. `imports` are
/// its uses of files. Symbols from index `own` on are imported.
pub(super) fn resolve(
    source: &Source,
    tokens: &[Token<'_>],
    symbols: &[Symbol],
    own: usize,
    imports: &[Import],
) -> Resolved {
    let mut names = Names::new(symbols);
    let mut resolved = Resolved::default();
    let mut operands = Operands::new(symbols);
    // End of the current type name.
    let mut type_end = 0;
    // The family whose ranges are being read.
    let mut family = None;
    let mut applied = Applied::default();
    for (index, token) in tokens.iter().enumerate() {
        names.advance(token.start);
        let last = imports.partition_point(|import| import.tokens.start < index).checked_sub(1);
        if last.is_some_and(|last| imports[last].tokens.contains(&index)) {
            continue;
        }
        let before = index.checked_sub(1).map(|before| tokens[before]);
        let is_before = |text: &str| before.is_some_and(|before| before.text == text);
        let is_word = matches!(token.kind, TokenKind::Name | TokenKind::Keyword);
        let meaning = match token.kind {
            // Behind a number, the type looks like a unit.
            _ if is_element(tokens, index) || is_word && is_before(":") && names.is_declaration(tokens, index) => {
                let named = type_name(tokens, index);
                type_end = named.as_ref().map_or(0, |(_, last)| last + 1);
                let built_in = named.and_then(|(name, _)| Type::named(&name)).map(Meaning::Type);
                let own = names.own_type(token.text).filter(|_| built_in.is_none());
                let argument = index.checked_sub(2).and_then(|name| names.declared.get(&tokens[name].span()).copied());
                resolved.behaviours.extend(argument.zip(own.filter(|&own| symbols[own].kind == SymbolKind::Monitor)));
                built_in.or_else(|| own.map(|index| Meaning::Symbol(index, Role::Reads)))
            }
            TokenKind::Name if index < type_end => dimension(token.text).map(|of| Meaning::Type(Type::Scalar(of))),
            TokenKind::Name
                if is_before("mark") || is_before("needs") || is_before("=") && is_element(tokens, index + 3) =>
            {
                word(token.text).filter(|word| is_contextual(word)).map(|word| Meaning::Keyword(word.text))
            }
            TokenKind::Name if is_before("if") && is_fitted(token.text, tokens.get(index + 1)) => {
                word(token.text).map(|word| Meaning::Keyword(word.text))
            }
            // A member, or an inner state: `-> Outer(w).Inner`.
            TokenKind::Name if is_family(&tokens[..index]) => {
                family = catalogue::entry(token.text);
                family.map(Meaning::Family)
            }
            TokenKind::Name if let Some(family) = family => {
                Entry::parameter(family, token.text).map(Meaning::FamilyParameter)
            }
            TokenKind::Name if is_before(".") => operands.last.and_then(|owner| match owner {
                Owner::Value(Type::Compound(of)) => part(symbols, of, token.text),
                Owner::Value(owner) => member(owner, token.text),
                Owner::Enumeration(owner) => owned(symbols, owner, token.text),
                Owner::State(outer) => {
                    let inner = applied::inner(symbols, &resolved.behaviours, outer, token.text);
                    let state = inner.or_else(|| names.state(token.text));
                    state.map(|state| Meaning::Symbol(state, Role::Reads))
                }
            }),
            TokenKind::Name
                if tokens.get(index + 1).is_some_and(|next| next.is(":"))
                    && let Some(argument) = operands.argument(token.text) =>
            {
                let is_declared = symbols[argument].span == token.span();
                Some(Meaning::Symbol(argument, if is_declared { Role::Declares } else { Role::Reads }))
            }
            TokenKind::Name if is_before("exit") && index > 1 && tokens[index - 2].is("->") => {
                names.of_kind(token.text, SymbolKind::Exit).map(|exit| Meaning::Symbol(exit, Role::Reads))
            }
            TokenKind::Name if is_before("on") => match names.declared.get(&token.span()) {
                Some(&event) if symbols[event].kind == SymbolKind::Event => {
                    Some(Meaning::Symbol(event, Role::Declares))
                }
                _ => applied.exit(symbols, token.text),
            },
            TokenKind::Name => {
                let role = if is_before("set") { Role::Writes } else { Role::Reads };
                names.meaning(token.span(), token.text, role)
            }
            TokenKind::Keyword => word(token.text).map(|word| Meaning::Keyword(word.text)),
            TokenKind::Unit => {
                parse_unit(&token.text.replace('*', " ")).ok().map(|unit| Meaning::Unit(unit.dimension()))
            }
            _ => None,
        };
        applied.read((token.text, is_before("is")), meaning, symbols, &mut resolved.behaviours);
        if token.is("{") {
            family = None;
        }
        if token.is(".") {
            resolved.owners.extend(operands.last.map(|owner| (token.start, owner)));
        }
        operands.advance(before, *token, meaning);
        if let Some(Meaning::Symbol(argument, _)) = meaning {
            operands.note_monitor(argument, &resolved.behaviours);
        }
        if is_word || token.kind == TokenKind::Unit {
            resolved.uses.push(Use { span: token.span(), meaning: meaning.unwrap_or(Meaning::Unknown) });
        }
    }
    resolved.uses.extend(imports.iter().flat_map(|import| of_import(source, symbols, own, import)));
    resolved.uses.sort_by_key(|known| known.span.start);
    resolved
}

/// The meanings of the words in a `use`.
fn of_import(source: &Source, symbols: &[Symbol], own: usize, import: &Import) -> Vec<Use> {
    let part = import.part(source);
    let brought = |name: &str| {
        let is_meant = |symbol: &Symbol| symbol.name == name && Some(source.part_at(symbol.span.start)) == part;
        symbols[own..].iter().position(is_meant).map(|index| Meaning::Symbol(own + index, Role::Reads))
    };
    let file = Use { span: import.from, meaning: part.map_or(Meaning::Unknown, Meaning::File) };
    let names = import.names.iter().flatten();
    let names = names.map(|&span| Use { span, meaning: brought(source.slice(span)).unwrap_or(Meaning::Unknown) });
    std::iter::once(file).chain(names).collect()
}

/// True if the name of a family follows the tokens: after `property "title" over`.
fn is_family(before: &[Token<'_>]) -> bool {
    matches!(before, [.., title, over] if title.kind == TokenKind::Text && over.text == "over")
}

/// True if a token is the type of the elements of a list: after `list of 8`.
fn is_element(tokens: &[Token<'_>], index: usize) -> bool {
    matches!(tokens.get(..index), Some([.., list, of, most])
        if list.text == "list" && of.text == "of" && most.kind == TokenKind::Number)
}

/// True if a word has its meaning only after `mark`, `needs` or the title of a property.
fn is_contextual(word: &Word) -> bool {
    [Position::Mark, Position::Need, Position::Property, Position::Type].iter().any(|&only| word.is_only_at(only))
}

/// True if `if` is followed by the end of `whisker a if fitted`. A condition would continue.
fn is_fitted(text: &str, next: Option<&Token<'_>>) -> bool {
    text == "fitted" && next.is_none_or(|next| next.kind == TokenKind::Keyword && !["and", "or"].contains(&next.text))
}

/// A field of a record, or a member of a list.
fn part(symbols: &[Symbol], of: Compound, name: &str) -> Option<Meaning> {
    let owner = symbols.iter().position(|symbol| symbol.span == of.declared)?;
    if symbols[owner].arguments.is_empty() {
        let member = LIST_MEMBERS.iter().position(|&(member, ..)| member == name);
        return member.map(|member| Meaning::ListMember(owner, member));
    }
    owned(symbols, owner, name)
}

/// A field of a record, or a value of an enumeration.
fn owned(symbols: &[Symbol], owner: usize, name: &str) -> Option<Meaning> {
    let is_it = |symbol: &Symbol| symbol.owner == Some(owner) && symbol.name == name;
    symbols.iter().position(is_it).map(|part| Meaning::Symbol(part, Role::Reads))
}

fn member(owner: Type, name: &str) -> Option<Meaning> {
    if let Some(event) = MAP_EVENTS.iter().position(|&(known, ..)| owner == Type::Map && known == name) {
        return Some(Meaning::MapEvent(event));
    }
    let member = builtins::members(owner).iter().find(|member| member.name == name)?;
    Some(Meaning::Member(owner, *member))
}

/// The names that are visible at a position that moves through the text.
struct Names<'s> {
    symbols: &'s [Symbol],
    declared: HashMap<Span, usize>,
    /// Symbols in the order of the beginnings of their visibility, and the number of those that have begun.
    order: Vec<usize>,
    begun: usize,
    /// For every name its symbols, the innermost last. Some may no longer be visible.
    known: HashMap<&'s str, Vec<usize>>,
}

impl<'s> Names<'s> {
    fn new(symbols: &'s [Symbol]) -> Self {
        // The machine's name cannot be referred to. A value of an enumeration and an event are members.
        let is_unknown_alone = |symbol: &Symbol| {
            matches!(symbol.kind, SymbolKind::Machine | SymbolKind::Choice | SymbolKind::Field | SymbolKind::Event)
        };
        let mut order: Vec<usize> = (0..symbols.len()).filter(|&index| !is_unknown_alone(&symbols[index])).collect();
        order.sort_by_key(|&index| symbols[index].visible.start);
        let declared = symbols.iter().enumerate().map(|(index, symbol)| (symbol.span, index)).collect();
        Self { symbols, declared, order, begun: 0, known: HashMap::new() }
    }

    /// True if the `:` before a token follows the name of a declared argument.
    fn is_declaration(&self, tokens: &[Token<'_>], index: usize) -> bool {
        let name = index.checked_sub(2).and_then(|name| tokens.get(name));
        name.is_some_and(|name| self.declared.contains_key(&name.span()))
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
            // Braces are nested, so the symbol that became visible last is the first to become invisible.
            while known.last().is_some_and(|&index| self.symbols[index].visible.end <= span.start) {
                known.pop();
            }
            // An exit may have the name of a value.
            let is_value = |&&index: &&usize| self.symbols[index].kind != SymbolKind::Exit;
            if let Some(&index) = known.iter().rev().find(is_value) {
                return Some(Meaning::Symbol(index, role));
            }
        }
        match FUNCTIONS.iter().position(|&(known, ..)| known == name) {
            Some(function) => Some(Meaning::Function(function)),
            None => word(name).filter(|word| !is_contextual(word)).map(|word| Meaning::Keyword(word.text)),
        }
    }

    fn state(&self, name: &str) -> Option<usize> {
        self.of_kind(name, SymbolKind::State)
    }

    /// The enumeration, the record, the list or the monitor with a name, as the type of an argument.
    fn own_type(&self, name: &str) -> Option<usize> {
        let kinds = [SymbolKind::Enumeration, SymbolKind::Compound, SymbolKind::Monitor];
        kinds.into_iter().find_map(|kind| self.of_kind(name, kind))
    }

    fn of_kind(&self, name: &str, kind: SymbolKind) -> Option<usize> {
        self.known.get(name)?.iter().copied().rfind(|&index| self.symbols[index].kind == kind)
    }
}
