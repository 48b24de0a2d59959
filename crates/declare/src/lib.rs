//! Facts that several crates of Vibrissa share. Each fact stands here once, and everything else is derived from it.
//!
//! - [`catalogue`] names the families of scenes and their parameters.
//! - [`figures`] declares the figures of a run.
//! - [`rig`] has the keys of a rig, and [`mismatch`] those in which the true array may differ.
//! - [`physics`] has the settings of a simulation, and the predefined rigs.
//!
//! # Where to begin
//!
//! A new figure is an entry of `figures/table.rs`, a key of a rig one of `rig/keys.rs`. The tests of readers, pages and schemas then fail
//! until their generated parts are written again. Names in these tables stand in files of users, so an existing one stays as it is.

#[expect(missing_docs, reason = "the meaning of a parameter is a part of its value")]
pub mod catalogue;
pub mod figures;
pub mod mismatch;
pub mod physics;
pub mod rig;
