//! Messages for syntax errors: the found text, the expected constructs, the probable intention.

use pest::error::{Error, ErrorVariant, InputLocation};

use vibrissa_text::diagnostic::{Diagnostic, Source, Span};

use super::foreign_syntax::advice_for;
use super::grammar::{Rule, brackets, is_keyword, word_of};
use super::scan::is_word;
use super::suggestion::did_you_mean;
use super::word::{Position, Word};
use super::words::{reserved, word, words_at};

/// The mark that some editors write at the beginning of a file.
const BYTE_ORDER_MARK: &str = "\u{feff}";

/// The diagnostic for an error of pest.
pub(super) fn syntax_error(source: &Source, error: &Error<Rule>) -> Diagnostic {
    let at = match error.location {
        InputLocation::Pos(at) | InputLocation::Span((at, _)) => at,
    };
    let rules: &[Rule] = match &error.variant {
        ErrorVariant::ParsingError { positives, .. } => positives,
        ErrorVariant::CustomError { message } => {
            return Diagnostic::error(
                "P0103",
                "the policy is nested too deeply",
                word_at(&source.text, at),
                message.clone(),
            )
            .hint("name parts of it with `let`");
        }
    };
    let span = word_at(&source.text, at);
    let found = source.slice(span);
    let opened = brackets(&source.text[..at]).ok().and_then(|opened| opened.last().copied());

    if let Some(end) = lone_return(&source.text) {
        return Diagnostic::error("P0101", "the lines end with CR alone", end, "U+000D, which ends no line here")
            .hint("save the file with LF or CR LF as the ends of its lines");
    }
    if found.is_empty() {
        return at_the_end(source, at, rules, opened);
    }
    if found == BYTE_ORDER_MARK && at == 0 {
        return Diagnostic::error(
            "P0101",
            "the file begins with a byte-order mark",
            span,
            "U+FEFF, which is not shown",
        )
        .hint("save it as UTF-8 without a byte-order mark (BOM)");
    }
    if let Some((what, hint)) = unseen(found) {
        let code = found.chars().map(|letter| format!("U+{:04X}", u32::from(letter))).collect::<Vec<_>>().join(" ");
        return Diagnostic::error("P0101", format!("{what} is unexpected here"), span, code).hint(hint);
    }
    if found == "\"" && !is_closed(&source.text[at..]) {
        return Diagnostic::error("P0101", "the text is not closed", span, "begins here")
            .hint("end it with `\"` on the same line");
    }
    if is_keyword(found) && rules.contains(&Rule::name) {
        let message = format!("`{found}` is a keyword");
        return Diagnostic::error("P0101", message, span, "cannot be a name").hint("choose another name");
    }
    let mut diagnostic =
        Diagnostic::error("P0101", format!("`{found}` is unexpected here"), span, expected(rules).unwrap_or_default());
    if let Some(opened) = opened
        && (reserved(found).is_some_and(begins_item) || !belongs(&source.text[opened..=opened], found))
    {
        diagnostic = diagnostic.note(Span::new(opened, opened + 1), "still open");
    }
    if opened.is_none() && ["}", ")"].contains(&found) {
        return diagnostic.hint(format!("`{found}` closes nothing"));
    }
    if let Some(advice) = advice(found, source.text.split_at(at), rules) {
        return diagnostic.hint(advice);
    }
    let others: &[&str] = if rules.contains(&Rule::file) { &["library", "tests"] } else { &[] };
    did_you_mean(diagnostic, found, rules.iter().filter_map(|&rule| first_word(rule)).chain(others.iter().copied()))
}

/// The first end of a line of a text whose lines all end with CR alone.
fn lone_return(text: &str) -> Option<Span> {
    let at = text.find('\r').filter(|_| !text.contains('\n'))?;
    Some(Span::new(at, at + 1))
}

/// The diagnostic for a text that ends too early.
fn at_the_end(source: &Source, at: usize, rules: &[Rule], opened: Option<usize>) -> Diagnostic {
    let span = Span::new(at, at);
    if rules.contains(&Rule::file) || rules.contains(&Rule::kw_machine) {
        return Diagnostic::error("P0101", "the file has no policy", span, "expected `machine` and its name")
            .hint("a policy begins with `machine` and its name, followed by whiskers, parameters, laws and states");
    }
    let Some(opened) = opened else {
        return Diagnostic::error("P0101", "the policy ends too early", span, expected(rules).unwrap_or_default());
    };
    let bracket = &source.text[opened..=opened];
    let close = match bracket {
        "(" => ")",
        "{" => "}",
        _ => bracket,
    };
    Diagnostic::error("P0101", "the policy ends too early", span, format!("expected `{close}`"))
        .note(Span::new(opened, opened + 1), format!("this `{bracket}` is never closed"))
}

