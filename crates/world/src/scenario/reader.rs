//! Reading of a scenario.

use std::ops::{Deref, DerefMut};

use crate::outline::MAX_PIECES;
use vibrissa_text::diagnostic::{Diagnostic, Source, Span};
use vibrissa_yaml::{Files, fault};

/// The reader of a text with what all objects of a scenario need together.
pub(super) struct Reader<'s> {
    base: vibrissa_yaml::Reader<'s>,
    /// Lines and arcs of the objects so far.
    pieces: usize,
    /// True if the text states the simulator that has a least inertia. Without a statement, a command may choose another one.
    pub(super) is_mujoco: bool,
}

impl<'s> Reader<'s> {
    /// Creates a reader for `source` with the diagnostics that exist so far. Referenced files are in `files`.
    pub(super) fn new(source: &'s Source, files: &'s mut Files<'s>, faults: Vec<Diagnostic>) -> Self {
        let base = vibrissa_yaml::Reader::new(source, files, faults);
        Self { base, pieces: 0, is_mujoco: false }
    }

    /// Returns the result, or the diagnostics in the order of the text.
    pub(super) fn finish<T>(self, read: Option<T>) -> Result<T, Vec<Diagnostic>> {
        self.base.finish(read)
    }

    /// The bytes of the file of an outline.
    pub(super) fn outline_file(&mut self, path: &str) -> Result<Vec<u8>, String> {
        if self.pieces > MAX_PIECES {
            return Err("there are too many lines and arcs already".to_owned());
        }
        self.file(path)
    }

    /// Counts the pieces of an object at `place` before it is created. Reports the first total above the limit. Above it, no
    /// object is created.
    pub(super) fn make(&mut self, pieces: usize, place: Span) -> Option<()> {
        if self.pieces > MAX_PIECES {
            return None;
        }
        self.pieces = self.pieces.saturating_add(pieces);
        if self.pieces <= MAX_PIECES {
            return Some(());
        }
        let message = "the objects have too many lines and arcs";
        let label = format!("up to {} with this object; the limit is {MAX_PIECES}", self.pieces);
        let fault = Diagnostic::error(fault::TOO_LARGE, message, place, label);
        self.report(fault.hint("leave out objects, or make them with fewer sides, shorter lines or longer waves"));
        None
    }
}

impl<'s> Deref for Reader<'s> {
    type Target = vibrissa_yaml::Reader<'s>;

    fn deref(&self) -> &Self::Target {
        &self.base
    }
}

impl DerefMut for Reader<'_> {
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.base
    }
}
