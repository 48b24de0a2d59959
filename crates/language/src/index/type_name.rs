//! Type names among tokens.

use crate::ast::{Binary, Name, TypeName};
use crate::token::{Kind as TokenKind, Token};

/// The type that is named from the token `at` on, and the index of its last token: `length`, `vector of length`,
/// `angular_speed / length`.
pub(super) fn type_name(tokens: &[Token<'_>], at: usize) -> Option<(TypeName, usize)> {
    let name = |at: usize| {
        let token = tokens
            .get(at)
            .filter(|token| matches!(token.kind, TokenKind::Name | TokenKind::Keyword | TokenKind::Unit))?;
        Some(Name { text: token.text.to_owned(), span: token.span() })
    };
    let (base, mut last) = (name(at)?, at);
    let is = |at: usize, text: &str| tokens.get(at).is_some_and(|token| token.text == text);
    let of = if is(last + 1, "of") { name(last + 2) } else { None };
    last += if of.is_some() { 2 } else { 0 };
    let mut factors = Vec::new();
    loop {
        let operator = match tokens.get(last + 1) {
            Some(token) if token.is("*") => Binary::Multiply,
            Some(token) if token.is("/") => Binary::Divide,
            _ => break,
        };
        let Some(factor) = name(last + 2) else { break };
        factors.push((operator, factor));
        last += 2;
    }
    Some((TypeName { base, of, factors }, last))
}
