//! All figures of a run.

use super::{ErrorFigures, Estimate, Latency, RetrievalFigures, coverage, hausdorff, tips};
use crate::geometry::Contour;
use crate::run::Run;
use crate::scene::Metric;

/// All figures of a run; lengths in metres, times in seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Score {
    /// How far the tip estimates are from the reference contour; `None` if no tip was recorded.
    pub error: Option<ErrorFigures>,
    /// The [share of the reference contour](coverage) that was traced, 0 to 1.
    pub coverage: f64,
    /// The symmetric [Hausdorff distance](hausdorff) between the estimated and the reference contour; `None` if no tip
    /// was recorded.
    pub hausdorff: Option<f64>,
    /// Retrievals; `None` if the policy made no marks.
    pub retrieval: Option<RetrievalFigures>,
    /// Wall time of the control ticks; `None` if there was none.
    pub latency: Option<Latency>,
}

impl Score {
    /// The figures of `run` against the exact outline of its object, `reference`.
    #[must_use]
    pub fn new(run: &Run, reference: &Contour) -> Self {
        let estimate = Estimate::new(&run.trace);
        Self {
            error: ErrorFigures::of(&tips(&run.trace, reference)),
            coverage: coverage(&estimate, reference),
            hausdorff: hausdorff(&estimate, reference),
            retrieval: RetrievalFigures::new(&run.trace),
            latency: Latency::of(&run.tick_times),
        }
    }

    /// One figure (SI), for an expectation; `None` if the run has none.
    #[must_use]
    pub fn figure(&self, metric: Metric) -> Option<f64> {
        match metric {
            Metric::ErrorMean => self.error.map(|error| error.mean),
            Metric::ErrorP95 => self.error.map(|error| error.p95),
            Metric::ErrorMax => self.error.map(|error| error.max),
            Metric::Hausdorff => self.hausdorff,
            Metric::Coverage => Some(self.coverage),
        }
    }
}
