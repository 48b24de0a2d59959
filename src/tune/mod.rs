//! Tuning: parameters of a policy that minimise a cost over scenes.

mod axis;
mod candidate;
mod evolution;
mod line;
mod objective;
mod scenes;
mod summary;

pub(crate) use axis::{Axis, AxisError};
pub(crate) use candidate::Candidate;
pub use evolution::Evolution;
pub(crate) use line::{TunedRun, TuningHeader, TuningLine};
pub(crate) use objective::{Objective, Term};
pub(crate) use scenes::{CandidateError, TuningScene};
pub(crate) use summary::{TunedFigures, TunedParameter, TunedValues, Tuning};
