//! What a map by touch claims, against a world whose geometry is exact.
#![allow(clippy::unwrap_used, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an own world")]
#![allow(missing_docs, clippy::print_stdout, reason = "a test")]

mod certainty;
mod cost;
mod exploring;
mod in_control;
mod surfaces;
mod world;
