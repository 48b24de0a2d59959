//! Going on behind a fault of syntax, so that one does not hide the others.
//!
//! What is at fault is overwritten with blanks, so that every place stays what it was, and the rest is parsed again: first the
//! statement, and if the fault is still there, the item. That is done a bounded number of times, each in time linear in the text.

use std::borrow::Cow;
use std::collections::HashSet;

use crate::diagnostic::{Diagnostic, FAULT_LIMIT, Source, Span};

use super::ast::File;
use super::grammar::{brackets, is_word};
use super::parse::parse;

/// How often a text is parsed at most.
const ATTEMPTS: usize = 20;

/// Words that begin an item.
const ITEM_WORDS: [&str; 12] =
    ["whisker", "param", "initial", "let", "law", "state", "always", "failsafe", "use", "test", "machine", "library"];
/// Those among them that stand within braces, too.
const INNER_WORDS: [&str; 4] = ["initial", "let", "state", "failsafe"];
/// Words that begin a statement or memory, in a state or outside of all.
const STATEMENT_WORDS: [&str; 9] = ["var", "set", "if", "do", "record", "mark", "steer", "hold", "stop"];
/// Words with which an item can go on in another line.
const CONTINUING_WORDS: [&str; 7] = ["and", "or", "not", "in", "for", "when", "else"];
/// Words that begin what else stands in a state.
const PART_WORDS: [&str; 6] = ["let", "when", "after", "entry", "exit", "failsafe"];

/// What was left out of the texts of a policy, and why.
#[derive(Debug, Default)]
pub(super) struct Recovery {
    /// The faults; none if nothing was left out.
    pub(super) faults: Vec<Diagnostic>,
    /// Words that may be names given in the parts that were left out.
    lost: HashSet<String>,
    /// Whether these parts may have brought the names of other files.
    lost_use: bool,
    /// Whether what is left says where to start.
    has_initial: bool,
}

/// The faults of syntax of a text, in the order of their places.
pub(super) fn faults(source: &Source) -> Vec<Diagnostic> {
    let mut recovery = Recovery::default();
    parse_all(source, 0, &mut recovery);
    recovery.join(source, Vec::new())
}

/// Reads all of a text that can be read; its first byte has the place `start`. The file lacks what is at fault; `None` if nothing
/// can be made of it.
pub(super) fn parse_all(source: &Source, start: usize, recovery: &mut Recovery) -> Option<File> {
    let mut rest = Cow::Borrowed(source);
    let mut ways = Vec::new();
    let mut last = None;
    for _ in 0..ATTEMPTS {
        match parse(&rest, start) {
            Ok(file) => {
                recovery.has_initial |= !file.initial.is_empty();
                return Some(file);
            }
            Err(fault) => {
                let at = fault.primary.span.start.saturating_sub(start);
                // The same place again: too little was left out.
                if last != Some(at) {
                    ways = if is_local(&fault) { regions(&rest.text, at) } else { Vec::new() };
                    recovery.report(*fault);
                    last = Some(at);
                }
                // What has been left out already helps no more.
                let is_new = |region: &Span| !rest.slice(*region).trim().is_empty();
                let index = ways.iter().position(is_new)?;
                let region = ways.remove(index);
                recovery.lost_use |= Tokens::new(rest.slice(region)).any(|token| token.of(rest.slice(region)) == "use");
                recovery.lost.extend(names(rest.slice(region)));
                rest = Cow::Owned(Source::new(rest.name.clone(), blanked(&rest.text, region)));
            }
        }
    }
    None
}

/// Whether a fault is one of the place that it names, and not of the text as a whole.
fn is_local(fault: &Diagnostic) -> bool {
    ["P0101", "P0104"].contains(&fault.code)
}

impl Recovery {
    /// Adds a fault.
    pub(super) fn report(&mut self, fault: Diagnostic) {
        if self.faults.len() < FAULT_LIMIT {
            self.faults.push(fault);
        }
    }

    /// Whether nothing was left out.
    pub(super) fn is_whole(&self) -> bool {
        self.faults.is_empty()
    }

    /// Whether something in a part of the texts was left out.
    pub(super) fn has_syntax_fault(&self, within: Span) -> bool {
        let is_syntax = |code: &str| code.starts_with("P01");
        let is_within = |fault: &Diagnostic| (within.start..=within.end).contains(&fault.primary.span.start);
        self.faults.iter().any(|fault| is_syntax(fault.code) && is_within(fault))
    }

