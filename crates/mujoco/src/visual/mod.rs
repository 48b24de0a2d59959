//! Drawings of a scene by MuJoCo's own renderer.
//!
//! The drawn model has the objects and the platform of the simulated one. Shafts are strokes of a fixed width in pixels,
//! because a wire is thinner than a pixel. So one drawing serves every simulator and every model of the shafts.

mod camera;
mod drawing;
mod egl;
mod model;
mod offscreen;
#[cfg(feature = "viewer")]
mod window;

pub use camera::Camera;
pub use drawing::{Drawing, Stroke};
pub use model::top;
pub use offscreen::{OffscreenRenderer, RenderError};
#[cfg(feature = "viewer")]
pub use window::{Shown, Window, WindowError};

#[cfg(feature = "viewer")]
use std::error::Error;

/// The message of an error and those of its causes. The messages of mujoco-rs alone do not say what happened.
#[cfg(feature = "viewer")]
fn whole_message(error: &dyn Error) -> String {
    std::iter::successors(error.source(), |cause| (*cause).source())
        .fold(error.to_string(), |message, cause| format!("{message}: {cause}"))
}
