//! A trial: a policy in a scene and a world. It runs to a result with a score.
//!
//! Many trials run on several [threads](in_parallel), or in [worker processes](Worker) that may crash.

mod fault;
mod policy_test;
mod processor_time;
mod recording;
mod simulators;
mod threads;
#[expect(clippy::module_inception, reason = "one noun a file, and this one is the module's name")]
mod trial;
mod worker;
mod worlds;

pub use fault::TrialFault;
pub use policy_test::violations;
pub(crate) use processor_time::processor_time;
pub use recording::Recording;
pub use simulators::SimulatorError;
pub use threads::{Threads, stream_in_parallel};
pub use threads::{in_parallel, processors};
pub use trial::short_hash;
pub use trial::{Inputs, Trial, TrialResult};
pub use worker::{Answer, StartError, Worker, answer};
pub(crate) use worlds::build_world;
pub use worlds::check_world;
pub use worlds::simulator_version;
pub use worlds::{ExecuteError, engine_version};
pub use worlds::{model, pruning};
