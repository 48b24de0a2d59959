//! JSON outputs and their versions.

use serde::Serialize;

use super::Provenance;

/// A JSON output of a command: an object with the name of its format and the version of the format.
///
/// The version is raised if a key is removed, renamed or changes its meaning. A new key does not raise it.
/// `docs/json.md` describes this promise. `docs/schema` has a schema of every format.
pub trait Document: Serialize {
    /// Name of the format.
    const FORMAT: &'static str;
    /// Its version.
    const VERSION: u32 = 1;

    /// The document with its format, version and origin, to be serialised. Lines of a file after the first have no origin of their own.
    fn versioned<'d>(&'d self, provenance: Option<&'d Provenance>) -> Versioned<'d, Self> {
        Versioned { format: Self::FORMAT, version: Self::VERSION, provenance, document: self }
    }
}

impl Document for vibrissa_world::world::Pruning {
    const FORMAT: &'static str = "pruning";
}

/// A document with its format, version and origin before its own keys.
#[derive(Debug, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Versioned<'d, D: ?Sized> {
    format: &'static str,
    version: u32,
    /// The origin. `None` in the lines of a file after the first, and in the messages of a recording.
    provenance: Option<&'d Provenance>,
    #[serde(flatten)]
    document: &'d D,
}
