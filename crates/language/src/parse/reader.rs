//! A reader of the inner pairs of a pair.

use crate::ast::{Expression, Name};
use crate::grammar::Rule;
use crate::parse_tree::{Pair, Pairs};
use vibrissa_text::diagnostic::Span;

use super::{Parsed, choice, climb, internal, named, named_value};

/// The inner pairs of a pair, read in order.
pub(super) struct Reader<'i> {
    /// The pair itself.
    whole: Pair<'i>,
    /// The remaining inner pairs.
    rest: Pairs<'i>,
}

impl<'i> Reader<'i> {
    pub(super) fn new(pair: Pair<'i>) -> Self {
        Self { whole: pair, rest: pair.into_inner() }
    }

    /// Span of the pair.
    pub(super) fn span(&self) -> Span {
        self.whole.span()
    }

    pub(super) fn peek(&self) -> Option<Pair<'i>> {
        self.rest.clone().next()
    }

    pub(super) fn has(&self, rule: Rule) -> bool {
        self.rest.rule() == Some(rule)
    }

    pub(super) fn next(&mut self) -> Parsed<Pair<'i>> {
        self.rest().ok_or_else(|| internal(self.span()))
    }

    /// The next pair. `None` at the end.
    pub(super) fn rest(&mut self) -> Option<Pair<'i>> {
        self.rest.next()
    }

    pub(super) fn take(&mut self, rule: Rule) -> Parsed<Pair<'i>> {
        let pair = self.next()?;
        if pair.as_rule() == rule { Ok(pair) } else { Err(internal(pair.span())) }
    }

    pub(super) fn name(&mut self) -> Parsed<Name> {
        Ok(named(self.take(Rule::name)?))
    }

    /// All names at the current position.
    pub(super) fn names(&mut self) -> Parsed<Vec<Name>> {
        let mut names = Vec::new();
        while self.has(Rule::name) {
            names.push(self.name()?);
        }
        Ok(names)
    }

    pub(super) fn expression(&mut self) -> Parsed<Expression> {
        let mut inner = Reader::new(self.take(Rule::expression)?);
        if inner.has(Rule::choice) { choice(inner.next()?) } else { climb(&mut inner, 0) }
    }

    pub(super) fn values(&mut self) -> Parsed<Option<Vec<Expression>>> {
        if self.has(Rule::values) { values(self.next()?).map(Some) } else { Ok(None) }
    }
}

pub(super) fn values(pair: Pair<'_>) -> Parsed<Vec<Expression>> {
    let mut reader = Reader::new(pair);
    let mut values = Vec::new();
    loop {
        if reader.has(Rule::expression) {
            values.push(reader.expression()?);
        } else if reader.has(Rule::named) {
            values.push(named_value(reader.next()?)?);
        } else {
            return Ok(values);
        }
    }
}
