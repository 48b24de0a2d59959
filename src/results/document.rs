//! JSON outputs and their versions.

use serde::Serialize;

/// What a command writes as JSON: an object that names its format and the version of that.
///
/// A version is raised when a key goes, gets another name or another meaning. A key that is added does not raise it. `docs/json.md` has the
/// promise, `docs/schema` a schema of every format.
pub trait Document: Serialize {
    /// Name of the format.
    const FORMAT: &'static str;
    /// Its version.
    const VERSION: u32 = 1;

    /// The document with its format and version, to be serialised.
    fn versioned(&self) -> Versioned<'_, Self> {
        Versioned { format: Self::FORMAT, version: Self::VERSION, document: self }
    }
}

/// A document with its format and version before its own keys.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Versioned<'d, D: ?Sized> {
    format: &'static str,
    version: u32,
    #[serde(flatten)]
    document: &'d D,
}
