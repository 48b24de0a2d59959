//! The context of completion, determined by the text before the position.

use crate::scan::are_braces_balanced;
use crate::token::{Kind as TokenKind, Token, tokens};
use crate::word::Word;
use crate::words::word;
use vibrissa_declare::catalogue;
use vibrissa_text::diagnostic::Span;

use super::declare::{Frame, declare};

/// The construct that is expected at a position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Expected {
    Nothing,
    /// A member of the operand before the `.` at this byte.
    Member(usize),
    /// A target: a state or the end of the run.
    Target,
    /// An initial state.
    Initial,
    /// A state after `resume`.
    Resumed,
    Law,
    /// A behaviour.
    Behaviour,
    /// A monitor.
    Monitor,
    /// An exit of the behaviour around the position.
    Exit,
    /// An exit of the behaviour that the state uses.
    Connected,
    /// Any state.
    State,
    /// Memory of a state or of the machine.
    Memory,
    /// A parameter.
    Parameter,
    /// The kind of a mark.
    Mark,
    /// A contour of positions.
    Contour,
    /// A rate or an age after `needs`.
    Need,
    TipModel,
    /// A file after `use`.
    File,
    /// A module after `std.`.
    Module,
    /// An imported name in the list of a `use`.
    Chosen,
    Type,
    /// A dimension after `vector of`.
    Dimension,
    Unit,
    /// A value.
    Value,
    /// The keyword at the beginning of the file.
    Machine,
    /// A family of scenes.
    Family,
    /// A parameter of this family.
    FamilyParameter(&'static str),
    /// One keyword.
    Only(&'static str),
    /// The beginning of a statement at this level of braces.
    Statement(Level),
    /// A continuation of the statement, or the beginning of another.
    More(Level, &'static [&'static str]),
}

/// The kind of the innermost braces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Level {
    /// Outside of all braces.
    Outside,
    /// Braces of a state.
    State,
    /// Braces of a test or a property.
    Test,
    /// Any other braces.
    Block,
}

/// The context of a position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Context {
    pub(super) expected: Expected,
    /// Span of the word that is already typed in part.
    pub(super) typed: Span,
    pub(super) level: Level,
    /// Span of the name of the innermost state around the position.
    pub(super) state: Option<Span>,
    /// Start of the current statement. Its own declarations are not visible in it.
    pub(super) statement: Option<usize>,
    /// True in a behaviour, which does not know the memory of the machine.
    pub(super) in_behaviour: bool,
    /// True in a transition. Names of the state's statements are not visible there.
    pub(super) in_transition: bool,
    /// True in a statement that tells a monitor an event.
    pub(super) tells: bool,
    /// Memory that is declared from this byte on is not visible.
    ///
    /// For laws and derived values this excludes all memory. For a `var` of the machine it excludes memory below it.
    pub(super) memory_end: usize,
}

/// The context at the byte `at`, which must be the start of a character.
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
        tells: false,
        in_behaviour: false,
        memory_end: 0,
    };
    if known.last().is_some_and(|last| is_unfinished(before, *last)) {
        return nothing;
    }
    known.retain(|token| token.kind != TokenKind::Comment);
    let is_word = |token: &&Token<'_>| matches!(token.kind, TokenKind::Name | TokenKind::Keyword | TokenKind::Unit);
    let typed = known.last().filter(is_word).map(Token::span).filter(|span| span.end == at);
    if typed.is_some() {
        known.pop();
    }
    let typed = typed.unwrap_or(Span::new(at, at));
    let declared = declare(before, &known, are_braces_balanced(text));
    let frame = declared.frames.last().cloned().unwrap_or_default();
    let level = match frame.head {
        None => Level::Outside,
        Some("state" | "behaviour") => Level::State,
        Some("test" | "property") => Level::Test,
        Some(_) => Level::Block,
    };
    let statement = frame.statement.and_then(|start| known.get(start..)).unwrap_or_default();
    let head = statement.first().map(|token| token.text);
    let is_state = |frame: &&Frame<'_>| matches!(frame.head, Some("state" | "behaviour"));
    let states = declared.frames.iter().rev().filter(is_state);
    let state = states.filter_map(|frame| declared.symbols.get(frame.owner?)).map(|state| state.span).next();
    let outermost = declared.frames.get(1).map_or(head, |frame| frame.head);
    Context {
        expected: expected(&known, statement, level, typed),
        typed,
        level,
        state,
        statement: statement.first().map(|token| token.start),
        in_transition: matches!(head, Some("when" | "after" | "on" | "failsafe" | "initial" | "var")),
        in_behaviour: outermost == Some("behaviour"),
        tells: head == Some("tell"),
        memory_end: match outermost {
            Some("law" | "let") => 0,
            Some("var") => at,
            _ => text.len(),
        },
    }
}

