//! Properties of policies: random cases, the simplest case that fails, and the cases that failed before.

mod case;
mod grid;
mod regressions;
mod search;

pub(crate) use case::Case;
pub(crate) use regressions::{Regressions, RegressionsError};
pub(crate) use search::{Drawn, Search, Shrunk, Verdict};