/// The word or the character at `at`. Empty at the end of the text.
fn word_at(text: &str, at: usize) -> Span {
    let rest = &text[at.min(text.len())..];
    let word = rest.find(|letter| !is_word(letter)).unwrap_or(rest.len());
    let length = if word > 0 { word } else { rest.chars().next().map_or(0, char::len_utf8) };
    Span::new(at, at + length)
}

/// What a character is that nobody sees, or that looks like a space, and advice.
fn unseen(found: &str) -> Option<(&'static str, &'static str)> {
    let (space, nothing) = ("write an ordinary space", "delete it; an editor may show it with its code");
    Some(match found.chars().next()? {
        '\u{a0}' | '\u{2007}' | '\u{202f}' => ("a no-break space", space),
        '\u{2028}' | '\u{2029}' | '\u{85}' => ("a line separator", "end the line with an ordinary line end"),
        '\u{feff}' => ("a byte-order mark", nothing),
        '\u{200b}'..='\u{200d}' | '\u{2060}' | '\u{180e}' => ("an invisible character", nothing),
        '\u{ad}' => ("a soft hyphen", nothing),
        '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => {
            ("a character that changes the direction of the text", nothing)
        }
        letter if letter.is_control() => ("a control character", nothing),
        letter if letter.is_whitespace() => ("a special space", space),
        _ => return None,
    })
}

/// The sign of the language that looks like a sign of word processors.
fn plain(found: &str) -> Option<&'static str> {
    Some(match found {
        "\u{2212}" | "\u{2013}" | "\u{2014}" | "\u{2010}" | "\u{2011}" => "-",
        "\u{201c}" | "\u{201d}" | "\u{201e}" | "\u{ab}" | "\u{bb}" => "\"",
        "\u{d7}" | "\u{22c5}" | "\u{b7}" => "*",
        "\u{f7}" | "\u{2044}" => "/",
        "\u{2264}" => "<=",
        "\u{2265}" => ">=",
        "\u{2260}" => "!=",
        "\u{2192}" => "->",
        "\u{b0}" => "deg",
        "\u{2026}" => "..",
        _ => return None,
    })
}

/// True if the string at the beginning of `rest` ends on its line.
fn is_closed(rest: &str) -> bool {
    rest[1..].find(['"', '\n']).is_some_and(|end| rest[1 + end..].starts_with('"'))
}

/// True if `found` is not a closing bracket, or closes `opened`.
fn belongs(opened: &str, found: &str) -> bool {
    !["}", ")"].contains(&found) || (opened, found) == ("{", "}") || (opened, found) == ("(", ")")
}

