//! The tokens of a policy: those of the grammar, and comments.

use crate::grammar::{is_keyword, is_word};

/// Marks with more than one character.
const LONG_MARKS: [&str; 6] = ["->", "<=", ">=", "==", "!=", ".."];

/// The kind of a token.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A name.
    Name,
    /// A keyword.
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

/// A token.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Token<'t> {
    pub(crate) kind: Kind,
    pub(crate) text: &'t str,
    /// Its first byte in the text.
    pub(crate) start: usize,
    /// True if blanks or line ends precede the token.
    pub(crate) apart: bool,
    /// Number of line ends between the token and the previous one.
    pub(crate) line_ends: usize,
}

impl Token<'_> {
    pub(crate) fn is(&self, mark: &str) -> bool {
        self.kind == Kind::Mark && self.text == mark
    }
}

/// The tokens of any text, valid or not.
pub(crate) fn tokens(text: &str) -> Vec<Token<'_>> {
    let (mut tokens, mut at) = (Vec::new(), 0);
    while let Some((token, end)) = next(text, at, &tokens) {
        tokens.push(token);
        at = end;
    }
    tokens
}

/// The token at or behind `at`, and the end of its text, after those before it.
pub(crate) fn next<'t>(text: &'t str, at: usize, tokens: &[Token<'t>]) -> Option<(Token<'t>, usize)> {
    let rest = &text[at..];
    let blanks = &rest[..rest.len() - rest.trim_start_matches([' ', '\t', '\r', '\n']).len()];
    let rest = &rest[blanks.len()..];
    let first = rest.chars().next()?;
    let after_number =
        tokens.last().is_some_and(|last| last.kind == Kind::Number) && blanks.bytes().all(|blank| blank == b' ');
    let (kind, length) = match first {
        '#' => (Kind::Comment, rest.find('\n').unwrap_or(rest.len())),
        '"' => (Kind::Text, rest[1..].find(['"', '\n']).map_or(rest.len(), |end| end + 2)),
        '0'..='9' => (Kind::Number, number(rest)),
        _ if let Some(length) = contextual_word(rest, tokens) => (Kind::Keyword, length),
        _ if after_number && unit(rest) > 0 => (Kind::Unit, unit(rest)),
        _ if is_family_due(tokens) && is_word(first) => (Kind::Name, family(rest)),
        _ if is_word(first) => {
            let length = rest.find(|letter| !is_word(letter)).unwrap_or(rest.len());
            (if is_keyword(&rest[..length]) { Kind::Keyword } else { Kind::Name }, length)
        }
        _ => {
            let long = LONG_MARKS.iter().find(|&&mark| rest.starts_with(mark));
            (Kind::Mark, long.map_or(first.len_utf8(), |mark| mark.len()))
        }
    };
    let start = at + blanks.len();
    let text = &rest[..length];
    let text = if kind == Kind::Comment { text.trim_end_matches([' ', '\t', '\r']) } else { text };
    let line_ends = blanks.bytes().filter(|&blank| blank == b'\n').count();
    Some((Token { kind, text, start, apart: !blanks.is_empty(), line_ends }, start + length))
}

/// Length of a keyword at the beginning of `text` that is a name anywhere else: `contour` before a name or `of`,
/// `points` after a number behind `of`, `apart` after a unit, `within` after a value, and `on` and `tell` before a name.
fn contextual_word(text: &str, tokens: &[Token<'_>]) -> Option<usize> {
    let word = text.split(|letter| !is_word(letter)).next().unwrap_or_default();
    let mut before = tokens.iter().rev().filter(|token| token.kind != Kind::Comment);
    let is_word = match (word, before.next()) {
        ("contour", Some(last)) if !last.is(".") && !last.is(":") => {
            let next = text[word.len()..].trim_start().split(|letter| !is_word(letter)).next().unwrap_or_default();
            next == "of"
                || next.starts_with(|letter: char| letter.is_alphabetic() || letter == '_') && !is_keyword(next)
        }
        ("points", Some(last)) => {
            last.kind == Kind::Number && before.next().is_some_and(|of| of.kind == Kind::Keyword && of.text == "of")
        }
        ("log", Some(last)) if !last.is(".") && !last.is(":") => text[word.len()..].trim_start().starts_with('"'),
        ("on" | "tell" | "plot", Some(last)) if !last.is(".") && !last.is(":") => {
            let next = text[word.len()..].trim_start().split(|letter| !is_word(letter)).next().unwrap_or_default();
            next.starts_with(|letter: char| letter.is_alphabetic() || letter == '_') && !is_keyword(next)
        }
        ("apart", Some(last)) => last.kind == Kind::Unit,
        ("within", Some(last)) => {
            matches!(last.kind, Kind::Number | Kind::Unit | Kind::Name)
                || [")", "|", "true", "false"].contains(&last.text)
        }
        _ => false,
    };
    is_word.then_some(word.len())
}

/// True if the next word is the name of a family: after `property "title" over`.
fn is_family_due(tokens: &[Token<'_>]) -> bool {
    let mut before = tokens.iter().rev().filter(|token| token.kind != Kind::Comment);
    before.next().is_some_and(|over| over.text == "over") && before.next().is_some_and(|title| title.kind == Kind::Text)
}

/// Length of the name of a family at the beginning of `text`. It may contain `-`.
fn family(text: &str) -> usize {
    text.find(|letter| !is_word(letter) && letter != '-').unwrap_or(text.len())
}

/// Length of the number at the beginning of `text`: digits, with an optional fraction and exponent.
fn number(text: &str) -> usize {
    let digits = |at: usize| text[at..].bytes().take_while(u8::is_ascii_digit).count();
    let mut length = digits(0);
    if text[length..].starts_with('.') && digits(length + 1) > 0 {
        length += 1 + digits(length + 1);
    }
    if text[length..].starts_with(['e', 'E']) {
        let sign = usize::from(text[length + 1..].starts_with(['+', '-']));
        let exponent = digits(length + 1 + sign);
        if exponent > 0 {
            length += 1 + sign + exponent;
        }
    }
    length
}

/// Length of the unit at the beginning of `text`. 0 if there is none.
fn unit(text: &str) -> usize {
    let mut length = unit_name(text);
    while length > 0 && text[length..].starts_with(['/', '*']) {
        match unit_name(&text[length + 1..]) {
            0 => break,
            factor => length += 1 + factor,
        }
    }
    length
}

/// Length of the unit factor with its exponent at the beginning of `text`. 0 if there is none.
fn unit_name(text: &str) -> usize {
    let mut length = text.bytes().take_while(u8::is_ascii_alphabetic).count();
    if is_keyword(&text[..length]) {
        return 0;
    }
    if length > 0 && text[length..].starts_with('^') {
        let sign = usize::from(text[length + 1..].starts_with('-'));
        match text[length + 1 + sign..].bytes().take_while(u8::is_ascii_digit).count() {
            0 => {}
            digits => length += 1 + sign + digits,
        }
    }
    if text[length..].starts_with(|letter: char| letter.is_ascii_alphanumeric() || letter == '_') { 0 } else { length }
}
