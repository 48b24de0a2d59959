//! The native part of the Python package `vibrissa`. `docs/python.md` describes the package.
//!
//! # Where to begin
//!
//! A function here converts arguments, calls the crate `lab` and converts its result. A class has its text for editors in
//! `python/vibrissa/_native.pyi`, which a test compares with the module.
#![allow(clippy::needless_pass_by_value, reason = "functions for Python own what they receive")]

mod arrays;
mod control;
mod episode;
mod error;
mod input;
mod machine;
mod map;
mod observation;
mod pickle;
mod raster;
mod result;
mod rig;
mod samples;
mod ticks;
mod traced_outline;
mod trial;

/// The module `vibrissa._native`.
#[pyo3::pymodule]
mod _native {
    #[pymodule_export]
    use super::control::{Command, Control};
    #[pymodule_export]
    use super::episode::Episode;
    #[pymodule_export]
    use super::error::Error;
    #[pymodule_export]
    use super::input::{Text, policies, scenarios};
    #[pymodule_export]
    use super::machine::{Machine, Parameter, compile};
    #[pymodule_export]
    use super::observation::Observation;
    #[pymodule_export]
    use super::result::Result;
    #[pymodule_export]
    use super::rig::{Rig, rigs};
    #[pymodule_export]
    use super::trial::{Trial, has_mujoco, use_mujoco};
}
