//! Declarations in a policy's text: from tokens to symbols.
//!
//! This module reads tokens instead of the syntax tree, so a text with errors has symbols, too. The keyword at the
//! beginning of a statement determines the kind of its braces. In a text with unclosed braces, an item keyword in the
//! first column of a line closes them.

use crate::grammar::is_before_expression;
use crate::token::{Kind as TokenKind, Token};
use crate::types::{Choices, Type};
use vibrissa_runtime::units::{Dimension, parse_unit};
use vibrissa_text::diagnostic::Span;

use super::symbol::{Symbol, SymbolKind};
use super::type_name::type_name;
use crate::word::Position;
use crate::words::word;

/// The content of a pair of braces, or the text outside of all braces.
#[derive(Debug, Clone, Default)]
pub(super) struct Frame<'t> {
    /// The keyword of the statement before the opening brace. `None` outside of all braces.
    pub(super) head: Option<&'t str>,
    /// The first token of the current statement.
    pub(super) statement: Option<usize>,
    /// The symbol to which the braces belong.
    pub(super) owner: Option<usize>,
    /// The declarations of the current statement.
    pending: Vec<usize>,
    /// The symbols that are visible until the closing brace.
    inside: Vec<usize>,
}

/// The declarations in the part of a text that was read.
#[derive(Debug, Clone)]
pub(super) struct Declared<'t> {
    /// In the order of their names in the text.
    pub(super) symbols: Vec<Symbol>,
    /// The open braces at the end, the innermost last. It is never empty.
    pub(super) frames: Vec<Frame<'t>>,
    /// True if all braces of the text are balanced.
    is_balanced: bool,
    /// End of the last token.
    end: usize,
}

/// Reads the declarations of `tokens`, which contain no comments. They may be the beginning of a text with balanced
/// braces.
pub(super) fn declare<'t>(text: &str, tokens: &[Token<'t>], is_balanced: bool) -> Declared<'t> {
    let mut declared = Declared { symbols: Vec::new(), frames: vec![Frame::default()], is_balanced, end: 0 };
    for (index, token) in tokens.iter().enumerate() {
        match token.kind {
            TokenKind::Keyword => declared.word(text, tokens, index),
            TokenKind::Mark if token.text == "{" => declared.open(tokens),
            TokenKind::Mark if token.text == "}" && declared.frames.len() > 1 => {
                declared.close(token.start);
                declared.end = token.start + 1;
                continue;
            }
            _ => {}
        }
        declared.end = token.start + token.text.len();
    }
    declared
}

impl<'t> Declared<'t> {
    /// The symbols of a complete text. All open constructs end with it.
    pub(super) fn finish(mut self, text: &str) -> Vec<Symbol> {
        while self.frames.len() > 1 {
            self.close(text.len());
            self.end = text.len();
        }
        self.finish_statement();
        let is_the_machines = |symbol: &Symbol| symbol.kind == SymbolKind::Memory && symbol.owner.is_none();
        for index in 0..self.symbols.len() {
            let symbol = &self.symbols[index];
            if symbol.kind.is_item() || is_the_machines(symbol) {
                // The states of a behaviour are known only in it.
                let around = behaviour_around(&self.symbols, index).map(|behaviour| self.symbols[behaviour].whole);
                self.symbols[index].visible = around.unwrap_or(Span::new(0, text.len()));
            }
        }
        self.symbols
    }

