//! The language server over its real protocol: the program as a child, messages through its standard input and output.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]
#![allow(clippy::needless_pass_by_value, reason = "JSON literals read better without `&`")]

mod answer;
mod client;
mod completion;
mod edits;
mod fault;
mod files;
mod places;
mod protocol;
mod session;
