//! A trial: a policy in a scene and a world. It runs to a result with a score.
//!
//! Many trials run on several [threads](in_parallel), or in [worker processes](Worker) that may crash.

mod policy_test;
mod processor_time;
mod recording;
mod threads;
mod trial;
mod worker;
mod worlds;

pub use policy_test::violations;
pub(crate) use processor_time::processor_time;
pub use recording::Recording;
pub use threads::{Threads, in_parallel, processors, stream_in_parallel};
pub use trial::{Inputs, Trial, TrialResult, short_hash};
pub use worker::{Answer, StartError, Worker, answer};
pub(crate) use worlds::build_world;
pub use worlds::{ExecuteError, check_world, engine_hash, engine_version};
