//! The group pairs of a DXF: a line with a group code, and a line with its value.

use super::super::text::{lines, shown};
use super::super::{OutlineError, OutlineFault};

/// A value with its group code.
#[derive(Copy, Clone, Debug)]
pub(super) struct Pair<'t> {
    pub(super) code: i32,
    pub(super) value: &'t str,
    /// The line of the value.
    pub(super) line: usize,
}

impl Pair<'_> {
    /// The value as a number.
    pub(super) fn number(&self) -> Result<f64, OutlineError> {
        self.value.parse().map_err(|_| syntax(self.line, "a number", self.value))
    }

    /// The value as an integer.
    pub(super) fn integer(&self) -> Result<i32, OutlineError> {
        self.value.parse().map_err(|_| syntax(self.line, "a whole number", self.value))
    }
}

/// The pairs of a text, up to the first invalid one.
pub(super) fn pairs(text: &str) -> impl Iterator<Item = Result<Pair<'_>, OutlineError>> {
    let mut lines = lines(text);
    let mut is_over = false;
    std::iter::from_fn(move || {
        let (line, code) = lines.next().filter(|_| !is_over)?;
        let pair = match (code.trim().parse(), lines.next()) {
            (Ok(code), Some((line, value))) => Ok(Pair { code, value: value.trim(), line }),
            (Ok(_), None) => Err(cut_off().at(Some(line))),
            (Err(_), _) => Err(syntax(line, "the number of a group", code)),
        };
        is_over = pair.is_err();
        Some(pair)
    })
}

/// The error for a truncated text.
pub(super) fn cut_off() -> OutlineFault {
    OutlineFault::Syntax { reason: "it ends before the drawing does".to_owned() }
}

fn syntax(line: usize, expected: &str, found: &str) -> OutlineError {
    OutlineFault::Syntax { reason: format!("expected {expected}, found `{}`", shown(found)) }.at(Some(line))
}
