//! Entities and what else has a kind and pairs.

use super::super::OutlineError;
use super::pair::Pair;

/// Something of a kind, with all its pairs.
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

    /// The text of a group; empty if it is left out.
    pub(super) fn text(&self, code: i32) -> &'t str {
        self.value(code).map_or("", |pair| pair.value)
    }

    /// The number of a group, or the one that it has if it is left out.
    pub(super) fn number(&self, code: i32, default: f64) -> Result<f64, OutlineError> {
        self.value(code).map_or(Ok(default), Pair::number)
    }

    /// The whole number of a group, 0 if it is left out.
    pub(super) fn integer(&self, code: i32) -> Result<i32, OutlineError> {
        self.value(code).map_or(Ok(0), Pair::integer)
    }

    /// The x and y of a point whose x is in a group.
    pub(super) fn place(&self, code: i32) -> Result<[f64; 2], OutlineError> {
        Ok([self.number(code, 0.0)?, self.number(code + 10, 0.0)?])
    }

    /// The name of its layer.
    pub(super) fn layer(&self) -> &'t str {
        self.text(8)
    }

    /// Whether it is on a sheet on which the model is shown, and no part of the model.
    pub(super) fn is_on_paper(&self) -> bool {
        self.text(67) == "1"
    }

    pub(super) fn is_visible(&self) -> bool {
        self.text(60) != "1"
    }
}
