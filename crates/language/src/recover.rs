//! Recovery from syntax errors, so that one does not hide the others.
//!
//! The erroneous part is overwritten with blanks, so all positions stay valid. Then the rest is parsed again. First the
//! statement is overwritten, and if the error remains, the whole item. The number of attempts is bounded, and each
//! takes time linear in the text.
//!
//! Why: docs/decisions/editors.md#syntax-errors-are-blanked-out.

use std::borrow::Cow;
use std::collections::HashSet;

use vibrissa_text::diagnostic::{Diagnostic, FAULT_LIMIT, Source, Span};

use super::ast::File;
use super::grammar::{brackets, is_before_expression, is_keyword};
use super::parse::parse;
use super::scan::{Lexeme, are_braces_balanced, is_word, scan};
use super::word::Word;
use super::words::{reserved, word};

/// The maximum number of parses of a text.
const ATTEMPTS: usize = 20;

/// The omitted parts of a policy's texts, with the reasons.
#[derive(Debug, Default)]
pub(super) struct Recovery {
    /// The errors. Empty if nothing was omitted.
    pub(super) faults: Vec<Diagnostic>,
    /// Words in the omitted parts that may be declared names.
    lost: HashSet<String>,
    /// True if the omitted parts may have imported names.
    lost_use: bool,
    /// True if the remaining text has an initial state.
    has_initial: bool,
}

/// The syntax errors of a text, in the order of their positions.
pub(super) fn faults(source: &Source) -> Vec<Diagnostic> {
    let mut recovery = Recovery::default();
    parse_all(source, 0, &mut recovery);
    recovery.join(source, Vec::new())
}

/// Parses the valid parts of a text whose first byte has the position `start`. `None` if nothing can be parsed.
pub(super) fn parse_all(source: &Source, start: usize, recovery: &mut Recovery) -> Option<File> {
    let mut rest = Cow::Borrowed(source);
    let mut candidates = Vec::new();
    let mut last = None;
    for _ in 0..ATTEMPTS {
        match parse(&rest, start) {
            Ok(file) => {
                recovery.has_initial |= !file.initial.is_empty();
                return Some(file);
            }
            Err(fault) => {
                let at = fault.primary.span.start.saturating_sub(start);
                // The same position again: the omitted part was too small.
                if last != Some(at) {
                    candidates = if is_local(&fault) { regions(&rest.text, at) } else { Vec::new() };
                    recovery.report(*fault);
                    last = Some(at);
                }
                // Omitting the same part again does not help.
                let is_new = |region: &Span| !rest.slice(*region).trim().is_empty();
                let index = candidates.iter().position(is_new)?;
                let region = candidates.remove(index);
                recovery.lost_use |= scan(rest.slice(region)).any(|lexeme| lexeme.text == "use");
                recovery.lost.extend(names(rest.slice(region)));
                rest = Cow::Owned(Source::new(rest.name.clone(), blanked(&rest.text, region)));
            }
        }
    }
    None
}

/// True if an error concerns its position, and not the text as a whole.
fn is_local(fault: &Diagnostic) -> bool {
    ["P0101", "P0104"].contains(&fault.code)
}

impl Recovery {
    /// Adds an error.
    pub(super) fn report(&mut self, fault: Diagnostic) {
        if self.faults.len() < FAULT_LIMIT {
            self.faults.push(fault);
        }
    }

    /// True if nothing was omitted.
    pub(super) fn is_whole(&self) -> bool {
        self.faults.is_empty()
    }

    /// True if something within a part of the texts was omitted.
    pub(super) fn has_syntax_fault(&self, within: Span) -> bool {
        let is_syntax = |code: &str| code.starts_with("P01");
        let is_within = |fault: &Diagnostic| (within.start..=within.end).contains(&fault.primary.span.start);
        self.faults.iter().any(|fault| is_syntax(fault.code) && is_within(fault))
    }

