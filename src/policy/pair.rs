//! Pest's pairs with places that count from the beginning of all texts, not of their own file.

use pest::Token;

use crate::diagnostic::Span;

use super::grammar::Rule;

/// What the grammar has found for one of its rules.
#[derive(Debug, Clone)]
pub(super) struct Pair<'i> {
    pair: pest::iterators::Pair<'i, Rule>,
    /// Where the file begins.
    start: usize,
}

impl<'i> Pair<'i> {
    pub(super) fn as_rule(&self) -> Rule {
        self.pair.as_rule()
    }

    pub(super) fn as_str(&self) -> &'i str {
        self.pair.as_str()
    }

    pub(super) fn into_inner(self) -> Pairs<'i> {
        Pairs { pairs: self.pair.into_inner(), start: self.start }
    }
}

/// Pairs in the order of the text.
#[derive(Debug, Clone)]
pub(super) struct Pairs<'i> {
    pairs: pest::iterators::Pairs<'i, Rule>,
    start: usize,
}

impl<'i> Pairs<'i> {
    /// The pairs of a file that begins at `start`.
    pub(super) fn new(pairs: pest::iterators::Pairs<'i, Rule>, start: usize) -> Self {
        Self { pairs, start }
    }
}

impl<'i> Iterator for Pairs<'i> {
    type Item = Pair<'i>;

    fn next(&mut self) -> Option<Pair<'i>> {
        Some(Pair { pair: self.pairs.next()?, start: self.start })
    }
}

/// Where a pair stands. The blanks and comments behind its last part, which pest counts in, do not belong to it; the quote at
/// the end of a text, which is no part, does.
pub(super) fn place(pair: &Pair<'_>) -> Span {
    let span = pair.pair.as_span();
    let mut end = span.end();
    // From behind: the ends of the pair, of its last part, of the last part of that.
    for token in pair.pair.clone().tokens().rev() {
        let Token::End { rule, pos } = token else { break };
        end = pos.pos();
        if rule == Rule::text {
            break;
        }
    }
    Span::new(pair.start + span.start(), pair.start + end)
}
