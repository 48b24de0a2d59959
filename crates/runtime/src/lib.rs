//! The part of Vibrissa that runs on the robot.
//!
//! A [`control::Control`] takes the samples of one control period and returns the command for the next. Inside, [`percept`]
//! estimates contacts, [`machine`] evaluates the compiled policy, and [`motion`] converts its action to a command.
//!
//! This crate contains no compiler, no scenario reader and no simulator. They are in the crate `vibrissa`.

pub mod calibration;
pub mod control;
pub mod geometry;
pub mod machine;
pub mod mechanics;
pub mod motion;
pub mod percept;
pub mod rig;
pub mod signal;
pub mod units;