    /// All errors in the order of their positions: the syntax errors, and the other errors that are not their
    /// consequences.
    pub(super) fn join(mut self, source: &Source, mut faults: Vec<Diagnostic>) -> Vec<Diagnostic> {
        faults.retain(|fault| !self.explains(source, fault));
        faults.append(&mut self.faults);
        faults.sort_by_key(|fault| fault.primary.span.start);
        faults.truncate(FAULT_LIMIT);
        faults
    }

    /// True if an error is a consequence of the omitted parts.
    fn explains(&self, source: &Source, fault: &Diagnostic) -> bool {
        match fault.code {
            // An unknown name, or unknown memory.
            "P0201" | "P0406" => self.lost_use || self.lost.contains(source.slice(fault.primary.span)),
            // The omitted parts may declare whiskers, or connect exits.
            "P0412" | "P0421" => !self.faults.is_empty(),
            // The omitted parts may declare the initial state.
            "P0404" => !self.faults.is_empty() && !self.has_initial,
            _ => false,
        }
    }
}

/// Words of a text that may be declared names: all words after another word, such as `state` or a misspelling of it,
/// and all words after a comma.
fn names(text: &str) -> impl Iterator<Item = String> {
    let mut may_be_name = false;
    scan(text).filter_map(move |lexeme| {
        let word = lexeme.text;
        let is_word = word.starts_with(is_word);
        let is_name = is_word && may_be_name;
        may_be_name = is_word || word == ",";
        is_name.then(|| word.to_owned())
    })
}

/// The text with blanks in place of a span, with the same number of bytes.
fn blanked(text: &str, region: Span) -> String {
    let blanks = text[region.start..region.end].bytes().map(|byte| if byte == b'\n' { '\n' } else { ' ' });
    text[..region.start].chars().chain(blanks).chain(text[region.end..].chars()).collect()
}

/// The spans that may be omitted because of an error at `at`, the smallest first.
fn regions(text: &str, at: usize) -> Vec<Span> {
    let Ok(opened) = brackets(text) else { return Vec::new() };
    let (balanced, starts) = items(text);
    // The cause of a premature end is the bracket that is never closed.
    let at = if text[at.min(text.len())..].trim().is_empty() { opened.first().copied().unwrap_or(at) } else { at };
    let mut regions = Vec::new();
    if balanced
        && let Ok(opened) = brackets(&text[..at])
        && let Some(&brace) = opened.iter().rev().find(|&&bracket| text[bracket..].starts_with('{'))
    {
        let (starts, end) = statements(text, brace + 1);
        let is_whole = |region: &Span| are_braces_balanced(&text[region.start..region.end]);
        regions.extend(around(text, at, (&starts, Word::begins_part), (brace + 1, end)).into_iter().filter(is_whole));
    }
    // A file cannot be parsed without the machine's name.
    if let Some(first) = scan(text).skip_while(|lexeme| !lexeme.is_heading()).nth(2) {
        regions.extend(around(text, at, (&starts, Word::begins_item), (first.start, text.len())));
    }
    regions
}

/// The spans around `at` that may contain the error, among parts that begin at `starts`. Each part begins with a word
/// for which `begins` is true, or with a statement.
fn around(
    text: &str,
    at: usize,
    (starts, begins): (&[usize], fn(&Word) -> bool),
    (low, high): (usize, usize),
) -> Vec<Span> {
    if at < low || at > high {
        return Vec::new();
    }
    let before = starts.iter().copied().take_while(|&start| start < at).last().unwrap_or(low);
    let behind = starts.iter().copied().find(|&start| start > at).unwrap_or(high);
    let word = word(text[at..].split(|letter| !is_word(letter)).next().unwrap_or_default());
    let is_start = starts.contains(&at);
    if is_start && word.is_some_and(|word| begins(word) || word.begins_statement()) {
        // Either the previous part lacks its end, or this part is misplaced.
        vec![Span::new(before, at), Span::new(at, behind)]
    } else if is_start || indent(text, at).is_some_and(|own| Some(own) <= indent(text, before)) {
        vec![Span::new(at, behind), Span::new(before, behind)]
    } else {
        vec![Span::new(before, behind)]
    }
}

