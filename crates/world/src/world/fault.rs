//! Failures of a simulation.

/// The reason why a run cannot continue.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Fault {
    /// The state is not finite, or the memory is exhausted. The engine would reset its state and continue.
    #[error("the simulation diverged at {time:.3} s: {cause}")]
    Diverged {
        /// Simulated time (s).
        time: f64,
        /// The message of the engine, with advice.
        cause: &'static str,
    },
    /// The engine rejected the model for the current surroundings.
    #[error("{cause}")]
    Model {
        /// The message of the engine.
        cause: String,
    },
    /// A whisker penetrates an object too deeply.
    #[error(
        "a whisker penetrated the object by {:.3} mm at {time:.3} s, beyond the limit of {:.3} mm; make `physics.step` and \
         `physics.contact_time` smaller, as `physics: {{step: 0.5556 ms, contact_time: 1.25 ms}}`, or reduce the speed", depth * 1e3, limit * 1e3
    )]
    Penetration {
        /// Simulated time (s).
        time: f64,
        /// Penetration depth (m).
        depth: f64,
        /// Permitted penetration depth (m).
        limit: f64,
    },
    /// The platform was driven into an object, or the base of a whisker through one. The cause is the policy, not the
    /// simulation.
    #[error(
        "the platform penetrated the object by {:.3} mm at {time:.3} s; make the policy keep a distance from it", depth * 1e3
    )]
    Crash {
        /// Simulated time (s).
        time: f64,
        /// Penetration depth (m).
        depth: f64,
    },
}