/// True if the text ends within a comment, a string or a number.
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
        (TokenKind::Mark, "(" | ",") if head == Some("property") => {
            family_of(statement).map_or(Expected::Nothing, Expected::FamilyParameter)
        }
        (TokenKind::Mark, ".") => Expected::Member(before.start),
        (TokenKind::Mark, "->") => Expected::Target,
        (TokenKind::Mark, ":") if is_declaring(statement) => Expected::Type,
        (TokenKind::Mark, "..") => Expected::Nothing,
        (TokenKind::Mark, "{") => Expected::Statement(level),
        (TokenKind::Mark, "(" | ",") if is_declaring(statement) => Expected::Nothing,
        (TokenKind::Mark, "(" | ",") if head == Some("on") && !statement.iter().any(|token| token.is("->")) => {
            Expected::Nothing
        }
        (TokenKind::Mark, "*" | "/") if is_declaring(statement) => Expected::Dimension,
        (TokenKind::Mark, "=") if head == Some("type") => Expected::Only("list"),
        (TokenKind::Mark, "=") if matches!(head, Some("param" | "property")) => Expected::Nothing,
        (TokenKind::Keyword, "or") if head == Some("type") => Expected::Nothing,
        (TokenKind::Mark, "=") if level == Level::Test && head == Some("set") => Expected::Nothing,
        (TokenKind::Mark, ")" | "}") => more(statement, level),
        (TokenKind::Mark, "|") if closes_a_norm(statement) => more(statement, level),
        (TokenKind::Mark, _) => Expected::Value,
        // A unit is on the same line as its number.
        (TokenKind::Number, _) if head == Some("type") && behind(known, 1) == Some("of") => Expected::Type,
        (TokenKind::Number, _) if head == Some("contour") && behind(known, 1) == Some("of") => Expected::Only("points"),
        (TokenKind::Number, _) if known_apart(typed, *before) => more(statement, level),
        (TokenKind::Number, _) => Expected::Unit,
        (TokenKind::Name, "lost" | "found") if behind(known, 1) == Some("mark") => Expected::Value,
        // Before a name it is a keyword.
        (TokenKind::Name, "on") if level == Level::State && before.line_ends > 0 => Expected::Connected,
        (TokenKind::Keyword, "exit") if behind(known, 1) == Some("->") => Expected::Exit,
        (TokenKind::Keyword, word) => behind_word(word, statement, level),
        (TokenKind::Name, "vector") if is_declaring(statement) => Expected::Only("of"),
        _ => more(statement, level),
    }
}

/// The token that precedes the last one by `back`.
fn behind<'t>(known: &[Token<'t>], back: usize) -> Option<&'t str> {
    known.iter().rev().nth(back).map(|token| token.text)
}

/// True if the typed word is too far from a number to be its unit.
fn known_apart(typed: Span, number: Token<'_>) -> bool {
    typed.start > number.start + number.text.len() + 1
}

