//! Drives a whisker array on a robot by a compiled policy.
//!
//! # The loop
//!
//! | thread | work | rate |
//! |---|---|---|
//! | acquisition, one per bus | reads every board once: [`array::Acquisition`] | 300 Hz |
//! | control | assembles samples and executes the machine: [`drive::ControlTask`] | 30 Hz |
//! | supervision | looks for faults, limits and sends commands: [`drive::Supervisor`] | 100 Hz |
//!
//! The threads share [`vitals::Vitals`], which are atomic, and queues without locks. None of them allocates memory or waits
//! for another one. So the supervisor stops the robot within 100 ms, whichever part fails. Another thread, with ordinary
//! priority, passes the records of the loop to every [`drive::RecordSink`].
//!
//! Each task is a step function of the time. On a robot, the threads of `program` call it. In the `emulation`, a scheduler
//! calls it in emulated time, with emulated sensors on emulated buses.
//!
//! # Where to begin
//!
//! A fault that a robot should detect begins as a kind of `emulation`, which the fault campaign then injects. Its detection belongs to
//! `drive`, its name to `fault.rs`. Timeouts, limits and responses to faults have their defaults in `config/safety.rs`. Read `docs/decisions/robot.md` before you change what stops the robot.

pub mod admission;
pub mod array;
pub mod config;
pub mod drive;
#[cfg(feature = "emulation")]
pub mod emulation;
pub mod fault;
#[cfg(any(feature = "recording", feature = "store"))]
mod hex;
pub mod histogram;
pub mod link;
#[cfg(feature = "mqtt")]
pub mod mqtt;
#[cfg(feature = "program")]
pub mod program;
#[cfg(feature = "recording")]
pub mod recording;
pub mod sensor;
#[cfg(all(feature = "mqtt", feature = "recording"))]
pub mod services;
#[cfg(feature = "store")]
pub mod store;
pub mod telemetry;
pub mod vitals;
