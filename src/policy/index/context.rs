//! What may be written at a place, judged by the text before it.

use crate::diagnostic::Span;
use crate::policy::format::{Token, TokenKind, tokens};

use super::declare::{declare, is_balanced, place};

/// What may be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Expected {
    Nothing,
    /// A member of what stands before the `.` at this byte.
    Member(usize),
    /// A state to go to, or the end of the run.
    Target,
    /// A state to begin in.
    Initial,
    /// A state that was left.
    Resumed,
    Law,
    /// The name of any state.
    State,
    /// The memory of a state, or of the machine.
    Memory,
    /// A parameter to set.
    Parameter,
    /// What a whisker is marked as.
    Mark,
    TipModel,
    /// A file to use.
    File,
    /// What stands behind `std.`.
    Module,
    /// A name that a `use` brings.
    Chosen,
    Type,
    /// What `vector of` takes.
    Dimension,
    Unit,
    /// A value.
    Value,
    /// The word that begins the file.
    Machine,
    /// One word.
    Only(&'static str),
    /// What begins a statement in such braces.
    Statement(Level),
    /// What goes on with the statement, or begins another.
    More(Level, &'static [&'static str]),
}

/// Which braces a place is in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Level {
    /// None.
    Outside,
    /// Those of a state.
    State,
    /// Those of a test.
    Test,
    /// Any others.
    Block,
}

/// A place at which something is being written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Context {
    pub(super) expected: Expected,
    /// The part of a word that stands there already.
    pub(super) typed: Span,
    pub(super) level: Level,
    /// The name of the innermost state that the place is in.
    pub(super) state: Option<Span>,
    /// Where the statement begins that is being written; what it declares is not known in it.
    pub(super) statement: Option<usize>,
    /// Whether the place is in a transition, which does not know the names that the state's statements give.
    pub(super) in_transition: bool,
    /// Memory that is declared from here on is not known: laws and derived values know none, a `var` of the machine what stands
    /// above it, all else whatever there is.
    pub(super) memory_end: usize,
}

/// What may be written at the byte `at` of a text, which must be a whole character's.
pub(super) fn context(text: &str, at: usize) -> Context {
    let before = &text[..at];
    let mut known = tokens(before);
    let typed = Span::new(at, at);
    let nothing = Context {
        expected: Expected::Nothing,
        typed,
        level: Level::Outside,
        state: None,
        statement: None,
        in_transition: false,
        memory_end: 0,
    };
    if known.last().is_some_and(|last| is_unfinished(before, *last)) {
        return nothing;
    }
    known.retain(|token| token.kind != TokenKind::Comment);
    let is_word = |token: &&Token<'_>| matches!(token.kind, TokenKind::Name | TokenKind::Keyword | TokenKind::Unit);
    let typed = known.last().filter(is_word).map(|token| place(*token)).filter(|span| span.end == at);
    if typed.is_some() {
        known.pop();
    }
    let typed = typed.unwrap_or(Span::new(at, at));
    let declared = declare(before, &known, is_balanced(&tokens(text)));
    let frame = declared.frames.last().cloned().unwrap_or_default();
    let level = match frame.head {
        None => Level::Outside,
        Some("state") => Level::State,
        Some("test") => Level::Test,
        Some(_) => Level::Block,
    };
    let statement = frame.statement.and_then(|start| known.get(start..)).unwrap_or_default();
    let head = statement.first().map(|token| token.text);
    let states = declared.frames.iter().rev().filter(|frame| frame.head == Some("state"));
    let state = states.filter_map(|frame| declared.symbols.get(frame.owner?)).map(|state| state.span).next();
    let outermost = declared.frames.get(1).map_or(head, |frame| frame.head);
    Context {
        expected: expected(&known, statement, level, typed),
        typed,
        level,
        state,
        statement: statement.first().map(|token| token.start),
        in_transition: matches!(head, Some("when" | "after" | "failsafe" | "initial" | "var")),
        memory_end: match outermost {
            Some("law" | "let") => 0,
            Some("var") => at,
            _ => text.len(),
        },
    }
}

/// Whether the text ends within a comment, a text or a number.
fn is_unfinished(text: &str, last: Token<'_>) -> bool {
    let is_at_the_end = last.start + last.text.len() == text.len();
    match last.kind {
        TokenKind::Comment => !text[last.start..].contains('\n'),
        TokenKind::Text => is_at_the_end && (last.text.len() == 1 || !last.text.ends_with('"')),
        TokenKind::Number => is_at_the_end,
        _ => false,
    }
}

