//! The metrics of a run, from its trace and the exact geometry.
//!
//! Lengths are in metres, times in seconds. Tips with coordinates that are not finite are ignored.

mod axis;
mod body_path;
mod collision;
mod corner;
mod coverage;
mod coverage_tracker;
mod enclosure;
mod error;
mod estimate;
mod excursion;
mod figure;
mod hausdorff;
mod inclination;
mod isolated;
mod latency;
mod lipschitz;
mod map_figures;
mod out_of_plane;
mod outlines;
mod passage;
mod reach;
mod response;
mod retrieval;
#[expect(clippy::module_inception, reason = "one noun a file, and this one is the module's name")]
mod score;
mod state_share;
mod statistics;
mod tip;

pub use axis::{Midpoint, axis_error, midpoints};
pub use body_path::body_path;
pub use collision::{Collisions, FirstContact};
pub use corner::{CornerFigures, CornerStatistics, SHARP, SIDE, TracedCorner, traced_corners};
pub use coverage::{COVERAGE_RESOLUTION, COVERAGE_TOLERANCE, coverage, object_coverage, outline_coverages, traced};
pub use coverage_tracker::CoverageTracker;
pub use error::{ErrorFigures, TipDistance};
pub use estimate::{Estimate, MAX_BREAK, MAX_STEP};
pub use excursion::{Excursion, excursions};
pub use hausdorff::{HAUSDORFF_TOLERANCE, hausdorff};
pub use inclination::{InclinationFigures, Inclined};
pub use latency::Latency;
pub use map_figures::{MapFigures, WRONG_DEPTH};
pub use out_of_plane::{OutOfPlaneFigures, Slip};
pub use passage::Passage;
pub use reach::out_of_reach;
pub use response::{BENT, BENT_TIME, LEAST_RESPONSE, Response, responses};
pub use retrieval::{MarkPosition, Moments, Retrieval, RetrievalFigures, mark_positions, retrievals};
pub use score::Score;
pub use state_share::{StateShare, state_shares};
pub use statistics::Statistics;
pub use tip::{OUTLIER_DEVIATIONS, OUTLIER_ERROR, Tip, TipOffset, tips};
