//! Entities and other records with a kind and pairs.

use super::super::OutlineError;
use super::pair::Pair;

/// A record of some kind with all its pairs.
#[derive(Debug)]
pub(super) struct Record<'t> {
    pub(super) kind: &'t str,
    /// The line of its kind.
    pub(super) line: usize,
    pub(super) pairs: Vec<Pair<'t>>,
    /// The vertices of a polyline.
    pub(super) vertices: Vec<Record<'t>>,
}

impl<'t> Record<'t> {
    pub(super) fn new(kind: &Pair<'t>) -> Self {
        Self { kind: kind.value, line: kind.line, pairs: Vec::new(), vertices: Vec::new() }
    }

    /// The first value of a group.
    fn value(&self, code: i32) -> Option<&Pair<'t>> {
        self.pairs.iter().find(|pair| pair.code == code)
    }

    /// The text of a group, empty by default.
    pub(super) fn text(&self, code: i32) -> &'t str {
        self.value(code).map_or("", |pair| pair.value)
    }

    /// The number of a group, or its default.
    pub(super) fn number(&self, code: i32, default: f64) -> Result<f64, OutlineError> {
        self.value(code).map_or(Ok(default), Pair::number)
    }

    /// The integer of a group, 0 by default.
    pub(super) fn integer(&self, code: i32) -> Result<i32, OutlineError> {
        self.value(code).map_or(Ok(0), Pair::integer)
    }

    /// The position of a point, by the group code of its x coordinate.
    pub(super) fn place(&self, code: i32) -> Result<[f64; 2], OutlineError> {
        Ok([self.number(code, 0.0)?, self.number(code + 10, 0.0)?])
    }

    /// The name of its layer.
    pub(super) fn layer(&self) -> &'t str {
        self.text(8)
    }

    /// True if the entity belongs to a paper layout instead of the model.
    pub(super) fn is_on_paper(&self) -> bool {
        self.text(67) == "1"
    }

    pub(super) fn is_visible(&self) -> bool {
        self.text(60) != "1"
    }
}
