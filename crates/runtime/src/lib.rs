//! The part of Vibrissa that runs on the robot.
//!
//! A [`control::Control`] takes the samples of one control period and returns the command for the next. Inside, [`percept`]
//! estimates contacts, [`machine`] evaluates the compiled policy, and [`motion`] converts its action to a command.
//!
//! This crate contains no compiler, no scenario reader and no simulator. *Where to begin* is at the end of this page.
//!
//! # The control loop
//!
//! `vibrissa compile policies/bang.fsm -o bang.machine` compiles a policy to an [`machine::Artifact`]. The robot loads the
//! bytes and executes one tick per control period:
//!
//! ```
//! use std::sync::Arc;
//! use vibrissa_runtime::control::Control;
//! use vibrissa_runtime::geometry::{Point2, Pose};
//! use vibrissa_runtime::machine::{Artifact, Status};
//! use vibrissa_runtime::rig::Rig;
//! use vibrissa_runtime::signal::{MAX_WHISKERS, Reading, Sample};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // Reading an artifact verifies it, so its program is safe to run.
//! let artifact = Artifact::from_bytes(include_bytes!("../fixtures/bang.machine"))?;
//! // The rig has the sizes, stiffnesses and sensors of the robot. The default is the reference rig.
//! let rig = Rig::default();
//! let mut control = Control::new(&rig, Arc::new(artifact.program))?;
//!
//! let period = rig.sensing.control_rate.recip();
//! for tick in 1..=30 {
//!     // On a robot, the sensors give the time, the pose of the body and the base angles.
//!     let body = Pose { position: Point2::origin(), heading: 0.0 };
//!     let mut whiskers = [Reading::default(); MAX_WHISKERS];
//!     whiskers[0].base_angle = if tick > 15 { -100e-6 } else { 0.0 };
//!     let sample = Sample { time: period * f64::from(tick), body, whiskers };
//!
//!     let (command, output) = control.tick(&[sample]);
//!     assert_eq!(output.status, Status::Running);
//!     assert!(command.velocity_world.norm() <= rig.platform.speed_limit);
//! }
//! // The policy explores until a whisker touches. Then it follows the surface.
//! assert_eq!(control.machine().state_name(), "Following");
//! # Ok(())
//! # }
//! ```
//!
//! A tick does a bounded amount of work and allocates no memory. [`control::Control::tick`] accepts missing and invalid
//! samples. The example `own_robot` is a complete loop.
//!
//! # Modules
//!
//! | purpose | modules |
//! |---|---|
//! | the control loop and its interface | [`control`], [`signal`] |
//! | description of the robot | [`rig`], [`calibration`] |
//! | compiled policies | [`machine`] |
//! | estimation of contacts | [`percept`], [`mechanics`] |
//! | what is free, touched and unknown | [`map`] |
//! | commands | [`motion`] |
//! | basics | [`geometry`], [`math`], [`units`] |
//!
//! Lengths are in metres, angles in radians, times in seconds and forces in newtons. Angles are positive
//! counter-clockwise. The pages `docs/rig.md` and `docs/glossary.md` of the repository define frames, signs and terms.
//!
//! # Where to begin
//!
//! A contact estimator is a file of `percept`, with the steps of `docs/howto/extend.md`. The closed forms of bent shafts are in
//! `mechanics`. Nothing of a tick may allocate, read a clock or depend on the target: tests count allocations and compare bits, so
//! functions such as sine come from `math`.

pub mod calibration;
pub mod control;
pub mod geometry;
mod kinds;
pub mod machine;
pub mod map;
pub mod math;
pub mod mechanics;
pub mod motion;
pub mod percept;
pub mod rig;
pub mod signal;
pub mod units;
