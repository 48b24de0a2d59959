//! Requests for trials: a scenario, a policy and options, as files or as texts.
//!
//! The command `run` and the Python package make their trials here, so that the same request has the same result and the
//! same hashes.

mod error;
mod input;
mod trial_request;

pub use error::RequestError;
pub use input::{Input, PolicyInput};
pub use trial_request::{PreparedPolicy, PreparedTrial, TrialRequest, policy, rig, scene};
