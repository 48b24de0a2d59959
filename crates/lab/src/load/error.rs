//! Errors of reading files.

use std::path::{Path, PathBuf};
use vibrissa_text::system::in_words;

#[cfg(feature = "robot")]
use vibrissa_robot::recording::ReadError;
use vibrissa_runtime::machine::ArtifactError;

use crate::calibration::SetsError;
use vibrissa_text::diagnostic::{Diagnostic, Source};
use vibrissa_world::scenario::unreadable;
use vibrissa_world::scene::FileReference;

use super::seed::WithoutEffect;
use super::sought::Sought;
use super::text::reason;

/// The error of a file that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// The file cannot be read.
    #[error("cannot read {}: {words}", path.display(), words = in_words(cause))]
    Read {
        /// The file.
        path: PathBuf,
        /// The cause.
        cause: std::io::Error,
    },
    /// There is no file at the path, and no built-in text has this name.
    #[error(
        "cannot read {}: {words}; a {sought} is needed here{}; the built-in names are {}",
        path.display(), meant.as_ref().map_or_else(String::new, |meant| format!("; did you mean `{meant}`?")), sought.names(), words = in_words(cause))]
    Missing {
        /// What the path is given for.
        sought: Sought,
        /// The path.
        path: PathBuf,
        /// The most probable meaning, a built-in name or a file of the same folder.
        meant: Option<String>,
        /// The cause.
        cause: std::io::Error,
    },
    /// The path is not UTF-8 text.
    #[error(
        "cannot read {}: its path is not UTF-8 text; rename the file or folder, or run the command in the folder of the file",
        path.as_os_str().as_encoded_bytes().escape_ascii()
    )]
    Name {
        /// The file.
        path: PathBuf,
    },
    /// The scenario draws nothing, so it is no family.
    #[error("{} has no section `draw`, so it is one scene and no family; run it with `vibrissa run`, or draw its values", path.display())]
    NoFamily {
        /// The file.
        path: PathBuf,
    },
    /// The text has errors.
    #[error("{}", faults.len())]
    Faults {
        /// The text.
        source_text: Box<Source>,
        /// The errors.
        faults: Vec<Diagnostic>,
    },
    /// The file is not a valid compiled policy.
    #[error("{}: {cause}", path.display())]
    Artifact {
        /// The file.
        path: PathBuf,
        /// The cause.
        cause: ArtifactError,
    },
    /// The file is a compiled policy where a text is needed.
    #[error("{} is a compiled machine, which does not hold its text; give the policy that it was made from, {origin}", path.display())]
    Compiled {
        /// The file.
        path: PathBuf,
        /// The path of the text when it was compiled.
        origin: String,
    },
    /// The file is a test file where a policy is needed.
    #[error("{} is a test file; give the file of the machine that its first line names, or run `vibrissa test`", path.display())]
    TestFile {
        /// The file.
        path: PathBuf,
    },
    /// The file has no valid contact sets.
    #[error("{}: {cause}", path.display())]
    Sets {
        /// The file.
        path: PathBuf,
        /// The cause.
        cause: SetsError,
    },
    /// An option has no effect.
    #[error(transparent)]
    WithoutEffect(#[from] WithoutEffect),
    /// The file is no recording that can be used.
    #[cfg(feature = "robot")]
    #[error("{}: {cause}", path.display())]
    Recording {
        /// The file, or the first one of several.
        path: PathBuf,
        /// The cause.
        cause: ReadError,
    },
}

impl LoadError {
    /// The error of reading the file at `path`.
    pub fn read(path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.to_owned();
        |cause| Self::Read { path, cause }
    }

    /// The error of the compiled policy at `path`.
    pub fn artifact(path: &Path) -> impl FnOnce(ArtifactError) -> Self {
        let path = path.to_owned();
        |cause| Self::Artifact { path, cause }
    }

    /// The error of the recording at `path`.
    #[cfg(feature = "robot")]
    pub fn recording(path: &Path) -> impl FnOnce(ReadError) -> Self {
        let path = path.to_owned();
        |cause| Self::Recording { path, cause }
    }

    /// The error that is one diagnostic of a text.
    #[must_use]
    pub fn at(source: &Source, fault: Diagnostic) -> Self {
        Self::Faults { source_text: Box::new(source.clone()), faults: vec![fault] }
    }

    /// Converts a file that cannot be read into a diagnostic at the span in `source` that names it. Other errors stay
    /// as they are.
    pub(crate) fn named_in(source: &Source, file: &FileReference) -> impl FnOnce(Self) -> Self {
        |error| match error {
            Self::Read { path, cause } | Self::Missing { path, cause, .. } => {
                Self::at(source, unreadable(file, &reason(&path, &cause)))
            }
            other => other,
        }
    }
}
