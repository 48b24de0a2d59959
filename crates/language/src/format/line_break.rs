//! Line breaks.

use super::line::{INDENT, Kind, Line, Piece, WIDTH};
use super::spacing::{is_apart, may_break};
use super::structure::{Element, Structure};
use crate::token::Kind as TokenKind;

/// Additional indentation of the second and further lines of a statement.
const CONTINUATION: usize = 2 * INDENT;

/// Divides a text into lines.
pub(super) fn break_lines<'t>(structure: &Structure<'t>) -> Vec<Line<'t>> {
    let mut broken = broken_by_the_author(structure);
    loop {
        break_together(structure, &mut broken);
        let lines = LineBreaker::new(structure, &broken).cut();
        if !break_too_long(structure, &lines, &mut broken) {
            return lines;
        }
    }
}

/// For every block, true if the author's text has a line break in it.
fn broken_by_the_author(structure: &Structure<'_>) -> Vec<bool> {
    // For each token, the number of line breaks up to it.
    let ended: Vec<usize> = structure
        .elements
        .iter()
        .scan(0, |ended, element| {
            *ended += usize::from(element.token.line_ends > 0);
            Some(*ended)
        })
        .collect();
    structure.blocks.iter().map(|block| !block.is_empty() && ended[block.open] < ended[block.close]).collect()
}

/// Breaks all blocks of a statement if one of them is broken.
fn break_together(structure: &Structure<'_>, broken: &mut [bool]) {
    let mut statement = vec![false; broken.len()];
    for (block, &broken) in structure.blocks.iter().zip(&*broken) {
        statement[block.first] |= broken;
    }
    for (block, broken) in structure.blocks.iter().zip(broken) {
        *broken = statement[block.first] && !block.is_empty();
    }
}

/// Breaks the outermost blocks of lines that are too long. True if there was one.
fn break_too_long(structure: &Structure<'_>, lines: &[Line<'_>], broken: &mut [bool]) -> bool {
    let mut any = false;
    for line in lines.iter().filter(|line| line.width() > WIDTH) {
        let mut behind = line.tokens.start;
        for element in &structure.elements[line.tokens.clone()] {
            let Some(number) = element.block.filter(|&number| !broken[number]) else { continue };
            let block = structure.blocks[number];
            if block.open >= behind && line.tokens.contains(&block.close) && !block.is_empty() {
                behind = block.close;
                broken[number] = true;
                any = true;
            }
        }
    }
    any
}

/// Divides a text whose broken blocks are known into lines.
struct LineBreaker<'s, 't> {
    structure: &'s Structure<'t>,
    broken: &'s [bool],
    /// The open blocks, the innermost last.
    open: Vec<usize>,
    /// Number of open parentheses in the current statement.
    parentheses: usize,
    lines: Vec<Line<'t>>,
}

impl<'s, 't> LineBreaker<'s, 't> {
    fn new(structure: &'s Structure<'t>, broken: &'s [bool]) -> Self {
        Self { structure, broken, open: Vec::new(), parentheses: 0, lines: Vec::new() }
    }

    fn cut(mut self) -> Vec<Line<'t>> {
        let elements = &self.structure.elements;
        // The previous token that is not a comment.
        let mut before: Option<&Element<'t>> = None;
        for (index, element) in elements.iter().enumerate() {
            if element.token.is("}") && element.block.is_some() {
                self.open.pop();
            }
            if element.begins {
                self.parentheses = 0;
            }
            if element.token.is(")") {
                self.parentheses = self.parentheses.saturating_sub(1);
            }
            let neighbour = index.checked_sub(1).map(|index| &elements[index]);
            let on_line = neighbour.filter(|neighbour| !self.ends_line(neighbour, element));
            if let Some((neighbour, line)) = on_line.zip(self.lines.last_mut()) {
                line.tokens.end = index + 1;
                line.has_comment = element.token.kind == TokenKind::Comment;
                let blanks = if line.has_comment { 2 } else { usize::from(is_apart(neighbour, element)) };
                line.pieces.push(Piece { blanks, text: element.token.text });
            } else {
                let line = self.line(index, before);
                self.lines.push(line);
            }
            if element.token.is("{") {
                self.open.extend(element.block);
            }
            if element.token.is("(") {
                self.parentheses += 1;
            }
            if element.token.kind != TokenKind::Comment {
                before = Some(element);
            }
        }
        self.lines
    }

    fn is_broken(&self, block: Option<usize>) -> bool {
        block.is_none_or(|block| self.broken[block])
    }

    /// True if a line ends between two neighbours.
    fn ends_line(&self, before: &Element<'_>, element: &Element<'_>) -> bool {
        let ended = element.token.line_ends > 0;
        if before.token.kind == TokenKind::Comment {
            true
        } else if element.token.kind == TokenKind::Comment {
            ended
        } else if element.begins {
            self.is_broken(self.open.last().copied())
        } else if element.token.is("}") {
            self.is_broken(element.block)
        } else {
            ended && may_break(before, element)
        }
    }

    /// The line that begins with the token `index`. `before` is the previous token that is not a comment.
    fn line(&self, index: usize, before: Option<&Element<'_>>) -> Line<'t> {
        let element = &self.structure.elements[index];
        let level = self.open.len();
        let kind = if element.token.kind == TokenKind::Comment {
            let mut behind =
                self.structure.elements[index..].iter().filter(|element| element.token.kind != TokenKind::Comment);
            let between = behind.next().is_none_or(|element| element.begins || element.token.is("}"));
            if between { Kind::Comment } else { Kind::Continuation }
        } else if element.begins {
            Kind::Begin
        } else if element.token.is("}") {
            Kind::Close
        } else {
            Kind::Continuation
        };
        let at_level = kind != Kind::Continuation
            || element.token.is("{")
            || before.is_some_and(|before| before.token.is("}"))
            || (element.token.is(")") && self.parentheses == 0);
        Line {
            kind,
            level,
            indent: INDENT * level + if at_level { 0 } else { CONTINUATION },
            pieces: vec![Piece { blanks: 0, text: element.token.text }],
            has_comment: false,
            blank_before: matches!(kind, Kind::Begin | Kind::Comment)
                && element.token.line_ends > 1
                && self.lines.last().is_some_and(|last| last.level >= level),
            tokens: index..index + 1,
        }
    }
}
