//! The inner pairs of a pair, taken in order.

use crate::diagnostic::Span;
use crate::policy::ast::{Expression, Name};
use crate::policy::grammar::Rule;
use crate::policy::pair::{Pair, Pairs, place};

use super::{Parsed, climb, internal, named};

/// The inner pairs of a pair, taken in order.
pub(super) struct Reader<'i> {
    /// The pair itself.
    whole: Pair<'i>,
    /// The next of those in it.
    next: Option<Pair<'i>>,
    /// Those behind the next.
    pairs: Pairs<'i>,
}

impl<'i> Reader<'i> {
    pub(super) fn new(pair: Pair<'i>) -> Self {
        let mut pairs = pair.clone().into_inner();
        Self { whole: pair, next: meaningful(&mut pairs), pairs }
    }

    /// Where the pair stands.
    pub(super) fn span(&self) -> Span {
        place(&self.whole)
    }

    pub(super) fn peek(&self) -> Option<&Pair<'i>> {
        self.next.as_ref()
    }

    pub(super) fn has(&self, rule: Rule) -> bool {
        self.peek().is_some_and(|pair| pair.as_rule() == rule)
    }

    pub(super) fn next(&mut self) -> Parsed<Pair<'i>> {
        self.rest().ok_or_else(|| internal(self.span()))
    }

    /// The next pair, until there is none.
    pub(super) fn rest(&mut self) -> Option<Pair<'i>> {
        let pair = self.next.take()?;
        self.next = meaningful(&mut self.pairs);
        Some(pair)
    }

    pub(super) fn take(&mut self, rule: Rule) -> Parsed<Pair<'i>> {
        let pair = self.next()?;
        if pair.as_rule() == rule { Ok(pair) } else { Err(internal(place(&pair))) }
    }

    pub(super) fn name(&mut self) -> Parsed<Name> {
        Ok(named(&self.take(Rule::name)?))
    }

    /// All names that come next.
    pub(super) fn names(&mut self) -> Parsed<Vec<Name>> {
        let mut names = Vec::new();
        while self.has(Rule::name) {
            names.push(self.name()?);
        }
        Ok(names)
    }

    pub(super) fn expression(&mut self) -> Parsed<Expression> {
        climb(&mut Reader::new(self.take(Rule::expression)?), 0)
    }

    pub(super) fn values(&mut self) -> Parsed<Option<Vec<Expression>>> {
        if self.has(Rule::values) { values(self.next()?).map(Some) } else { Ok(None) }
    }
}

pub(super) fn values(pair: Pair<'_>) -> Parsed<Vec<Expression>> {
    let mut reader = Reader::new(pair);
    let mut values = Vec::new();
    while reader.has(Rule::expression) {
        values.push(reader.expression()?);
    }
    Ok(values)
}

/// The next pair that carries something; words and signs that only mark a place do not.
fn meaningful<'i>(pairs: &mut Pairs<'i>) -> Option<Pair<'i>> {
    pairs.find(|pair| !is_marker(pair.as_rule()))
}

/// Whether a pair is a word or a sign that only marks a place.
fn is_marker(rule: Rule) -> bool {
    matches!(
        rule,
        Rule::kw_machine
            | Rule::kw_library
            | Rule::kw_use
            | Rule::kw_by
            | Rule::kw_param
            | Rule::kw_initial
            | Rule::kw_let
            | Rule::kw_law
            | Rule::kw_state
            | Rule::kw_always
            | Rule::kw_failsafe
            | Rule::kw_when
            | Rule::kw_after
            | Rule::kw_for
            | Rule::kw_in
            | Rule::kw_of
            | Rule::kw_if
            | Rule::kw_else
            | Rule::kw_do
            | Rule::kw_record
            | Rule::kw_mark
            | Rule::kw_steer
            | Rule::kw_along
            | Rule::kw_at
            | Rule::kw_facing
            | Rule::kw_turning
            | Rule::kw_hold
            | Rule::kw_stop
            | Rule::kw_var
            | Rule::kw_set
            | Rule::kw_entry
            | Rule::kw_exit
            | Rule::kw_test
            | Rule::kw_expect
            | Rule::open
            | Rule::close
            | Rule::open_brace
            | Rule::close_brace
            | Rule::bar
            | Rule::comma
            | Rule::colon
            | Rule::dot
            | Rule::dots
            | Rule::equals
            | Rule::arrow
            | Rule::EOI
    )
}
