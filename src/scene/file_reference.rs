//! References to files.

use std::path::PathBuf;

use crate::diagnostic::Span;

/// A file to which a scenario or a sweep refers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileReference {
    /// The path, relative to the referring file.
    pub path: PathBuf,
    /// The name of the file without its extension.
    pub name: String,
    /// The position of the reference in the text.
    pub span: Span,
}
