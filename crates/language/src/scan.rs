//! The coarse parts of any text: words, strings, marks and comments.
//!
//! They are read without the grammar. So they tell where a text can be parsed again after an error, and whether its
//! brackets nest so deeply that the parser must not begin.

/// A word, a string, a mark or a comment.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lexeme<'t> {
    pub(super) text: &'t str,
    /// Its first byte.
    pub(super) start: usize,
    /// Indentation, if the lexeme is the first of its line.
    pub(super) indent: Option<usize>,
}

impl Lexeme<'_> {
    pub(super) fn is_comment(&self) -> bool {
        self.text.starts_with('#')
    }

    /// True for the keyword at the beginning of a file.
    pub(super) fn is_heading(&self) -> bool {
        ["machine", "library", "tests"].contains(&self.text)
    }
}

/// The lexemes of a text, without comments.
pub(super) fn scan(text: &str) -> impl Iterator<Item = Lexeme<'_>> {
    scan_all(text).filter(|lexeme| !lexeme.is_comment())
}

/// The lexemes of a text, with comments. They are found one after the other.
pub(super) fn scan_all(text: &str) -> impl Iterator<Item = Lexeme<'_>> {
    let mut at = 0;
    // Start of the line, while only blanks have occurred in it.
    let mut line = Some(0);
    std::iter::from_fn(move || {
        loop {
            let rest = &text[at..];
            let letter = rest.chars().next()?;
            let start = at;
            if letter == '\n' {
                at += 1;
                line = Some(at);
                continue;
            }
            let word = word_length(rest);
            at += match letter {
                _ if word > 0 => word,
                '#' => rest.find('\n').unwrap_or(rest.len()),
                '"' => rest[1..].find(['"', '\n']).map_or(rest.len(), |end| end + 2),
                _ => letter.len_utf8(),
            };
            if !letter.is_whitespace() {
                let is_comment = letter == '#';
                let indent = if is_comment { None } else { line.take().map(|line| start - line) };
                return Some(Lexeme { text: &text[start..at], start, indent });
            }
        }
    })
}

/// True if the braces of a text are balanced.
pub(super) fn are_braces_balanced(text: &str) -> bool {
    let mut depth = 0_usize;
    for lexeme in scan(text) {
        match lexeme.text {
            "{" => depth += 1,
            "}" if depth == 0 => return false,
            "}" => depth -= 1,
            _ => {}
        }
    }
    depth == 0
}

/// Length of the word at the beginning of a text (bytes).
fn word_length(text: &str) -> usize {
    let is_plain = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_';
    match text.bytes().enumerate().find(|&(_, byte)| !is_plain(byte)) {
        Some((_, byte)) if !byte.is_ascii() => text.find(|letter| !is_word(letter)).unwrap_or(text.len()),
        end => end.map_or(text.len(), |(at, _)| at),
    }
}

pub(super) fn is_word(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_'
}
