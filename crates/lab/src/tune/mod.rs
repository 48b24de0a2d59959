//! Tuning: parameters of a policy that minimise a cost over scenes.

mod axis;
mod candidate;
mod evolution;
mod line;
mod objective;
mod scenes;
mod summary;

pub use axis::{Axis, AxisError};
pub use candidate::Candidate;
pub use evolution::Evolution;
pub use line::{TunedRun, TuningLine};
pub use objective::{Objective, Term};
pub use scenes::{CandidateError, TuningScene};
pub use summary::{TunedFigures, TunedParameter, TunedValues, Tuning};