fn expected(known: &[Token<'_>], statement: &[Token<'_>], level: Level, typed: Span) -> Expected {
    let Some(before) = known.last() else { return Expected::Machine };
    let head = statement.first().map(|token| token.text);
    match (before.kind, before.text) {
        (TokenKind::Mark, ".") if head == Some("use") => Expected::Module,
        (TokenKind::Mark, "(" | ",") if head == Some("use") => Expected::Chosen,
        (TokenKind::Mark, "(") if level == Level::Test && matches!(behind(known, 1), Some("visits" | "time_in")) => {
            Expected::State
        }
        (TokenKind::Mark, ".") => Expected::Member(before.start),
        (TokenKind::Mark, "->") => Expected::Target,
        (TokenKind::Mark, ":") => Expected::Type,
        (TokenKind::Mark, "..") => Expected::Nothing,
        (TokenKind::Mark, "{") => Expected::Statement(level),
        (TokenKind::Mark, "(" | ",") if is_declaring(statement) => Expected::Nothing,
        (TokenKind::Mark, "*" | "/") if is_declaring(statement) => Expected::Dimension,
        (TokenKind::Mark, "=") if head == Some("param") => Expected::Nothing,
        (TokenKind::Mark, "=") if level == Level::Test && head == Some("set") => Expected::Nothing,
        (TokenKind::Mark, ")" | "}") => more(statement, level),
        (TokenKind::Mark, "|") if closes_a_norm(statement) => more(statement, level),
        (TokenKind::Mark, _) => Expected::Value,
        // A unit stands on the line of its number.
        (TokenKind::Number, _) if known_apart(typed, *before) => more(statement, level),
        (TokenKind::Number, _) => Expected::Unit,
        (TokenKind::Name, "lost" | "found") if behind(known, 1) == Some("mark") => Expected::Value,
        (TokenKind::Keyword, word) => behind_word(word, statement, level),
        (TokenKind::Name, "vector") if is_declaring(statement) => Expected::Only("of"),
        _ => more(statement, level),
    }
}

/// The token so many before the last.
fn behind<'t>(known: &[Token<'t>], back: usize) -> Option<&'t str> {
    known.iter().rev().nth(back).map(|token| token.text)
}

/// Whether something else begins so far behind a number that it cannot be its unit.
fn known_apart(typed: Span, number: Token<'_>) -> bool {
    typed.start > number.start + number.text.len() + 1
}

fn behind_word(word: &str, statement: &[Token<'_>], level: Level) -> Expected {
    match word {
        "machine" | "library" | "whisker" | "param" | "law" | "state" | "let" | "var" | "in" | "entry" | "exit"
        | "test" => Expected::Nothing,
        "initial" => Expected::Initial,
        "do" => Expected::Law,
        "set" if level == Level::Test => Expected::Parameter,
        "set" => Expected::Memory,
        "mark" => Expected::Mark,
        "by" => Expected::TipModel,
        "use" => Expected::File,
        "resume" => Expected::Resumed,
        "failsafe" => Expected::Only("->"),
        "of" => Expected::Dimension,
        "always" => Expected::Only("when"),
        "else" => Expected::Only("if"),
        "if" if statement.first().is_some_and(|token| token.text == "whisker") => Expected::Only("fitted"),
        "true" | "false" | "body" | "hold" | "stop" => more(statement, level),
        _ => Expected::Value,
    }
}

/// Whether the statement stands before or within its list of arguments, or lists whiskers.
fn is_declaring(statement: &[Token<'_>]) -> bool {
    match statement.first().map(|token| token.text) {
        Some("law" | "state" | "whisker") => true,
        Some("let") => !statement.iter().any(|token| token.is("=")),
        _ => false,
    }
}

/// Whether the last of the bars in a statement, of which it ends with one, closes.
fn closes_a_norm(statement: &[Token<'_>]) -> bool {
    statement.iter().filter(|token| token.is("|")).count() % 2 == 0
}

/// What may follow a whole value in a statement.
fn more(statement: &[Token<'_>], level: Level) -> Expected {
    let has = |word: &str| statement.iter().any(|token| token.text == word);
    let words: &[&str] = match statement.first().map(|token| token.text) {
        Some("steer") if !has("along") => &["along"],
        Some("steer") if !has("at") => &["at"],
        Some("steer") if !has("facing") && !has("turning") => &["facing", "turning"],
        Some("when" | "always") if !has("->") && has("for") => &["->"],
        Some("when" | "always") if !has("->") => &["for", "->", "and", "or"],
        Some("after") if !has("->") => &["->"],
        Some("param") if !has("in") => &["in"],
        Some("if") if has("}") => &["else"],
        Some("set") if level == Level::Test => &[],
        Some("if" | "let" | "set" | "var" | "expect") => &["and", "or"],
        Some("test") if !has("in") => return Expected::Only("in"),
        Some("law" | "state" | "test") if !has("}") => return Expected::Nothing,
        _ => &[],
    };
    Expected::More(level, words)
}
