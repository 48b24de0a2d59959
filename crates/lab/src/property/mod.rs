//! Properties of policies: random cases, the simplest case that fails, and the cases that failed before.

mod case;
mod grid;
mod regressions;
mod search;

pub use case::Case;
pub use regressions::{Regressions, RegressionsError};
pub use search::{Drawn, Search, Shrunk, Verdict};