    /// All faults in the order of their places: these, and those of meaning that are not but their consequences.
    pub(super) fn join(mut self, source: &Source, mut faults: Vec<Diagnostic>) -> Vec<Diagnostic> {
        faults.retain(|fault| !self.explains(source, fault));
        faults.append(&mut self.faults);
        faults.sort_by_key(|fault| fault.primary.span.start);
        faults.truncate(FAULT_LIMIT);
        faults
    }

    /// Whether a fault of meaning is but a consequence of what was left out.
    fn explains(&self, source: &Source, fault: &Diagnostic) -> bool {
        match fault.code {
            // A name that means nothing, or memory that is none.
            "P0201" | "P0406" => self.lost_use || self.lost.contains(source.slice(fault.primary.span)),
            // Whiskers may have been bound.
            "P0412" => !self.faults.is_empty(),
            // The initial state.
            "P0404" => !self.faults.is_empty() && !self.has_initial,
            _ => false,
        }
    }
}

/// The words of a text that may be names given in it: all behind another word, such as `state` or what stands for it by mistake,
/// and all behind a comma.
fn names(text: &str) -> impl Iterator<Item = String> {
    let mut may_be_name = false;
    Tokens::new(text).filter_map(move |token| {
        let word = token.of(text);
        let is_word = word.starts_with(is_word);
        let is_name = is_word && may_be_name;
        may_be_name = is_word || word == ",";
        is_name.then(|| word.to_owned())
    })
}

/// The text with blanks instead of a region, in as many bytes.
fn blanked(text: &str, region: Span) -> String {
    let blanks = text[region.start..region.end].bytes().map(|byte| if byte == b'\n' { '\n' } else { ' ' });
    text[..region.start].chars().chain(blanks).chain(text[region.end..].chars()).collect()
}

/// What may be left out because of a fault at `at`, the least first.
fn regions(text: &str, at: usize) -> Vec<Span> {
    let Ok(opened) = brackets(text) else { return Vec::new() };
    let (balanced, starts) = items(text);
    // A text that ends too early goes wrong where it opens what it never closes.
    let at = if text[at.min(text.len())..].trim().is_empty() { opened.first().copied().unwrap_or(at) } else { at };
    let mut regions = Vec::new();
    if balanced
        && let Ok(opened) = brackets(&text[..at])
        && let Some(&brace) = opened.iter().rev().find(|&&bracket| text[bracket..].starts_with('{'))
    {
        let (starts, end) = statements(text, brace + 1);
        let is_whole = |region: &Span| braces_close(&text[region.start..region.end]);
        regions.extend(around(text, at, (&starts, &PART_WORDS), (brace + 1, end)).into_iter().filter(is_whole));
    }
    // Without the machine's name there is no file.
    let mut tokens = Tokens::new(text).skip_while(|token| !token.is_heading(text)).skip(2);
    if let Some(first) = tokens.next() {
        regions.extend(around(text, at, (&starts, &ITEM_WORDS), (first.start, text.len())));
    }
    regions
}

/// What may be at fault at `at` among parts that begin at `starts`, with one of the `words` or that of a statement, within bounds.
fn around(text: &str, at: usize, (starts, words): (&[usize], &[&str]), (low, high): (usize, usize)) -> Vec<Span> {
    if at < low || at > high {
        return Vec::new();
    }
    let before = starts.iter().copied().take_while(|&start| start < at).last().unwrap_or(low);
    let behind = starts.iter().copied().find(|&start| start > at).unwrap_or(high);
    let word: &str = text[at..].split(|letter| !is_word(letter)).next().unwrap_or_default();
    let is_start = starts.contains(&at);
    if is_start && (words.contains(&word) || STATEMENT_WORDS.contains(&word)) {
        // The part before lacks its end, or this one should not be here.
        vec![Span::new(before, at), Span::new(at, behind)]
    } else if is_start || indent(text, at).is_some_and(|own| Some(own) <= indent(text, before)) {
        vec![Span::new(at, behind), Span::new(before, behind)]
    } else {
        vec![Span::new(before, behind)]
    }
}

/// How far in the line something stands that is the first of its line.
fn indent(text: &str, at: usize) -> Option<usize> {
    let line = text[..at].rsplit('\n').next()?;
    line.trim().is_empty().then_some(line.len())
}

