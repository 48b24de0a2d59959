//! Access to files: bounded reading of regular files, identities, atomic writing.
//!
//! No other code opens a file. `clippy.toml` forbids it.
//!
//! Why: docs/decisions/files.md#only-file-opens-files.
#![expect(clippy::disallowed_methods, reason = "this module opens all files")]

mod cache;
mod command_files;
mod identity;
mod output;
mod regular;
mod replace;
mod special;

pub(crate) use cache::{Cache, hex};
pub(crate) use command_files::CommandFiles;
pub(crate) use identity::is_at;
pub(crate) use output::{Output, OutputError};
#[cfg(feature = "lsp")]
pub(crate) use regular::read;
pub(crate) use regular::{append, open};
pub(crate) use replace::{replace, sync_name};
