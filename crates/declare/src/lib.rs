//! Facts that several crates of Vibrissa share. Each fact stands here once, and everything else is derived from it.
//!
//! - [`catalogue`] names the families of scenes and their parameters.
//! - [`figures`] declares the figures of a run.

#[expect(missing_docs, reason = "the meaning of a parameter is a part of its value")]
pub mod catalogue;
pub mod figures;
