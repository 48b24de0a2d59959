//! The language server of policies: what editors ask over the Language Server Protocol, answered from `policy`.
//!
//! Only the protocol is here: its messages, its life, its places in lines and UTF-16. What is known of a text, `policy` knows.
//! One message is answered after the other, so that an answer always belongs to the text that the editor had when it asked. A text is
//! compiled when something is asked, or when nothing comes in any more: of changes that wait in a row the last alone.

mod answer;
mod capabilities;
mod change;
mod complete;
mod diagnose;
mod document;
mod look;
mod position;
mod queue;
mod server;
mod uri;
mod wire;

pub(crate) use server::{Ended, serve};
