//! When a machine leaves a state because it cannot go on in it.

use std::sync::Arc;

use super::action::NonFinite;
use super::tick::Failure;

/// That a machine left a state by its failsafe.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fallback {
    /// Index of the state in which it could not go on: the one that gave the command, or the innermost active one.
    pub left: usize,
    /// Why.
    pub cause: Cause,
}

/// Why a machine cannot go on in a state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Cause {
    /// A number of the state's command was not finite.
    #[error("its command was not finite: {0}")]
    NotFinite(NonFinite),
    /// The state wanted to be left when the tick had taken [`MICROSTEP_LIMIT`](super::CHAIN_LIMIT) transitions.
    #[error("it wanted more transitions than a tick takes")]
    MicrostepLimit,
}

impl Cause {
    /// The failure of a machine that has no failsafe for it in this state.
    pub(super) fn failure(self, state: &Arc<str>) -> Failure {
        let state = Arc::clone(state);
        match self {
            Self::NotFinite(non_finite) => Failure::NotFinite { state, non_finite },
            Self::MicrostepLimit => Failure::MicrostepLimit { state },
        }
    }
}
