//! All figures of a run.

use super::{
    Collisions, CornerFigures, ErrorFigures, Estimate, Latency, RetrievalFigures, Spread, StateShare, axis_error,
    body_path, coverage, hausdorff, state_shares, tips,
};
use crate::run::Run;
use crate::scene::{Metric, Truth};

/// All figures of a run; lengths in metres, times in seconds.
#[derive(Debug, Clone, PartialEq)]
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
    /// [Distance of the estimated midpoints from the tunnel's axis](axis_error); `None` without a tunnel.
    pub axis: Option<Spread>,
    /// Corners; `None` if the reference has no sharp one.
    pub corners: Option<CornerFigures>,
    /// What the time went into.
    pub states: Vec<StateShare>,
    /// Length of the path of the platform's centre of mass (m).
    pub path: f64,
    /// That length over the reference's.
    pub path_ratio: f64,
    /// What the platform's body ran into.
    pub collisions: Collisions,
    /// Wall time of the control ticks; `None` if there was none.
    pub latency: Option<Latency>,
}

impl Score {
    /// The figures of `run` against what is true of its scene.
    #[must_use]
    pub fn new(run: &Run, truth: &Truth) -> Self {
        let estimate = Estimate::new(&run.trace);
        let path = body_path(&run.trace.ticks);
        Self {
            error: ErrorFigures::of(&tips(&run.trace, &truth.surfaces)),
            coverage: coverage(&estimate, &truth.reference),
            hausdorff: hausdorff(&estimate, &truth.reference),
            retrieval: RetrievalFigures::new(&run.trace),
            axis: axis_error(&run.trace, &truth.axes),
            corners: CornerFigures::new(&run.trace, &truth.reference),
            states: state_shares(&run.trace),
            path,
            path_ratio: path / truth.reference.length(),
            collisions: Collisions::of(&run.trace),
            latency: Latency::of(&run.tick_times),
        }
    }

    /// The figures of corners if all were traced: one that was never found is worse than the worst of the others.
    fn all_corners(&self) -> Option<CornerFigures> {
        self.corners.filter(|corners| corners.traced == corners.count)
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
            Metric::RetrievalRadius => self.retrieval?.radius.map(|radius| radius.mean),
            Metric::AxisMean => self.axis.map(|axis| axis.mean),
            Metric::CornerPlaceMax => self.all_corners()?.place.map(|place| place.max),
            Metric::CornerTimeMax => self.all_corners()?.time.map(|time| time.max),
            Metric::CornerPathMax => self.all_corners()?.path.map(|path| path.max),
            Metric::Collisions => Some(self.collisions.count as f64),
        }
    }
}
