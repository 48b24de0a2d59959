//! Text files.

use super::super::text::{lines, shown};
use super::super::{OutlineError, OutlineFault};
use super::triangle::{Solid, Triangle};

/// What a comment begins with. The format has none, but some programs write them.
const COMMENTS: [&str; 3] = ["#", ";", "//"];

/// What no binary file has.
const VERTEX: &[u8] = b"vertex";

/// True if a file is a text: its first word is `solid`, in any case. A binary file may begin so too, but it has bytes of zero and no
/// `vertex`.
pub(super) fn is_text(bytes: &[u8]) -> bool {
    let text = without_padding(bytes);
    let begins = || words(&String::from_utf8_lossy(text)).next().is_some_and(|word| word.begins("solid"));
    let has_vertex = || text.windows(VERTEX.len()).any(|word| word.eq_ignore_ascii_case(VERTEX));
    (!text.contains(&0) || has_vertex()) && begins()
}

/// Reads all solids.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<Solid>, OutlineError> {
    // A name may be in another encoding. Everything else is ASCII.
    let text = String::from_utf8_lossy(without_padding(bytes));
    let mut words = Words { rest: words(&text), line: 1 };
    let mut solids = Vec::new();
    while let Some(word) = words.next() {
        if !word.begins("solid") {
            return Err(unexpected("`solid`", word));
        }
        let mut solid = Vec::new();
        loop {
            let word = words.expect("`endsolid`")?;
            if word.is("facet") {
                solid.push(words.triangle(word.line)?);
            } else if words.is_end(word, "solid") {
                break;
            } else {
                return Err(unexpected("`facet` or `endsolid`", word));
            }
        }
        solids.push(solid);
    }
    Ok(solids)
}

fn without_padding(bytes: &[u8]) -> &[u8] {
    let end = bytes.iter().rposition(|byte| *byte != 0).map_or(0, |last| last + 1);
    bytes.get(..end).unwrap_or_default()
}

/// A word with its line.
#[derive(Copy, Clone)]
struct Word<'t> {
    text: &'t str,
    line: usize,
}

impl Word<'_> {
    fn is(self, keyword: &str) -> bool {
        self.text.eq_ignore_ascii_case(keyword)
    }

    fn begins(self, keyword: &str) -> bool {
        self.text.get(..keyword.len()).is_some_and(|start| start.eq_ignore_ascii_case(keyword))
    }
}

/// The words of a text without comments and names.
fn words(text: &str) -> impl Iterator<Item = Word<'_>> {
    let lines = lines(text).filter(|(_, line)| !COMMENTS.iter().any(|comment| line.trim_start().starts_with(comment)));
    lines.flat_map(|(line, text)| without_name(text).map(move |text| Word { text, line }))
}

/// The words of a line without the name behind `solid` or `endsolid`. A triangle in the same line is no part of the name.
fn without_name(line: &str) -> impl Iterator<Item = &str> {
    let words = || line.split_whitespace();
    let is = |word: Option<&str>, keyword: &str| word.is_some_and(|word| word.eq_ignore_ascii_case(keyword));
    let first = words().next();
    let keywords = if first.is_some_and(|text| Word { text, line: 0 }.begins("solid")) || is(first, "endsolid") {
        1
    } else if is(first, "end") && is(words().nth(1), "solid") {
        2
    } else {
        usize::MAX
    };
    let triangle = words().zip(words().skip(1)).position(|(first, second)| {
        is(Some(first), "facet") && ["normal", "outer"].iter().any(|keyword| is(Some(second), keyword))
    });
    let rest = triangle.unwrap_or(usize::MAX);
    words().enumerate().filter(move |&(index, _)| index < keywords || index >= rest).map(|(_, word)| word)
}

/// The words that have not been read.
struct Words<I> {
    rest: I,
    /// The line of the last word.
    line: usize,
}

impl<'t, I: Iterator<Item = Word<'t>>> Words<I> {
    fn next(&mut self) -> Option<Word<'t>> {
        let word = self.rest.next()?;
        self.line = word.line;
        Some(word)
    }

    fn expect(&mut self, what: &str) -> Result<Word<'t>, OutlineError> {
        let line = self.line;
        let cut_off = || OutlineFault::Syntax { reason: format!("it ends where {what} is missing") }.at(Some(line));
        self.next().ok_or_else(cut_off)
    }

    fn keyword(&mut self, keyword: &str) -> Result<(), OutlineError> {
        let what = format!("`{keyword}`");
        let word = self.expect(&what)?;
        if word.is(keyword) { Ok(()) } else { Err(unexpected(&what, word)) }
    }

    /// True if `word` ends a `part`, as `endpart` or as `end part`.
    fn is_end(&mut self, word: Word<'t>, part: &str) -> bool {
        let joined =
            word.begins("end") && word.text.get("end".len()..).is_some_and(|rest| rest.eq_ignore_ascii_case(part));
        joined || (word.is("end") && self.next().is_some_and(|word| word.is(part)))
    }

    fn end(&mut self, part: &str) -> Result<(), OutlineError> {
        let what = format!("`end{part}`");
        let word = self.expect(&what)?;
        if self.is_end(word, part) { Ok(()) } else { Err(unexpected(&what, word)) }
    }

    /// Reads a triangle behind `facet`. Its normal is not used, and so it may have any three words.
    fn triangle(&mut self, line: usize) -> Result<Triangle, OutlineError> {
        let mut word = self.expect("`normal`")?;
        if word.is("normal") {
            word = self.expect("`outer`")?;
            for _ in 0..3 {
                if !word.is("outer") {
                    word = self.expect("`outer`")?;
                }
            }
        }
        if !word.is("outer") {
            return Err(unexpected("`outer loop`", word));
        }
        self.keyword("loop")?;
        let mut corners = [[0.0; 3]; 3];
        for corner in &mut corners {
            self.keyword("vertex")?;
            for coordinate in corner {
                let word = self.expect("a number")?;
                *coordinate = word.text.parse().map_err(|_| unexpected("a number", word))?;
            }
        }
        self.end("loop")?;
        self.end("facet")?;
        Ok(Triangle { corners, line: Some(line) })
    }
}

fn unexpected(what: &str, found: Word<'_>) -> OutlineError {
    OutlineFault::Syntax { reason: format!("expected {what}, found `{}`", shown(found.text)) }.at(Some(found.line))
}