    fn frame(&mut self) -> Option<&mut Frame<'t>> {
        self.frames.last_mut()
    }

    fn word(&mut self, text: &str, tokens: &[Token<'t>], index: usize) {
        let token = tokens[index];
        let before = index.checked_sub(1).map(|before| tokens[before]);
        let is_type = token.text == "whisker" && before.is_some_and(|before| before.is(":"));
        let Some(known) = word(token.text).filter(|word| word.begins() && !is_type) else { return };
        // `always when` and `else if` are one statement, and `-> exit name` is a target.
        let is_target = token.text == "exit" && before.is_some_and(|before| before.is("->"));
        if is_target || before.is_some_and(|before| ["always", "else"].contains(&before.text)) {
            return;
        }
        if token.text == "if" && before.is_some_and(|before| is_before_expression(before.text)) {
            return;
        }
        if !self.is_balanced && known.is_at(Position::Item) && begins_line_unindented(text, token.start) {
            while self.frames.len() > 1 {
                self.close(self.end);
            }
        }
        self.finish_statement();
        let outside = self.frames.len() == 1;
        if let Some(frame) = self.frame() {
            frame.statement = Some(index);
        }
        let kind = match token.text {
            "machine" | "library" => SymbolKind::Machine,
            "param" => SymbolKind::Parameter,
            "type" if is_compound(&tokens[index + 1..]) => SymbolKind::Compound,
            "type" => SymbolKind::Enumeration,
            "law" => SymbolKind::Law,
            "state" => SymbolKind::State,
            "behaviour" => SymbolKind::Behaviour,
            "monitor" => SymbolKind::Monitor,
            "exit" => SymbolKind::Exit,
            // An event of a monitor, or the names of an exit's values.
            "on" => {
                let owner = self.frames.last().and_then(|frame| frame.owner);
                match owner {
                    Some(owner) if self.symbols[owner].kind == SymbolKind::Monitor => SymbolKind::Event,
                    Some(owner) => return self.received(tokens, index + 2, owner),
                    None => return,
                }
            }
            "var" => SymbolKind::Memory,
            "whisker" => SymbolKind::Whisker,
            "contour" => SymbolKind::Contour,
            "let" if outside => SymbolKind::Derived,
            "let" => SymbolKind::Local,
            _ => return,
        };
        let mut name = index + 1;
        while tokens.get(name).is_some_and(|token| token.kind == TokenKind::Name) {
            let declared = self.declare(tokens, name, token.start, kind);
            match kind {
                SymbolKind::Law
                | SymbolKind::State
                | SymbolKind::Behaviour
                | SymbolKind::Monitor
                | SymbolKind::Exit
                | SymbolKind::Event
                | SymbolKind::Compound
                | SymbolKind::Derived => self.arguments(tokens, name + 1, declared),
                SymbolKind::Parameter => self.symbols[declared].r#type = parameter_type(&tokens[name..]),
                SymbolKind::Enumeration => self.choices(tokens, name + 1, declared),
                _ => {}
            }
            // A list of whiskers: `whisker a, b`
            if kind != SymbolKind::Whisker || !tokens.get(name + 1).is_some_and(|token| token.is(",")) {
                break;
            }
            name += 2;
        }
    }

    fn declare(&mut self, tokens: &[Token<'t>], name: usize, start: usize, kind: SymbolKind) -> usize {
        let token = tokens[name];
        let span = token.span();
        let r#type = match kind {
            SymbolKind::Whisker => Some(Type::Whisker),
            SymbolKind::Contour => Some(Type::Contour),
            _ => None,
        };
        let index = self.symbols.len();
        let owner = self.frames.iter().rev().find_map(|frame| frame.owner);
        self.symbols.push(Symbol {
            name: token.text.to_owned(),
            kind,
            span,
            whole: Span::new(start, span.end),
            arguments: Vec::new(),
            owner,
            visible: span,
            r#type,
        });
        if let Some(frame) = self.frame() {
            frame.pending.push(index);
            if !kind.is_item() {
                frame.inside.push(index);
            }
        }
        index
    }

    /// Reads `(name: type, …)`.
    fn arguments(&mut self, tokens: &[Token<'t>], open: usize, owner: usize) {
        if !tokens.get(open).is_some_and(|token| token.is("(")) {
            return;
        }
        let mut at = open + 1;
        while let Some(name) = tokens.get(at).filter(|token| token.kind == TokenKind::Name) {
            let span = name.span();
            let (mut end, mut r#type) = (at, None);
            if tokens.get(at + 1).is_some_and(|token| token.is(":"))
                && let Some((name, last)) = type_name(tokens, at + 2)
            {
                (end, r#type) = (last, Type::named(&name));
            }
            let whole = span.to(tokens[end].span());
            self.symbols[owner].arguments.push(name.text.to_owned());
            let index = self.symbols.len();
            let is_field = self.symbols[owner].kind == SymbolKind::Compound;
            self.symbols.push(Symbol {
                name: name.text.to_owned(),
                kind: if is_field { SymbolKind::Field } else { SymbolKind::Argument },
                span,
                whole,
                arguments: Vec::new(),
                owner: Some(owner),
                visible: span,
                r#type,
            });
            // A field is known only as a member of its record.
            if let Some(frame) = self.frame()
                && !is_field
            {
                frame.pending.push(index);
            }
            at = behind_default(tokens, end + 1);
            if !tokens.get(at).is_some_and(|token| token.is(",")) {
                break;
            }
            at += 1;
        }
    }

    /// Reads `= value or value`.
    fn choices(&mut self, tokens: &[Token<'t>], equals: usize, owner: usize) {
        let mut at = equals + 1;
        while tokens.get(at - 1).is_some_and(|before| before.is("=") || before.text == "or")
            && let Some(name) = tokens.get(at).filter(|token| token.kind == TokenKind::Name)
        {
            let span = name.span();
            self.symbols.push(Symbol {
                name: name.text.to_owned(),
                kind: SymbolKind::Choice,
                span,
                whole: span,
                arguments: Vec::new(),
                owner: Some(owner),
                // It is known only as a member of the enumeration.
                visible: Span::new(span.start, span.start),
                r#type: None,
            });
            at += 2;
        }
        let count = self.symbols.len() - owner - 1;
        let declared = self.symbols[owner].span;
        for symbol in &mut self.symbols[owner + 1..] {
            symbol.r#type = Some(Type::Choice(Choices { declared, count }));
        }
    }

    /// Reads `(name, …)` after `on exit`.
    fn received(&mut self, tokens: &[Token<'t>], open: usize, owner: usize) {
        let names = tokens.get(open + 1..).unwrap_or_default().iter();
        let names = names.take_while(|token| token.kind == TokenKind::Name || token.is(","));
        let is_list = tokens.get(open).is_some_and(|token| token.is("("));
        for name in names.filter(|token| is_list && token.kind == TokenKind::Name) {
            let (index, span) = (self.symbols.len(), name.span());
            self.symbols.push(Symbol {
                name: name.text.to_owned(),
                kind: SymbolKind::Argument,
                span,
                whole: span,
                arguments: Vec::new(),
                owner: Some(owner),
                visible: span,
                r#type: None,
            });
            if let Some(frame) = self.frame() {
                frame.pending.push(index);
            }
        }
    }

    fn open(&mut self, tokens: &[Token<'t>]) {
        let Some(frame) = self.frame() else { return };
        let head = frame.statement.and_then(|statement| tokens.get(statement)).map(|token| token.text);
        let owner = frame.pending.first().copied();
        self.frames.push(Frame { head, owner, ..Frame::default() });
    }

    /// Closes the innermost braces. Their content ends at `end`.
    fn close(&mut self, end: usize) {
        self.finish_statement();
        let Some(frame) = self.frames.pop() else { return };
        for index in frame.inside {
            self.symbols[index].visible.end = end;
        }
    }

    /// Ends the current statement after the last token.
    fn finish_statement(&mut self) {
        let end = self.end;
        let start = self.frames.last().and_then(|frame| frame.owner).map(|owner| self.symbols[owner].span.end);
        let Some(frame) = self.frames.last_mut() else { return };
        frame.statement = None;
        for index in std::mem::take(&mut frame.pending) {
            let symbol = &mut self.symbols[index];
            match symbol.kind {
                SymbolKind::Argument => symbol.visible = Span::new(symbol.whole.end, end),
                SymbolKind::Memory | SymbolKind::Exit => {
                    // Memory is visible in the whole state, also above its declaration. So are the exits of a behaviour.
                    symbol.visible = Span::new(start.unwrap_or(symbol.span.start), end);
                    symbol.whole.end = end;
                }
                // Outside of braces, nothing ends the visibility of a local name.
                SymbolKind::Local => {
                    symbol.visible = Span::new(end, end);
                    symbol.whole.end = end;
                }
                SymbolKind::Whisker => symbol.whole.end = symbol.span.end,
                _ => symbol.whole.end = end,
            }
        }
    }
}

/// The behaviour that contains a symbol.
pub(super) fn behaviour_around(symbols: &[Symbol], symbol: usize) -> Option<usize> {
    let owner = |&symbol: &usize| symbols.get(symbol).and_then(|symbol| symbol.owner);
    // An owner precedes what it contains.
    let around = std::iter::successors(Some(symbol), owner).skip(1).take(symbols.len());
    around.into_iter().find(|&around| symbols.get(around).is_some_and(|symbol| symbol.kind == SymbolKind::Behaviour))
}

/// The index of the token behind a default, `= value`, which ends with its list or at a comma. `at` if there is none.
fn behind_default(tokens: &[Token<'_>], at: usize) -> usize {
    if !tokens.get(at).is_some_and(|token| token.is("=")) {
        return at;
    }
    let mut depth = 0_usize;
    for (index, token) in tokens.iter().enumerate().skip(at) {
        match token.text {
            _ if token.kind != TokenKind::Mark => {}
            "(" => depth += 1,
            ")" | "," if depth == 0 => return index,
            "{" | "}" => return index,
            ")" => depth -= 1,
            _ => {}
        }
    }
    tokens.len()
}

/// True if the tokens after `type` declare a record or a list: `Edge(`, `Places = list of`.
fn is_compound(tokens: &[Token<'_>]) -> bool {
    let is = |at: usize, text: &str| tokens.get(at).is_some_and(|token| token.text == text);
    is(1, "(") || is(1, "=") && is(2, "list") && is(3, "of")
}

fn begins_line_unindented(text: &str, start: usize) -> bool {
    start == 0 || text.as_bytes().get(start - 1) == Some(&b'\n')
}

/// The type of the parameter whose declaration begins with `tokens`.
fn parameter_type(tokens: &[Token<'_>]) -> Option<Type> {
    if let [_, equals, value, ..] = tokens
        && equals.is("=")
        && ["true", "false"].contains(&value.text)
    {
        return Some(Type::Bool);
    }
    let value = tokens.get(1..)?.iter().take(3).position(|token| token.kind == TokenKind::Number)? + 1;
    let dimension = match tokens.get(value + 1) {
        Some(unit) if unit.kind == TokenKind::Unit => parse_unit(&unit.text.replace('*', " ")).ok()?.dimension(),
        _ => Dimension::NUMBER,
    };
    Some(Type::Scalar(dimension))
}
