//! Messages of MuJoCo.

use std::sync::Once;

use mujoco_rs::logging::set_log_handler;
use mujoco_rs::wrappers::mj_logging::{MjLogMessage, MjtLogLevel};

use vibrissa_text::diagnostic::printable;

use super::library::{self, LibraryError};

/// Texts for MuJoCo's warning counters, in their order, with advice.
pub(super) const WARNINGS: [&str; 7] = [
    "an inertia matrix became singular; make parts of the rig heavier",
    "the contacts need more memory than reserved; reduce `links`",
    "the constraints need more memory than reserved; reduce `links`",
    "a position is too large or not a number; make `physics.step` smaller",
    "a velocity is too large or not a number; make `physics.step` smaller",
    "an acceleration is too large or not a number; make `physics.step` smaller or the shaft less stiff",
    "a command is too large or not a number",
];

/// The version of MuJoCo.
///
/// # Errors
/// [`LibraryError`] if the library cannot be used.
pub fn engine_version() -> Result<&'static str, LibraryError> {
    prepare_engine()?;
    Ok(mujoco_rs::mujoco_version())
}

/// Loads MuJoCo and disables its log file in the working directory.
///
/// # Errors
/// [`LibraryError`] if the library cannot be used.
pub(super) fn prepare_engine() -> Result<(), LibraryError> {
    static ROUTED: Once = Once::new();
    library::load()?;
    #[expect(
        unsafe_code,
        reason = "MuJoCo's log handler is global; nothing else in the process uses MuJoCo before this"
    )]
    // SAFETY: every use of MuJoCo in this crate comes after a call of this function, and `Once` admits one thread.
    ROUTED.call_once(|| unsafe { set_log_handler(on_engine_message) });
    Ok(())
}

/// Prints errors of the engine. MuJoCo ends the process after an error, so this is the last chance to report it.
/// Warnings are counted by the engine and become [`Fault`](vibrissa_world::world::Fault)s.
#[expect(clippy::print_stderr, reason = "MuJoCo ends the process right after an error")]
fn on_engine_message(message: &MjLogMessage) {
    if matches!(message.level(), MjtLogLevel::mjLOG_ERROR) {
        eprintln!("error: MuJoCo stopped: {}", printable(message.subject()));
        std::process::exit(3);
    }
}
