//! Lines, and blank lines between them.

use std::ops::Range;

/// Blanks per level of braces.
pub(super) const INDENT: usize = 2;
/// The width in columns up to which a block may stay on one line, and up to which columns are aligned.
pub(super) const WIDTH: usize = 100;

/// A part of a line.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece<'t> {
    /// Blanks before the piece.
    pub(super) blanks: usize,
    pub(super) text: &'t str,
}

impl Piece<'_> {
    fn width(&self) -> usize {
        self.blanks + self.text.chars().count()
    }
}

/// The kind of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// The beginning of a statement or an item.
    Begin,
    /// A comment between statements.
    Comment,
    /// The end of a block.
    Close,
    /// The continuation of a statement.
    Continuation,
}

/// A line.
#[derive(Debug, Clone)]
pub(super) struct Line<'t> {
    pub(super) kind: Kind,
    /// Number of open blocks around the line.
    pub(super) level: usize,
    /// Blanks before the line.
    pub(super) indent: usize,
    pub(super) pieces: Vec<Piece<'t>>,
    /// True if the last piece is a comment after other pieces.
    pub(super) has_comment: bool,
    /// True if a blank line precedes it.
    pub(super) blank_before: bool,
    /// Indices of its tokens.
    pub(super) tokens: Range<usize>,
}

impl Line<'_> {
    /// Width (characters) without the comment.
    pub(super) fn width(&self) -> usize {
        self.width_of(self.pieces.len() - usize::from(self.has_comment))
    }

    /// Width (characters) with the comment.
    pub(super) fn full_width(&self) -> usize {
        self.width_of(self.pieces.len())
    }

    /// The column, from 0, of the piece `index`.
    pub(super) fn start(&self, index: usize) -> usize {
        self.width_of(index) + self.pieces[index].blanks
    }

    fn width_of(&self, count: usize) -> usize {
        self.indent + self.pieces.iter().take(count).map(Piece::width).sum::<usize>()
    }

    fn is_comment_at(&self, level: usize) -> bool {
        self.kind == Kind::Comment && self.level == level
    }

    /// True for an item, or for an inner state.
    fn is_item(&self) -> bool {
        self.kind == Kind::Begin && (self.level == 0 || self.pieces.first().is_some_and(|piece| piece.text == "state"))
    }
}

/// Adds a blank line before and after every item with a broken block. The comments above an item belong to it.
pub(super) fn separate(lines: &mut [Line<'_>]) {
    for index in 0..lines.len() {
        let level = lines[index].level;
        let is_part = |line: &&Line<'_>| {
            line.level > level || (line.level == level && matches!(line.kind, Kind::Close | Kind::Continuation))
        };
        let parts = lines[index + 1..].iter().take_while(is_part);
        if !lines[index].is_item() || !parts.clone().any(|line| line.kind == Kind::Close) {
            continue;
        }
        let behind = index + 1 + parts.count();
        let mut first = index;
        while !lines[first].blank_before && first > 0 && lines[first - 1].is_comment_at(level) {
            first -= 1;
        }
        lines[first].blank_before = first > 0 && lines[first - 1].level >= level;
        if let Some(line) = lines.get_mut(behind) {
            line.blank_before = line.kind != Kind::Close;
        }
    }
}

/// Converts lines to text.
pub(super) fn render(lines: &[Line<'_>]) -> String {
    let mut text = String::new();
    for line in lines {
        if line.blank_before {
            text.push('\n');
        }
        text.extend(std::iter::repeat_n(' ', line.indent));
        for piece in &line.pieces {
            text.extend(std::iter::repeat_n(' ', piece.blanks));
            text.push_str(piece.text);
        }
        text.push('\n');
    }
    text
}
