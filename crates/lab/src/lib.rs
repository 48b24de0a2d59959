//! Runs of policies in scenes, their scores, experiments over many runs, and reports.
//!
//! - [`trial`] combines a scene, a policy, a simulator and a seed. [`run`] has the trace, [`score`] the figures, [`results`] the documents.
//! - [`load`] and [`request`] make trials of files and options. [`built_in`] has the files that the program contains.
//! - [`study`], [`family`], [`sweep`], [`tune`] and `property` run many trials.
//! - [`inspect`] looks into a running policy, `recording` keeps and replays runs.
//! - [`stream`] has the messages of a run that pages show. [`calibration`] fits measured whiskers, `emulated` runs trials with the robot's loop.
//! - [`report`] makes tables, pages and pictures of all of them.
//!
//! # Where to begin
//!
//! A family of scenes is a file of `family`, a column of the table of runs an entry of the crate `declare`, of
//! another table its file in `report/tables`, a chart a file of `report/chart`.
//! `docs/howto/extend.md` has the steps. Read `docs/decisions/scores.md` before you change [`score`], because published figures
//! depend on it.

pub mod built_in;
pub mod calibration;
#[cfg(feature = "robot")]
pub mod emulated;
pub mod family;
pub mod inspect;
pub mod load;
#[cfg(feature = "property")]
pub mod property;
#[cfg(feature = "recording")]
pub mod recording;
pub mod report;
pub mod request;
pub mod results;
pub mod run;
pub mod score;
pub mod stream;
pub mod study;
pub mod sweep;
pub mod trial;
pub mod tune;
