//! The command line as its users meet it: what goes where, and with which exit status.

mod argument;
pub(crate) mod calibrate;
mod check;
mod compile;
mod contract;
#[cfg(unix)]
mod drive;
mod families;
#[cfg(unix)]
mod files;
mod fmt;
mod graph;
#[cfg(unix)]
mod inputs;
mod inspect;
#[cfg(target_os = "linux")]
mod interrupt;
#[cfg(all(target_os = "linux", feature = "sim"))]
mod library;
mod many_pieces;
mod mismatch;
#[cfg(target_os = "linux")]
mod names;
mod near_misses;
#[cfg(unix)]
mod printer;
pub(crate) mod program;
mod property;
mod provenance;
mod recording;
mod report;
mod run;
#[cfg(feature = "recording")]
mod run_recording;
mod scale;
pub(crate) mod schema;
mod services;
#[cfg(unix)]
mod stage;
mod stress;
#[cfg(feature = "sim")]
mod sweep;
mod test;
mod tune;
#[cfg(all(unix, feature = "render"))]
pub(crate) mod video;
#[cfg(feature = "viewer")]
mod view;
#[cfg(feature = "sim")]
mod watch;
