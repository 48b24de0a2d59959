//! The formatter. It changes only blanks and line breaks.
//!
//! It works on tokens and keeps all of them, including comments, in their order. Only the beginnings of statements come
//! from the grammar, so a new construct needs no change here. A statement that the author broke stays broken. A block
//! on one line stays there if it fits. Everything else follows from the tokens alone, so formatting is idempotent.
//!
//! Why: docs/decisions/editors.md#the-formatter-works-on-tokens.

mod align;
mod line;
mod line_break;
mod spacing;
mod statement;
mod structure;
mod token;

pub(super) use token::{Kind as TokenKind, Token, tokens};

use crate::diagnostic::{Diagnostic, Source, Span};

use super::grammar;
use super::recover::faults;

/// Formats the text of a policy by the rules of `docs/language.md`.
///
/// # Errors
/// The syntax errors that prevent parsing, or the report that the formatted text would be too long. Names, types and
/// units are not checked.
///
/// ```
/// use vibrissa::{diagnostic::Source, policy::format};
/// let source = Source::new("still.fsm", "machine still initial  Still state Still{stop} # at last");
/// assert_eq!(format(&source)?, "machine still\ninitial Still\nstate Still { stop }  # at last\n");
/// # Ok::<(), Vec<vibrissa::diagnostic::Diagnostic>>(())
/// ```
pub fn format(source: &Source) -> Result<String, Vec<Diagnostic>> {
    let pairs = grammar::parse(source).map_err(|_| faults(source))?;
    let structure = structure::structure(token::tokens(&source.text), &statement::starts(pairs));
    let mut lines = line_break::break_lines(&structure);
    line::separate(&mut lines);
    align::align(&mut lines);
    let text = line::render(&lines);
    if text.len() > grammar::LENGTH_LIMIT {
        let everything = Span::new(0, source.text.len());
        return Err(vec![
            Diagnostic::error(
                "P0102",
                "the formatted policy is too long",
                everything,
                "formatted, this exceeds the size of a policy",
            )
            .hint("use less nesting, which shortens the indentation"),
        ]);
    }
    Ok(text)
}

/// The part of a statement on one line, without comments. All layouts of a policy give the same text.
pub(super) fn on_one_line(part: &str) -> String {
    let mut tokens = token::tokens(part);
    tokens.retain(|token| token.kind != TokenKind::Comment);
    let structure = structure::structure(tokens, &[]);
    let mut text = String::new();
    let mut before = None;
    for element in &structure.elements {
        if before.is_some_and(|before| spacing::is_apart(before, element)) {
            text.push(' ');
        }
        text.push_str(element.token.text);
        before = Some(element);
    }
    text
}

/// Keywords that can occur in an item outside of all brackets, except the one with which it begins.
const WITHIN_ITEMS: [&str; 7] = ["in", "and", "or", "not", "true", "false", "body"];

/// The comment at the end of a line that begins with the name of an item, if it belongs to this item. It does if it
/// follows the end of the item, or directly follows its opening brace.
pub(super) fn comment_behind(line: &str) -> Option<&str> {
    let (mut open, mut is_opened) = (0_usize, false);
    // One token after the other, because the line may be as long as the text.
    let (mut tokens, mut at) = (Vec::new(), 0);
    while let Some((token, end)) = token::next(line, at, &tokens) {
        at = end;
        tokens.push(token);
        match token.kind {
            token::Kind::Comment => return (open == 0 || is_opened).then_some(token.text),
            token::Kind::Keyword if open == 0 && !WITHIN_ITEMS.contains(&token.text) => return None,
            _ if token.is("(") || token.is("{") => open += 1,
            _ if token.is(")") || token.is("}") => open = open.saturating_sub(1),
            _ => {}
        }
        is_opened = open == 1 && token.is("{");
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn any_text_has_a_layout(text in "(\\PC|\n|\t| |[-a-z0-9:{}()|\"#*/.,<>=]){0,200}", starts in any::<[u8; 8]>()) {
            let mut starts = starts.map(usize::from);
            starts.sort_unstable();
            let tokens = token::tokens(&text);
            let covered: usize = tokens.iter().map(|token| token.text.len()).sum();
            prop_assert!(covered <= text.len());
            let mut lines = line_break::break_lines(&structure::structure(tokens, &starts));
            line::separate(&mut lines);
            align::align(&mut lines);
            line::render(&lines);
        }
    }
}
