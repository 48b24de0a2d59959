//! The tree of a text: the matched rules of the grammar in a flat list, with all tokens.
//!
//! Pest's own pairs count references and include trailing blanks.

use pest::Token;

use vibrissa_text::diagnostic::Span;

use super::grammar::{Rule, word_of};

/// A matched rule. In a list, its inner matches follow it directly.
#[derive(Debug, Clone, Copy)]
pub(super) struct Match {
    rule: Rule,
    /// Span in the text.
    span: Span,
    /// Number of inner matches, at all levels.
    inner: usize,
}

/// All matches in the order of the text.
///
/// Pest includes blanks and comments after the last part. Here the span ends with the last part, or with the closing
/// quote of a string.
pub(super) fn flatten(pairs: pest::iterators::Pairs<'_, Rule>) -> Vec<Match> {
    let tokens = pairs.tokens();
    let mut all: Vec<Match> = Vec::with_capacity(tokens.len() / 2);
    // The rules that have begun and not ended.
    let mut begun = Vec::new();
    let (mut end, mut has_parts) = (0, false);
    for token in tokens {
        match token {
            Token::Start { rule, pos } => {
                begun.push(all.len());
                all.push(Match { rule, span: Span::new(pos.pos(), pos.pos()), inner: 0 });
                has_parts = false;
            }
            Token::End { rule, pos } => {
                if !has_parts || rule == Rule::text {
                    end = pos.pos();
                }
                has_parts = true;
                let Some(index) = begun.pop() else { continue };
                let inner = all.len() - index - 1;
                all[index] = Match { rule, span: Span::new(all[index].span.start, end), inner };
            }
        }
    }
    all
}

/// The matches without inner ones, in the order of the text. A string is whole.
pub(super) fn leaves(all: &[Match]) -> impl Iterator<Item = (Rule, Span)> {
    let is_leaf = |found: &&Match| found.rule == Rule::text || found.inner == 0 && found.rule != Rule::text_inner;
    all.iter().filter(is_leaf).map(|found| (found.rule, found.span))
}

/// The first bytes of all items of a file and of all elements in its braces, in ascending order.
///
/// Every element that the grammar has between an opening and a closing brace counts. Therefore this code names no
/// construct.
pub(super) fn starts(all: &[Match]) -> Vec<usize> {
    let mut starts = Vec::new();
    for (index, found) in all.iter().enumerate() {
        let mut inside = found.rule == Rule::file;
        let mut at = index + 1;
        while let Some(part) = all.get(at).filter(|_| at <= index + found.inner) {
            match part.rule {
                Rule::open_brace => inside = true,
                Rule::close_brace => inside = false,
                _ if inside => starts.push(part.span.start),
                _ => {}
            }
            at += part.inner + 1;
        }
    }
    starts.sort_unstable();
    starts
}

/// A matched rule in its text.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pair<'i> {
    found: &'i Match,
    /// The inner matches.
    inner: &'i [Match],
    text: &'i str,
    /// First byte of the text in the whole source.
    start: usize,
}

impl<'i> Pair<'i> {
    pub(super) fn as_rule(self) -> Rule {
        self.found.rule
    }

    pub(super) fn as_str(self) -> &'i str {
        self.text.get(self.found.span.start..self.found.span.end).unwrap_or_default()
    }

    /// Span in the whole source.
    pub(super) fn span(self) -> Span {
        Span::new(self.start + self.found.span.start, self.start + self.found.span.end)
    }

    pub(super) fn into_inner(self) -> Pairs<'i> {
        Pairs::new(self.inner, self.text, self.start)
    }
}

/// Matches at one level, in the order of the text, without the words and marks that the syntax tree does not need.
#[derive(Debug, Clone)]
pub(super) struct Pairs<'i> {
    /// The remaining matches with their inner ones. The first is needed.
    rest: &'i [Match],
    text: &'i str,
    start: usize,
}

impl<'i> Pairs<'i> {
    /// All matches in a text that begins at the byte `start` of the source.
    pub(super) fn new(all: &'i [Match], text: &'i str, start: usize) -> Self {
        Self { rest: needed(all), text, start }
    }

    /// The rule of the next match.
    pub(super) fn rule(&self) -> Option<Rule> {
        Some(self.rest.first()?.rule)
    }
}

impl<'i> Iterator for Pairs<'i> {
    type Item = Pair<'i>;

    fn next(&mut self) -> Option<Pair<'i>> {
        let (found, behind) = self.rest.split_first()?;
        let (inner, rest) = behind.split_at_checked(found.inner)?;
        self.rest = needed(rest);
        Some(Pair { found, inner, text: self.text, start: self.start })
    }
}

/// The matches from the first on that the syntax tree needs. A match that it does not need has no inner ones.
fn needed(mut rest: &[Match]) -> &[Match] {
    while let Some((first, behind)) = rest.split_first()
        && is_marker(first.rule)
    {
        rest = behind;
    }
    rest
}

/// True if a rule is a word or a mark that the syntax tree does not need.
fn is_marker(rule: Rule) -> bool {
    let is_read = matches!(
        rule,
        Rule::kw_whisker
            | Rule::kw_resume
            | Rule::kw_body
            | Rule::kw_true
            | Rule::kw_false
            | Rule::kw_and
            | Rule::kw_or
            | Rule::kw_not
            | Rule::cw_fitted
    );
    let is_mark = matches!(
        rule,
        Rule::open
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
    );
    is_mark || word_of(rule).is_some() && !is_read
}
