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
mod temporary_folder;

pub use cache::{Cache, hex};
pub use command_files::CommandFiles;
pub use identity::is_at;
pub use output::{Output, OutputError};
pub use regular::read;
pub use regular::{append, open};
pub use replace::{replace, sync_name};
pub use temporary_folder::TemporaryFolder;
