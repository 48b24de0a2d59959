//! Tests of recordings.
#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "a test may panic and open files")]

mod failing;
mod schema;
