//! Videos of runs, and a window that shows a run while it is simulated.
//!
//! A [`Film`] watches a run. After the run, a [`Studio`] draws its frames and encodes them. So drawing changes neither
//! the results of a run nor its measured times.
//!
//! Why: docs/decisions/reports.md#videos-are-drawn-after-the-run-from-postures.

#[cfg(feature = "render")]
mod encoder;
#[cfg(feature = "render")]
mod error;
#[cfg(feature = "render")]
mod film;
#[cfg(feature = "render")]
mod gif;
#[cfg(feature = "render")]
mod mp4;
#[cfg(feature = "render")]
mod settings;
mod sketch;
#[cfg(feature = "render")]
mod studio;
mod trail;
#[cfg(feature = "viewer")]
mod window;

#[cfg(feature = "render")]
pub use error::VideoError;
#[cfg(feature = "render")]
pub use film::Film;
#[cfg(feature = "render")]
pub use settings::{Format, Settings};
#[cfg(feature = "render")]
pub use studio::Studio;
#[cfg(feature = "viewer")]
pub use window::RunWindow;
