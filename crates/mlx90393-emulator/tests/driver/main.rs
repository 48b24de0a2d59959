//! The emulator with the driver, which shares no code with it, and with plain bytes.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod bring_up;
mod clocks;
mod commands;
mod common;
mod faults;
mod fields;
mod noise;
