//! How well a run traced what is there: figures from what happened and the exact geometry.
//!
//! Lengths are metres, times seconds. Only tips whose coordinates are finite numbers count; the others are treated as not
//! recorded.

mod axis;
mod coverage;
mod error;
mod estimate;
mod hausdorff;
mod latency;
mod lipschitz;
mod retrieval;
#[expect(clippy::module_inception, reason = "one noun a file, and this one is the room's name")]
mod score;
mod statistics;
mod tip;

pub use axis::axis_error;
pub use coverage::{COVERAGE_RESOLUTION, COVERAGE_TOLERANCE, coverage, traced};
pub use error::ErrorFigures;
pub use estimate::{Estimate, LONGEST_BREAK, LONGEST_STEP};
pub use hausdorff::{HAUSDORFF_TOLERANCE, hausdorff};
pub use latency::Latency;
pub use retrieval::{MarkPlace, Retrieval, RetrievalFigures, Spread, mark_places, retrievals};
pub use score::Score;
pub use statistics::Statistics;
pub use tip::{Tip, tips};
