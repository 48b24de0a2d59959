//! All figures of a run.

use super::{ErrorFigures, Estimate, Latency, RetrievalFigures, Spread, axis_error, coverage, hausdorff, tips};
use crate::run::Run;
use crate::scene::{Metric, Truth};

/// All figures of a run; lengths in metres, times in seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Score {
    /// How far the tip estimates are from what is there; `None` if no tip was recorded.
    pub error: Option<ErrorFigures>,
    /// The [share of the reference](coverage) that was traced, 0 to 1.
    pub coverage: f64,
    /// The symmetric [Hausdorff distance](hausdorff) between the estimated contour and the reference; `None` if no tip
    /// was recorded.
    pub hausdorff: Option<f64>,
    /// Retrievals; `None` if the policy made no marks.
    pub retrieval: Option<RetrievalFigures>,
    /// The [distance of the midpoints from a tunnel's axis](axis_error); `None` without a tunnel or midpoints.
    pub axis: Option<Spread>,
    /// Wall time of the control ticks; `None` if there was none.
    pub latency: Option<Latency>,
}

impl Score {
    /// The figures of `run` against what is true of its scene.
    #[must_use]
    pub fn new(run: &Run, truth: &Truth) -> Self {
        let estimate = Estimate::new(&run.trace);
        Self {
            error: ErrorFigures::of(&tips(&run.trace, &truth.surfaces)),
            coverage: coverage(&estimate, &truth.reference),
            hausdorff: hausdorff(&estimate, &truth.reference),
            retrieval: RetrievalFigures::new(&run.trace),
            axis: truth.axis.as_ref().and_then(|axis| axis_error(&run.trace, axis)),
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
