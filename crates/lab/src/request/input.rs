//! What a request is made of.

use std::path::PathBuf;

use crate::built_in::TextFile;
use vibrissa_runtime::machine::Artifact;
use vibrissa_text::diagnostic::Source;

/// A scenario or a mismatch.
#[derive(Debug, Clone)]
pub enum Input {
    /// A file.
    File(PathBuf),
    /// A text. Paths in it are relative to the folder of its name.
    Text(Source),
    /// A text of the program. It reads no file, and the policy that a scenario names is a built-in one.
    BuiltIn(&'static TextFile),
}

/// A policy.
#[derive(Debug, Clone)]
pub enum PolicyInput {
    /// The file of a policy or of a compiled machine.
    File(PathBuf),
    /// The text of a policy. Paths in it are relative to the folder of its name.
    Text(Source),
    /// A policy of the program.
    BuiltIn(&'static TextFile),
    /// A compiled machine.
    Machine(Box<Artifact>),
}
