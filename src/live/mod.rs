//! The live page: a run while it happens, its past, and what a changed policy would have done.
//!
//! A [`Live`] serves the page and its stream. A [`LiveWatcher`] passes the ticks of a run on to it. The run never waits for a viewer.
//! It waits only for its pace, and where a user has paused it.
//!
//! Why: docs/decisions/recordings.md#the-live-page-is-served-by-threads-from-copies-of-the-control-loop.

mod client;
mod error;
mod folder;
mod foxglove;
mod hub;
#[expect(clippy::module_inception, reason = "one noun a file, and this one is the module's name")]
mod live;
mod log;
mod page;
mod places;
mod replay;
mod request;
mod server;
mod socket;
mod token;
mod watcher;

pub use error::LiveError;
pub use folder::serve_folder;
pub use live::{Live, LiveOptions};
pub use replay::replay_setup;
pub use vibrissa_lab::stream::RunSetup;
pub use watcher::LiveWatcher;
