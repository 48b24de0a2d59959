//! Failures of a simulation.

use vibrissa_runtime::units::{Dimension, format_si};

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
        "a whisker penetrated the object by {:.3} mm at {time:.3} s, beyond the limit of {:.3} mm; {}", depth * 1e3, limit * 1e3,
        advice(*shorter_times)
    )]
    Penetration {
        /// Simulated time (s).
        time: f64,
        /// Penetration depth (m).
        depth: f64,
        /// Permitted penetration depth (m).
        limit: f64,
        /// A step and a contact time (s) that may help. `None` if there are none, or if both are short already.
        shorter_times: Option<[f64; 2]>,
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

/// What helps against a penetration.
fn advice(shorter_times: Option<[f64; 2]>) -> String {
    let cause = "the speed: a whisker that springs round a sharp corner is much faster than the platform";
    shorter_times.map_or_else(
        || format!("reduce {cause}"),
        |times| {
            let [step, contact_time] = times.map(|time| format_si(time, Dimension::TIME));
            format!(
                "make `physics.step` and `physics.contact_time` smaller, as `physics: {{step: {step}, contact_time: {contact_time}}}`, \
                 or reduce {cause}"
            )
        },
    )
}
