//! Ways in which a world stops being one.

/// Why a run in a world cannot go on.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Fault {
    /// The simulation left the realm of numbers or of its memory; the engine would reset its state and go on.
    #[error("the simulation diverged at {time:.3} s: {cause}")]
    Diverged {
        /// Simulated time (s).
        time: f64,
        /// What the engine said, and what to do.
        cause: &'static str,
    },
    /// The engine refused the model of what had come into reach.
    #[error("{cause}")]
    Model {
        /// What the engine said.
        cause: String,
    },
    /// A whisker went too far into the object.
    #[error(
        "a whisker sank {:.3} mm into the object at {time:.3} s, beyond the limit of {:.3} mm; make `physics.step` and \
         `physics.contact_time` smaller, as `physics: {{step: 0.5556 ms, contact_time: 1.25 ms}}`, or go slower", depth * 1e3, limit * 1e3
    )]
    Penetration {
        /// Simulated time (s).
        time: f64,
        /// How deep (m).
        depth: f64,
        /// How deep is allowed (m).
        limit: f64,
    },
    /// The platform was driven into the object: no fault of the simulation, but of what drives it.
    #[error(
        "the platform was driven {:.3} mm into the object at {time:.3} s; the policy does not keep clear of it", depth * 1e3
    )]
    Crash {
        /// Simulated time (s).
        time: f64,
        /// How deep (m).
        depth: f64,
    },
}