/// The indentation of the token at `at`, if it is the first of its line.
fn indent(text: &str, at: usize) -> Option<usize> {
    let line = text[..at].rsplit('\n').next()?;
    line.trim().is_empty().then_some(line.len())
}

/// Starts of the items after the machine's name, and true if all braces are closed.
///
/// Items begin outside of braces with their keywords. A misspelled keyword counts, too: a word at the beginning of a
/// line that is followed by another word. Statements between items also begin a line, with at most the indentation of
/// the previous item. In a text with unclosed braces, an item keyword counts at the beginning of a line. It must occur
/// only in items, or have at most the indentation of the previous item.
fn items(text: &str) -> (bool, Vec<usize>) {
    let is_balanced = are_braces_balanced(text);
    let (mut braces, mut parentheses, mut indent) = (0_usize, 0_usize, 0);
    let mut starts = Vec::new();
    let mut lexemes = scan(text).skip_while(|lexeme| !lexeme.is_heading()).skip(2).peekable();
    let mut before = "";
    while let Some(lexeme) = lexemes.next() {
        let word = lexeme.text;
        let is_value = word == "if" && is_before_expression(before);
        before = word;
        match word {
            "{" => braces += 1,
            "}" => braces = braces.saturating_sub(1),
            "(" => parentheses += 1,
            ")" => parentheses = parentheses.saturating_sub(1),
            _ if !word.starts_with(is_word) => {}
            _ => {
                let known = reserved(word);
                let is_item = known.is_some_and(Word::begins_item);
                let is_first = lexeme.indent.is_some();
                let is_outermost = lexeme.indent.is_some_and(|own| own <= indent);
                // With more indentation, or after another word, it belongs to a state, or to a `whisker` or an `else`
                // before its `if`.
                let begins = if is_value {
                    false
                } else if known.is_some_and(Word::begins_statement) {
                    is_outermost && (braces == 0 || !is_balanced)
                } else if is_item {
                    let is_inner = known.is_some_and(Word::begins_part);
                    let is_placed =
                        if is_inner && is_first { is_outermost } else { is_first || braces + parentheses == 0 };
                    is_placed && (braces == 0 || is_first && !is_balanced)
                } else if braces > 0 {
                    false
                } else {
                    let names = |next: &Lexeme<'_>| next.indent.is_none() && next.text.starts_with(is_word);
                    is_outermost && !known.is_some_and(Word::continues) && lexemes.peek().is_some_and(names)
                };
                if begins {
                    starts.push(lexeme.start);
                    (braces, parentheses, indent) = (0, 0, lexeme.indent.unwrap_or(indent));
                }
            }
        }
    }
    (is_balanced, starts)
}

/// Starts of the statements in the braces that open before `start`, and the position of the closing brace.
fn statements(text: &str, start: usize) -> (Vec<usize>, usize) {
    let (mut braces, mut parentheses) = (0_usize, 0_usize);
    let mut starts = Vec::new();
    let mut before = "";
    // True if the last token is the end of an arrow.
    let mut is_target = false;
    for lexeme in scan(&text[start..]) {
        let is_begin = !std::mem::replace(&mut is_target, lexeme.text == ">");
        let word = lexeme.text;
        let is_value = word == "if" && is_before_expression(before);
        before = word;
        match word {
            "{" => braces += 1,
            "}" if braces == 0 => return (starts, start + lexeme.start),
            "}" => braces -= 1,
            "(" => parentheses += 1,
            ")" => parentheses = parentheses.saturating_sub(1),
            // At the beginning of a line a statement begins even if a parenthesis was left open.
            word if braces == 0
                && !is_value
                && is_begin
                && self::word(word).is_some_and(|word| word.begins_part() || word.begins_statement())
                && (lexeme.indent.is_some() || is_keyword(word))
                && (parentheses == 0 || lexeme.indent.is_some()) =>
            {
                starts.push(start + lexeme.start);
                parentheses = 0;
            }
            _ => {}
        }
    }
    (starts, text.len())
}