/// Advice for signs and words of other languages.
fn advice(found: &str, (before, rest): (&str, &str), rules: &[Rule]) -> Option<String> {
    let starts = |with: &str| rest.starts_with(with);
    let is_block_due = rules.iter().any(|rule| matches!(rule, Rule::block | Rule::open_brace));
    Some(match found {
        "-" if starts("->") => "a transition begins with `when` or `after`: `when condition -> State`".to_owned(),
        ":" | "then" if is_block_due => BLOCK.to_owned(),
        "{" if rules.contains(&Rule::kw_then) => {
            "a value is chosen without braces: `if condition then value else value`".to_owned()
        }
        ":" if rules.contains(&Rule::equals) && rest[1..].trim_start().starts_with(char::is_alphabetic) => {
            "leave out the type, which is inferred from the value: `let name = value`".to_owned()
        }
        ":" if rules.contains(&Rule::equals) => "write `=`".to_owned(),
        "+" | "-" | "*" | "/" if rest[1..].starts_with('=') => {
            format!("write `set name = name {found} value`")
        }
        "+" | "-" if rest[1..].starts_with(found) => format!("write `set name = name {found} 1`"),
        "?" => "write `if condition then value else value`".to_owned(),
        "=" if starts("=>") => "write `->`".to_owned(),
        "=" if before.split_whitespace().nth_back(1) == Some("needs") => {
            "a need is a range: `needs control_rate in 20 .. 60 Hz`".to_owned()
        }
        "=" => "write `==` to compare two values, or `let name = value` to name one".to_owned(),
        "&" => "write `and`".to_owned(),
        "|" if starts("||") => "write `or`".to_owned(),
        "!" => "write `not`".to_owned(),
        ";" => "leave it out; statements need no separator".to_owned(),
        "[" | "]" => "write `vector(x, y)` for a vector; there are no lists".to_owned(),
        "/" if starts("//") || starts("/*") => "a comment begins with `#` and ends with its line".to_owned(),
        _ if is_behind_tab_and_number(before) => {
            "use spaces between a number and its unit, instead of the tab".to_owned()
        }
        "/" | "*" if rules.contains(&Rule::kw_in) => {
            "a parameter is one number with a unit, and a unit has no spaces: `50 mm/s`".to_owned()
        }
        "^" => "multiply instead: `x * x`".to_owned(),
        "%" => "write the share as a plain number, such as 0.95".to_owned(),
        "'" => "a text is in double quotes".to_owned(),
        "\"" => "a text can only be the reason of `Failure` or `Success`, a path after `use`, or the title or scenario of a test".to_owned(),
        "." => "a number has digits before and after its decimal point".to_owned(),
        "for" if rules.contains(&Rule::kw_do) => {
            "there are no loops: a state executes its statements in every tick; write one statement for each whisker, or a `law` that is called by \
             `do`"
                .to_owned()
        }
        "when" if before.trim_end().ends_with("always") => {
            "a transition of all states is outside of their braces; a contract is `always condition within time`".to_owned()
        }
        "else" => "`else` follows the `}` of an `if`".to_owned(),
        "machine" | "library" => "a file has one machine or one library, in its first line".to_owned(),
        _ if rules == [Rule::dot] => {
            "a parameter is a number, `true`, `false`, or a value of an enumeration such as `Side.left`".to_owned()
        }
        _ if found.starts_with(['\u{b5}', '\u{3bc}']) => "write `u` for micro: `urad`".to_owned(),
        _ if let Some(sign) = plain(found) => format!("write `{sign}`"),
        _ if let Some(letter) = found.chars().find(|letter| !letter.is_ascii() && is_word(*letter)) => {
            format!("`{letter}` is U+{:04X}; names and words have only the letters a to z and A to Z", u32::from(letter))
        }
        _ if advice_for(found).is_some() => advice_for(found)?.to_owned(),
        _ if rules.contains(&Rule::kw_do) && found.starts_with(is_word) && !is_keyword(found) => {
            statement(found, rest[found.len()..].trim_start())?
        }
        _ if is_block_due && !is_value_due(rules) && word(found).is_some_and(|word| word.is_at(Position::Statement)) => BLOCK.to_owned(),
        "if" if is_value_due(rules) => "write it in parentheses: `(if condition then value else value)`".to_owned(),
        _ if is_keyword(found) && is_value_due(rules) => {
            format!("`{found}` is a keyword and cannot be a value")
        }
        _ => return None,
    })
}

/// Advice on the notation of blocks.
const BLOCK: &str = "a block is in braces: `if condition { \u{2026} }`";

/// Advice for a name at the beginning of a statement, depending on the following text.
fn statement(name: &str, behind: &str) -> Option<String> {
    if behind.starts_with('(') {
        Some(format!("write `do {name}(\u{2026})` to run the statements of a law"))
    } else if [":=", "=", "+=", "-=", "*=", "/=", "++", "--"].iter().any(|sign| behind.starts_with(sign))
        && !behind.starts_with("==")
    {
        Some(format!("write `let {name} = value` to name a value, or `set {name} = value` to change a `var`"))
    } else {
        None
    }
}

/// True if an item begins with a word, and no statement.
fn begins_item(word: &Word) -> bool {
    word.begins_item() && !word.is_at(Position::Statement)
}

/// The constructs that begin an item, in their usual order.
fn items() -> String {
    let words = words_at(Position::Item).filter(|word| word.begins_item());
    let words: Vec<String> = words.map(|word| format!("`{}`", word.text)).collect();
    format!("an item ({})", words.join(", "))
}

/// True if a text ends with a number and a tab.
fn is_behind_tab_and_number(text: &str) -> bool {
    let number = text.trim_end_matches([' ', '\t']);
    text[number.len()..].contains('\t') && number.ends_with(|letter: char| letter.is_ascii_digit())
}

/// True if the grammar expected an expression.
fn is_value_due(rules: &[Rule]) -> bool {
    rules.iter().any(|rule| matches!(rule, Rule::access | Rule::branch | Rule::expression | Rule::mover))
}

