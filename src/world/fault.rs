//! Ways in which a world stops being one.

/// Why a world can no longer be trusted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Fault {
    /// The simulation left the realm of numbers, or the engine warned of it and reset its state.
    #[error("the simulation diverged at {time:.3} s ({cause}); make `physics.step` smaller or the whisker less stiff")]
    Diverged {
        /// Simulated time (s).
        time: f64,
        /// What the engine said.
        cause: String,
    },
    /// Two bodies went too far into each other.
    #[error(
        "{body} sank {:.3} mm into the object at {time:.3} s, beyond the limit of {:.3} mm; \
         make `physics.step` or `physics.contact_time` smaller, or go slower", depth * 1e3, limit * 1e3
    )]
    Penetration {
        /// Simulated time (s).
        time: f64,
        /// What sank in.
        body: String,
        /// How deep (m).
        depth: f64,
        /// How deep is allowed (m).
        limit: f64,
    },
}
