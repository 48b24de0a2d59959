//! Comparison of policies over the same runs.

mod changes;
mod comparison;
mod difference;
mod figure;

pub use changes::{Changes, OlderRuns, OlderRunsError};
pub use comparison::{Comparison, Incomplete, PolicyRuns};
pub use difference::{Difference, FigureComparison, Outlook};
pub use figure::{Figure, figures};