/// The expected constructs, the most informative first.
fn expected(rules: &[Rule]) -> Option<String> {
    let mut known: Vec<(u8, String)> = rules.iter().filter_map(|&rule| phrase(rule, rules)).collect();
    known.sort_unstable();
    known.dedup();
    // Almost every position within an expression allows operators. They are listed only if nothing else can follow.
    let most = known.first()?.0.max(CONTINUES - 1);
    let phrases: Vec<&str> =
        known.iter().filter(|(rank, _)| *rank <= most).map(|(_, phrase)| phrase.as_str()).collect();
    Some(match phrases.as_slice() {
        [first @ .., last] if !first.is_empty() => format!("expected {} or {last}", first.join(", ")),
        _ => format!("expected {}", phrases.concat()),
    })
}

/// The rank of a construct that continues an expression.
const CONTINUES: u8 = 5;

/// The name of a rule in messages, with its rank.
fn phrase(rule: Rule, among: &[Rule]) -> Option<(u8, String)> {
    let (rank, text) = match rule {
        Rule::arrow => (0, "`->`"),
        Rule::equals => (0, "`=`"),
        Rule::colon => (0, "`:` and a type"),
        Rule::dots => (0, "`..`"),
        Rule::open_brace | Rule::block => (0, "`{`"),
        Rule::close => (0, "`)`"),
        Rule::bar if !is_value_due(among) => (0, "`|`"),
        Rule::comma => (1, "`,`"),
        Rule::arguments | Rule::values | Rule::ranges | Rule::received => (1, "`(`"),
        Rule::open if !among.contains(&Rule::dot) && !is_value_due(among) => (1, "`(`"),
        Rule::kw_by => (1, "`by`"),
        Rule::kw_for => (1, "`for`"),
        Rule::kw_in => (1, "`in`"),
        Rule::kw_or if among.len() == 1 => (1, "`or`"),
        Rule::dot if among.len() == 1 => (1, "`.`"),
        Rule::kw_of | Rule::keypoints => (1, "`of`"),
        Rule::kw_else => (4, "`else`"),
        Rule::family => (0, "a family of scenes such as `convex-corner`"),
        Rule::name | Rule::argument | Rule::range => (0, "a name"),
        Rule::target => (0, "the name of a state"),
        Rule::kw_is | Rule::application => (1, "`is`"),
        Rule::type_name => (0, "a type"),
        Rule::module => (0, "a module such as `std.swipe`"),
        Rule::text if among.contains(&Rule::module) => (0, "the path of a file in quotes"),
        Rule::text => (0, "a text"),
        Rule::bound => (0, "a number"),
        Rule::chosen_value => (1, "`true`, `false` or a value such as `Side.left`"),
        Rule::quantity | Rule::number if !is_value_due(among) => (0, "a number"),
        Rule::file | Rule::machine | Rule::kw_machine => (0, "`machine` and its name"),
        // `param` represents all words that begin an item, and `do` all words that begin a statement.
        Rule::kw_param => return Some((2, items())),
        Rule::kw_do if among.contains(&Rule::kw_param) => (3, "a statement"),
        Rule::kw_state if among.contains(&Rule::kw_do) && !among.contains(&Rule::kw_param) => (3, "`state`"),
        Rule::kw_do => (2, "a statement"),
        Rule::kw_expect => (2, "`expect`"),
        Rule::kw_when => (3, "`when`"),
        Rule::kw_after => (3, "`after`"),
        Rule::kw_if if !among.contains(&Rule::kw_do) && !is_value_due(among) => (2, "`if`"),
        Rule::close_brace => (4, "`}`"),
        Rule::access | Rule::branch | Rule::expression | Rule::mover => (0, "a value"),
        Rule::sign | Rule::times => (CONTINUES, "an operator"),
        Rule::unit => (CONTINUES, "a unit"),
        _ => {
            let is_joint = |word: &&Word| word.is_only_at(Position::Inside) || word.is_only_at(Position::Property);
            let word = word_of(rule).filter(is_joint).filter(|word| !word.is_operator())?;
            return Some((0, format!("`{}`", word.text)));
        }
    };
    Some((rank, text.to_owned()))
}

/// The word that begins a rule.
fn first_word(rule: Rule) -> Option<&'static str> {
    match rule {
        Rule::file | Rule::machine => Some("machine"),
        Rule::library => Some("library"),
        _ => word_of(rule).map(|word| word.text),
    }
}
