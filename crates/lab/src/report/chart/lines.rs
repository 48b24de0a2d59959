//! Indented lines of text.

use std::fmt::Write;

/// Number of blanks for each level.
const INDENT: usize = 2;

/// Lines in construction.
#[derive(Default)]
pub(super) struct Lines {
    text: String,
    depth: usize,
}

impl Lines {
    /// Adds a line.
    pub(super) fn push(&mut self, line: &str) {
        // Writing to a string cannot fail.
        let _ = writeln!(self.text, "{:indent$}{line}", "", indent = INDENT * self.depth);
    }

    /// Adds a line that ends in `{`, the lines of `inside`, and a closing line.
    pub(super) fn block(&mut self, head: &str, inside: impl FnOnce(&mut Self)) {
        self.push(&format!("{head} {{"));
        self.depth += 1;
        inside(self);
        self.depth -= 1;
        self.push("}");
    }

    /// The text.
    pub(super) fn finish(self) -> String {
        self.text
    }
}