fn behind_word(text: &str, statement: &[Token<'_>], level: Level) -> Expected {
    let head = statement.first().map(|token| token.text);
    match text {
        "of" if head == Some("contour") => Expected::Nothing,
        "in" if head == Some("record") => Expected::Contour,
        "is" if head == Some("monitor") => Expected::Monitor,
        "set" if level == Level::Test => Expected::Parameter,
        "always" if level == Level::Outside => Expected::Only("when"),
        "else" => Expected::Only("if"),
        "if" if head == Some("whisker") => Expected::Only("fitted"),
        _ => word(text).map_or(Some(Expected::Value), Word::next).unwrap_or_else(|| more(statement, level)),
    }
}

/// True if the statement is at or before its list of arguments, or lists whiskers.
fn is_declaring(statement: &[Token<'_>]) -> bool {
    match statement.first().map(|token| token.text) {
        Some("state" | "monitor") => !statement.iter().any(|token| token.text == "is"),
        Some("law" | "behaviour" | "exit" | "whisker") => true,
        Some("let" | "type") => !has_value(statement),
        _ => false,
    }
}

/// True if a derived value has its `=`. That of a default is in parentheses.
fn has_value(statement: &[Token<'_>]) -> bool {
    let mut depth = 0_i32;
    statement.iter().any(|token| {
        depth += i32::from(token.is("(")) - i32::from(token.is(")"));
        depth == 0 && token.is("=")
    })
}

/// The family of a property.
fn family_of(statement: &[Token<'_>]) -> Option<&'static str> {
    let over = statement.iter().position(|token| token.text == "over")?;
    catalogue::entry(statement.get(over + 1)?.text).map(|entry| entry.name)
}

/// True if the last token is the name of a parameter in the parentheses of a property.
fn is_range_begun(statement: &[Token<'_>]) -> bool {
    matches!(statement, [.., mark, name] if (mark.is("(") || mark.is(",")) && name.kind == TokenKind::Name)
}

/// True if the last token of a statement is a bar that closes.
fn closes_a_norm(statement: &[Token<'_>]) -> bool {
    statement.iter().filter(|token| token.is("|")).count() % 2 == 0
}

/// True if the statement ends in the condition of a conditional expression.
fn is_choice_open(statement: &[Token<'_>]) -> bool {
    let count = |word: &str| statement.iter().skip(1).filter(|token| token.text == word).count();
    count("if") > count("then")
}

/// The context after a complete value in a statement.
fn more(statement: &[Token<'_>], level: Level) -> Expected {
    let has = |word: &str| statement.iter().any(|token| token.text == word);
    let words: &[&str] = match statement.first().map(|token| token.text) {
        Some("steer") if !has("along") => &["along"],
        Some("steer") if !has("at") => &["at"],
        Some("steer") if !has("facing") && !has("turning") => &["facing", "turning"],
        Some("always") if !has("when") && !has("within") => &["within", "and", "or"],
        Some("assume" | "never") if has("for") => &[],
        Some("never") => &["for", "and", "or"],
        Some("assume") => &["and", "or"],
        Some("when" | "always") if !has("->") && has("for") => &["->"],
        Some("when" | "always") if !has("->") => &["for", "->", "and", "or"],
        Some("after") if !has("->") => &["->"],
        Some("param" | "needs" | "record") if !has("in") => &["in"],
        Some("type") if has("=") => &["or"],
        Some("contour") if !has("of") => &["of"],
        Some("contour") if !has("apart") => &["apart"],
        Some("if") if has("}") => &["else"],
        Some("set") if level == Level::Test => &[],
        _ if is_choice_open(statement) => &["then", "and", "or"],
        Some("if" | "let" | "set" | "var" | "expect" | "plot") => &["and", "or"],
        Some("test") if !has("in") => return Expected::Only("in"),
        Some("property") if !has("over") => return Expected::Only("over"),
        Some("property") if is_range_begun(statement) => return Expected::Only("in"),
        Some("state" | "monitor") if !has("}") && !has("is") => return Expected::Only("is"),
        Some("on") if !has("->") => return Expected::Only("->"),
        Some("law" | "state" | "behaviour" | "test" | "property") if !has("}") => return Expected::Nothing,
        _ => &[],
    };
    Expected::More(level, words)
}