/// Where the items behind the machine's name begin, and whether all braces are closed.
///
/// Items begin outside of braces with their words, or with what stands for one by mistake: a word at the beginning of a line with
/// another behind it; statements among them begin a line, too, no farther in than the item before. Where braces are not closed, a
/// word that begins an item counts at the beginning of any line: if it can only be an item, or if it stands no farther in than the
/// item before.
fn items(text: &str) -> (bool, Vec<usize>) {
    let is_balanced = braces_close(text);
    let (mut braces, mut parentheses, mut indent) = (0_usize, 0_usize, 0);
    let mut starts = Vec::new();
    let mut tokens = Tokens::new(text).skip_while(|token| !token.is_heading(text)).skip(2).peekable();
    while let Some(token) = tokens.next() {
        let word = token.of(text);
        match word {
            "{" => braces += 1,
            "}" => braces = braces.saturating_sub(1),
            "(" => parentheses += 1,
            ")" => parentheses = parentheses.saturating_sub(1),
            _ if !word.starts_with(is_word) => {}
            _ => {
                let is_item = ITEM_WORDS.contains(&word);
                let is_first = token.indent.is_some();
                let is_outermost = token.indent.is_some_and(|own| own <= indent);
                // Farther in, or behind another word, it belongs to a state, or to a `whisker` or an `else` before its `if`.
                let begins = if STATEMENT_WORDS.contains(&word) {
                    is_outermost && (braces == 0 || !is_balanced)
                } else if braces > 0 {
                    is_item && !is_balanced && if INNER_WORDS.contains(&word) { is_outermost } else { is_first }
                } else if is_item {
                    parentheses == 0 || is_first
                } else {
                    let names = |next: &Token| next.indent.is_none() && text[next.start..].starts_with(is_word);
                    is_outermost && !CONTINUING_WORDS.contains(&word) && tokens.peek().is_some_and(names)
                };
                if begins {
                    starts.push(token.start);
                    (braces, parentheses, indent) = (0, 0, token.indent.unwrap_or(indent));
                }
            }
        }
    }
    (is_balanced, starts)
}

/// Where the statements begin in the braces that open before `start`, and where those close.
fn statements(text: &str, start: usize) -> (Vec<usize>, usize) {
    let (mut braces, mut parentheses) = (0_usize, 0_usize);
    let mut starts = Vec::new();
    for token in Tokens::new(&text[start..]) {
        match &text[start + token.start..start + token.end] {
            "{" => braces += 1,
            "}" if braces == 0 => return (starts, start + token.start),
            "}" => braces -= 1,
            "(" => parentheses += 1,
            ")" => parentheses = parentheses.saturating_sub(1),
            // At the beginning of a line a statement begins even if a parenthesis was left open.
            word if braces == 0
                && (STATEMENT_WORDS.contains(&word) || PART_WORDS.contains(&word))
                && (parentheses == 0 || token.indent.is_some()) =>
            {
                starts.push(start + token.start);
                parentheses = 0;
            }
            _ => {}
        }
    }
    (starts, text.len())
}

/// Whether every brace in a text has its other.
fn braces_close(text: &str) -> bool {
    let mut depth = 0_usize;
    for token in Tokens::new(text) {
        match token.of(text) {
            "{" => depth += 1,
            "}" if depth == 0 => return false,
            "}" => depth -= 1,
            _ => {}
        }
    }
    depth == 0
}

/// A word, a text in quotes, or a sign.
struct Token {
    start: usize,
    end: usize,
    /// If it is the first of its line, how far in it stands.
    indent: Option<usize>,
}

impl Token {
    fn of<'t>(&self, text: &'t str) -> &'t str {
        &text[self.start..self.end]
    }

    /// Whether it is the word with which a file begins.
    fn is_heading(&self, text: &str) -> bool {
        ["machine", "library"].contains(&self.of(text))
    }
}

/// The tokens of a text, without comments.
struct Tokens<'t> {
    text: &'t str,
    at: usize,
    /// Where the line began, as long as nothing but blanks has been in it.
    line: Option<usize>,
}

impl<'t> Tokens<'t> {
    fn new(text: &'t str) -> Self {
        Self { text, at: 0, line: Some(0) }
    }
}

impl Iterator for Tokens<'_> {
    type Item = Token;

    fn next(&mut self) -> Option<Token> {
        loop {
            let rest = &self.text[self.at..];
            let letter = rest.chars().next()?;
            let start = self.at;
            match letter {
                '\n' => {
                    self.at += 1;
                    self.line = Some(self.at);
                }
                '#' => self.at += rest.find('\n').unwrap_or(rest.len()),
                _ if letter.is_whitespace() => self.at += letter.len_utf8(),
                _ => {
                    self.at += match letter {
                        '"' => rest[1..].find(['"', '\n']).map_or(rest.len(), |end| end + 2),
                        _ if is_word(letter) => rest.find(|letter| !is_word(letter)).unwrap_or(rest.len()),
                        _ => letter.len_utf8(),
                    };
                    let indent = self.line.take().map(|line| start - line);
                    return Some(Token { start, end: self.at, indent });
                }
            }
        }
    }
}
