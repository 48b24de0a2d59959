//! The language server for policies. It answers requests of the Language Server Protocol from `policy`.
//!
//! This module contains only the protocol: its messages, its life cycle, and its positions in lines and UTF-16. All
//! knowledge of a text is in `policy`. Messages are answered one after the other, so an answer refers to the text that
//! the editor had when it asked. A text is compiled when a request needs it, or when no more messages arrive. Of
//! several queued changes only the last is compiled.

mod capabilities;
mod change;
mod complete;
mod diagnose;
mod dispatch;
mod document;
mod navigation;
mod position;
mod queue;
#[expect(clippy::module_inception, reason = "one noun a file, and this one is the module's name")]
mod server;
mod session;
mod transport;
mod uri;

pub use server::{Ended, Library, serve};
pub use session::Session;
