//! Descriptions of items in comments, and the texts of contracts.

use std::sync::Arc;

use vibrissa_text::diagnostic::{Source, Span};

use super::ast;
use super::format;
use super::load::Files;
use super::lower::Lowered;
use super::scan::{is_word, scan_all};
use super::words::reserved;
use vibrissa_runtime::machine::{Contract, DESCRIPTION_LIMIT};

/// The description of the item whose name is at `name`: the comment at the end of its line, or else the comment lines
/// directly above.
///
/// The result is one line without control characters, of at most [`DESCRIPTION_LIMIT`] bytes.
pub(super) fn description(source: &Source, name: Span) -> Option<String> {
    whole_description(source, name).map(bounded)
}

/// The [`description`] of any length.
pub(super) fn whole_description(source: &Source, name: Span) -> Option<String> {
    let part = source.part_span(source.part_at(name.start));
    let behind = source.slice(Span::new(name.start, part.end));
    let line = &behind[..behind.find('\n').unwrap_or(behind.len())];
    let text = match comment_behind(line) {
        Some(comment) => comment_text(comment),
        None => comment_above(source.slice(Span::new(part.start, name.start))),
    };
    (!text.is_empty()).then_some(text)
}

/// The comment at the end of a line that begins with the name of an item, if it belongs to this item. It does if it
/// follows the end of the item, or directly follows its opening brace.
fn comment_behind(line: &str) -> Option<&str> {
    let (mut open, mut is_opened) = (0_usize, false);
    // One lexeme after the other, because the line may be as long as the text.
    for lexeme in scan_all(line) {
        match lexeme.text {
            comment if lexeme.is_comment() => return (open == 0 || is_opened).then_some(comment),
            word if open == 0 && reserved(word).is_some_and(|word| !word.continues()) => return None,
            "(" | "{" => open += 1,
            ")" | "}" => open = open.saturating_sub(1),
            _ => {}
        }
        is_opened = open == 1 && lexeme.text == "{";
    }
    None
}

/// The comment lines above an item. `before` is the text before its name.
fn comment_above(before: &str) -> String {
    let mut head = before.trim_end();
    // In a list of whiskers, the keyword precedes only the first.
    while let Some(others) = head.strip_suffix(',') {
        head = others.trim_end().trim_end_matches(is_word).trim_end();
    }
    let head = head.trim_end_matches(is_word);
    let line_start = head.rfind('\n').map_or(0, |end| end + 1);
    if !head[line_start..].trim().is_empty() {
        return String::new();
    }
    let lines = head[..line_start].lines().rev().map(str::trim).take_while(|line| line.starts_with('#'));
    let lines: Vec<String> = lines.map(comment_text).collect();
    lines.into_iter().rev().filter(|line| !line.is_empty()).collect::<Vec<_>>().join(" ")
}

/// Adds descriptions to the parameters of a program, texts to its contracts, and names to the values of its messages.
pub(super) fn describe(lowered: &mut Lowered, source: &Source, files: &Files) {
    let (program, file) = (&mut lowered.program, &files.main);
    for (parameter, written) in program.parameters.iter_mut().zip(&file.parameters) {
        parameter.description = description(source, written.name.span).unwrap_or_default();
    }
    let give_texts = |contracts: &mut [Contract], written: &[ast::Contract]| {
        for (contract, written) in contracts.iter_mut().zip(written) {
            contract.text = Arc::from(bounded(format::on_one_line(source.slice(written.span))));
        }
    };
    give_texts(&mut program.contracts, &file.contracts);
    for (state, written) in program.states.iter_mut().zip(&files.machine.states) {
        give_texts(&mut state.contracts, &written.contracts);
    }
    for (message, spans) in program.outputs.messages.iter_mut().zip(&lowered.logged) {
        for (value, span) in message.values.iter_mut().zip(spans) {
            value.name = Arc::from(bounded(format::on_one_line(source.slice(*span))));
        }
    }
}

/// A comment without its mark, on one line.
fn comment_text(comment: &str) -> String {
    let words =
        comment.trim().trim_start_matches('#').split(|letter: char| letter.is_whitespace() || letter.is_control());
    words.filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ")
}

fn bounded(mut text: String) -> String {
    const ELLIPSIS: &str = "\u{2026}";
    if text.len() > DESCRIPTION_LIMIT {
        text.truncate(text.floor_char_boundary(DESCRIPTION_LIMIT - ELLIPSIS.len()));
        text += ELLIPSIS;
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn of(text: &str) -> Option<String> {
        let start = text.find("here").unwrap_or(0);
        description(&Source::new("a", text), Span::new(start, start + 4))
    }

    #[test]
    fn an_item_is_described_behind_it_or_above_it() {
        for (text, expected) in [
            ("param here = 1 m  # how far", Some("how far")),
            ("# how far\nparam here = 1 m\n", Some("how far")),
            ("  #  how\n  ## far\n  #\n  param here = 1 m", Some("how far")),
            ("# of all\nparam here = 1 m  # how far", Some("how far")),
            ("# the file\n\nparam here = 1 m", None),
            ("param a = 1 m  # of the other\nparam here = 1 m", None),
            ("state here {  # what it does\n  stop  # not this\n}", Some("what it does")),
            ("state here { when a -> Failure(\"#1\") }  # what it does", Some("what it does")),
            ("state here { when a -> Failure(\"#1\") }", None),
            ("#\nlet here = 1", None),
            ("let here = 1 #\ta\r\n", Some("a")),
            ("# both\nwhisker a, here", Some("both")),
            ("# one\nparam\n  here = 1", Some("one")),
            ("# two\nparam a = 1 param here = 2", None),
            ("param here = 1 param b = 2  # of b", None),
            ("let here = not a and b  # what it means", Some("what it means")),
            ("state here { stop  # this\n}", None),
            ("law here(w: whisker) {  # for one\n}", Some("for one")),
        ] {
            assert_eq!(of(text).as_deref(), expected, "{text}");
        }
    }

    #[test]
    fn the_comments_of_another_part_belong_to_that() {
        let mut source = Source::new("a", "machine a\n# the end of a");
        source.add("b", Ok("library b"));
        let start = source.part_span(1).start + 8;
        assert_eq!(description(&source, Span::new(start, start + 1)), None);
    }

    proptest! {
        #[test]
        fn a_description_is_one_bounded_line(text in "(\\PC|\n|\r|\t|#|here|\u{7}){0,60}", at in 0_usize..99, times in 1_usize..200) {
            let source = Source::new("a", text.replace("here", &"h\u{fc}re ".repeat(times)));
            if let Some(said) = description(&source, Span::new(at, at + 1)) {
                prop_assert!(!said.is_empty() && said.len() <= DESCRIPTION_LIMIT && !said.chars().any(char::is_control));
            }
        }
    }
}
