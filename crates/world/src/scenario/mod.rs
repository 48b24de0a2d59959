//! The YAML format of scenarios: from text to a validated [`Scene`].
//!
//! The parser returns a tree in which every node has its span. The readers traverse the tree and collect diagnostics
//! instead of stopping at the first. Checks of several values come last, and use all values that could be read.

mod calibration;
mod change;
mod corner;
mod drawn;
mod expect;
mod file;
mod mismatch;
mod object;
mod objects;
mod outline;
mod parameter;
mod path;
mod polar;
mod policy;
mod reader;
mod rig;
mod scene;
mod start;
mod stop;
#[cfg(test)]
mod tests;
mod texture;
mod timing;
mod tunnel;

pub use calibration::{write_calibration, write_robot_calibration};
pub use change::{Change, quoted, read as read_changed};
pub use drawn::{DrawnScenario, DrawnScene};
pub use file::reference;
pub use file::unreadable;
pub use mismatch::read_mismatch;
pub use parameter::{parameter, quantity};
pub use policy::unfit;
pub use rig::read_rig;
pub use scene::name;

pub use vibrissa_yaml::{CalibrationError, Files, fault, read_calibration};

use crate::scene::Scene;
use vibrissa_text::diagnostic::{Diagnostic, Source};

/// Reads a scenario that refers to no other file.
///
/// # Errors
/// All diagnostics up to [`FAULT_LIMIT`](vibrissa_text::diagnostic::FAULT_LIMIT), in the order of the text. There is at least
/// one, and all are errors. If the text is not YAML, that is the only one.
///
/// ```
/// use vibrissa_text::diagnostic::Source;
/// use vibrissa_world::scenario;
/// let text = "
/// name: disk
/// objects: [{circle: {centre: [40 cm, 40 cm], radius: 30 cm}}]
/// start: {position: [0 mm, 72 mm], heading: 90 deg}
/// stop: {time: 120 s}
/// ";
/// let scene = scenario::read(&Source::new("disk.yaml", text)).unwrap();
/// assert!((scene.truth.reference.length() - 0.6 * std::f64::consts::PI).abs() < 1e-12);
/// ```
pub fn read(source: &Source) -> Result<Scene, Vec<Diagnostic>> {
    read_with(source, &mut |_| Err("there are no files beside this text".to_owned()))
}

/// Reads a scenario, with the outlines from `files` to which it refers.
///
/// # Errors
/// As for [`read`].
pub fn read_with(source: &Source, files: &mut Files<'_>) -> Result<Scene, Vec<Diagnostic>> {
    scene::read(source, files)
}
