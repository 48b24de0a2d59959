//! The command line as its users meet it: what goes where, and with which exit status.

mod argument;
mod calibrate;
mod check;
mod compile;
mod fmt;
mod graph;
#[cfg(target_os = "linux")]
mod interrupt;
mod program;
mod run;
mod stress;
#[cfg(feature = "sim")]
mod sweep;
mod test;
