//! A file that a scenario or a sweep names.

use std::path::PathBuf;

use super::yaml;
use crate::diagnostic::{Diagnostic, Span};

/// A file that a scenario or a sweep names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileReference {
    /// Its path, relative to the file that names it.
    pub path: PathBuf,
    /// The name of the file without its ending.
    pub name: String,
    /// Where it is named.
    pub span: Span,
}

impl FileReference {
    /// That the file cannot be read, at the place that names it, for a `reason`.
    #[must_use]
    pub fn unreadable(&self, reason: &str) -> Diagnostic {
        yaml::unreadable(self, reason)
    }
}
