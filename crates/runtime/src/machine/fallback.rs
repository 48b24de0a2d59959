//! Fallback transitions that a machine has taken.

use std::sync::Arc;

use super::action::NonFinite;
use super::tick::Failure;

/// A fallback transition that was taken in a tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fallback {
    /// Index of the state that could not continue: the one that gave the action, or the innermost active one.
    pub left: usize,
    /// The cause of the transition.
    pub cause: Cause,
}

/// The cause of a fallback transition.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Cause {
    /// A number of the state's action was not finite.
    #[error("its command was not finite: {0}")]
    NotFinite(NonFinite),
    /// A transition was enabled after [`MICROSTEP_LIMIT`](super::MICROSTEP_LIMIT) transitions in one tick.
    #[error("it exceeded the microstep limit")]
    MicrostepLimit,
}

impl Cause {
    /// The failure of a machine without a fallback transition for `state`.
    pub(super) fn failure(self, state: &Arc<str>) -> Failure {
        let state = Arc::clone(state);
        match self {
            Self::NotFinite(non_finite) => Failure::NotFinite { state, non_finite },
            Self::MicrostepLimit => Failure::MicrostepLimit { state },
        }
    }
}
