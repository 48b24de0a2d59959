//! Scenes, and a simulator of whiskers in them.
//!
//! - [`scenario`] reads the YAML format into a [`scene::Scene`]: rig, solids, start, stop condition, expectations.
//! - [`geometry`] has exact contours, [`solid`] objects with their convex parts, `outline` readers of drawings.
//! - [`physics`] has the settings of a simulation, and [`mismatch`] the differences between the simulated and the assumed array.
//! - [`world`] has the trait [`world::World`] of simulators, and what is the same for all of them.
//! - [`quasi_static`] is the simulator without a library. The other one is the crate `vibrissa-mujoco`.
//!
//! # Where to begin
//!
//! An object with another outline is a reader in `scenario` that makes pieces of `solid`. A format of drawings is a file of `outline`.
//! A simulator implements [`world::World`], as `examples/write_world.rs` shows. Read `docs/decisions/whisker-model.md` before you
//! change the equations of [`quasi_static`], because perception has the same ones.

pub mod geometry;
pub mod mismatch;
pub mod outline;
pub mod quasi_static;
pub mod scenario;
pub mod scene;
pub mod solid;
pub mod world;

pub use vibrissa_declare::physics;
