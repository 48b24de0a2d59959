//! The formatter. It changes only blanks and line breaks.
//!
//! It keeps all tokens of the tree, including comments, in their order. The beginnings of statements come from the tree,
//! so a new construct needs no change here. A statement that the author broke stays broken. A block
//! on one line stays there if it fits. Everything else follows from the tokens alone, so formatting is idempotent.
//!
//! Why: docs/decisions/editors.md#the-formatter-works-on-tokens.

mod align;
mod line;
mod line_break;
mod spacing;
mod structure;

use vibrissa_text::diagnostic::{Diagnostic, Source, Span};

use super::grammar;
use super::parse_tree::starts;
use super::recover::faults;
use super::token::{Kind, tokens, tokens_of};

/// Formats the text of a policy by the rules of `docs/language-semantics.md`.
///
/// # Errors
/// The syntax errors that prevent parsing, or the report that the formatted text would be too long. Names, types and
/// units are not checked.
///
/// ```
/// use vibrissa_text::diagnostic::Source;
/// use vibrissa_language::format;
/// let source = Source::new("still.fsm", "machine still initial  Still state Still{stop} # at last");
/// assert_eq!(format(&source)?, "machine still\ninitial Still\nstate Still { stop }  # at last\n");
/// # Ok::<(), Vec<vibrissa_text::diagnostic::Diagnostic>>(())
/// ```
pub fn format(source: &Source) -> Result<String, Vec<Diagnostic>> {
    let tree = grammar::matches(source).map_err(|_| faults(source))?;
    let structure = structure::structure(tokens_of(&source.text, &tree), &starts(&tree));
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
    let mut tokens = tokens(part);
    tokens.retain(|token| token.kind != Kind::Comment);
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_part_of_a_policy_has_the_layout_that_it_has_in_the_whole() {
        for part in [
            "always w.touching within -1 s",
            "always f(1 s) within -t",
            "always a.b or 2 mm within 2 - t",
            "if a then |b| else -c",
        ] {
            assert_eq!(on_one_line(&part.replace(' ', "\n ")), part);
        }
    }

    proptest! {
        #[test]
        fn any_text_has_a_layout(text in "(\\PC|\n|\t| |[-a-z0-9:{}()|\"#*/.,<>=]){0,200}", starts in any::<[u8; 8]>()) {
            let mut starts = starts.map(usize::from);
            starts.sort_unstable();
            let tokens = tokens(&text);
            let covered: usize = tokens.iter().map(|token| token.text.len()).sum();
            prop_assert!(covered <= text.len());
            let mut lines = line_break::break_lines(&structure::structure(tokens, &starts));
            line::separate(&mut lines);
            align::align(&mut lines);
            line::render(&lines);
        }
    }
}
