//! Tokens: the leaves of the tree of a text, with comments, blanks and line ends.

use super::grammar::{self, Rule, word_of};
use super::parse_tree::{Match, leaves};
use vibrissa_text::diagnostic::Span;

/// The kind of a token.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A name.
    Name,
    /// A word of the language.
    Keyword,
    Number,
    /// The unit after a number, with all its factors.
    Unit,
    /// A string with its quotation marks.
    Text,
    /// A comment without trailing blanks.
    Comment,
    /// A bracket, an operator or a separator.
    Mark,
}

impl Kind {
    fn of(rule: Rule) -> Self {
        match rule {
            Rule::name | Rule::misfit | Rule::family | Rule::foreign => Self::Name,
            Rule::number => Self::Number,
            Rule::unit => Self::Unit,
            Rule::text | Rule::unclosed => Self::Text,
            Rule::reserved => Self::Keyword,
            _ if word_of(rule).is_some() => Self::Keyword,
            _ => Self::Mark,
        }
    }
}

/// A token.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Token<'t> {
    pub(super) kind: Kind,
    pub(super) text: &'t str,
    /// Its first byte in the text.
    pub(super) start: usize,
    /// True if blanks or line ends precede the token.
    pub(super) apart: bool,
    /// Number of line ends between the token and the previous one.
    pub(super) line_ends: usize,
}

impl Token<'_> {
    pub(super) fn is(&self, mark: &str) -> bool {
        self.kind == Kind::Mark && self.text == mark
    }

    pub(super) fn span(&self) -> Span {
        Span::new(self.start, self.start + self.text.len())
    }
}

/// The tokens of any text, valid or not, with comments.
pub(super) fn tokens(text: &str) -> Vec<Token<'_>> {
    tokens_of(text, &grammar::tokens(text))
}

/// The tokens of a text with these matches, with comments.
pub(super) fn tokens_of<'t>(text: &'t str, matches: &[Match]) -> Vec<Token<'t>> {
    let mut tokens = Vec::new();
    let mut end = 0;
    for (rule, span) in leaves(matches).chain([(Rule::EOI, Span::new(text.len(), text.len()))]) {
        let mut gap = text.get(end..span.start).unwrap_or_default();
        // Between two leaves there are only blanks and comments.
        while let Some((blanks, behind)) = gap.split_once('#') {
            let comment = behind.split('\n').next().unwrap_or_default();
            let start = span.start - behind.len() - 1;
            tokens.push(Token {
                kind: Kind::Comment,
                text: text[start..=start + comment.len()].trim_end_matches([' ', '\t', '\r']),
                start,
                apart: !blanks.is_empty(),
                line_ends: blanks.matches('\n').count(),
            });
            gap = &behind[comment.len()..];
        }
        let found = text.get(span.start..span.end).unwrap_or_default();
        if !found.is_empty() {
            tokens.push(Token {
                kind: Kind::of(rule),
                text: found,
                start: span.start,
                apart: !gap.is_empty(),
                line_ends: gap.matches('\n').count(),
            });
        }
        end = span.end;
    }
    tokens
}
