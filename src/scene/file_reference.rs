//! A file that a scenario or a sweep names.

use std::path::PathBuf;

use crate::diagnostic::Span;

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
