//! All metrics of a run.

use super::{
    Collisions, CornerFigures, ErrorFigures, Estimate, InclinationFigures, Latency, Moments, OutOfPlaneFigures,
    Passage, Response, RetrievalFigures, StateShare, Tip, axis_error, body_path, coverage, hausdorff, object_coverage,
    out_of_reach, outline_coverages, responses, state_shares, tips,
};
use crate::run::Run;
use vibrissa_runtime::rig::Rig;
use vibrissa_world::scene::{Metric, Truth};

/// All metrics of a run. Lengths are in metres, times in seconds.
#[derive(Debug, Clone, PartialEq)]
pub struct Score {
    /// Errors of the tip estimates. `None` without recorded tips.
    pub error: Option<ErrorFigures>,
    /// The tip estimate with the largest error. `None` without recorded tips.
    pub largest_error: Option<Tip>,
    /// The [traced share of the reference](coverage), 0 to 1.
    pub coverage: f64,
    /// The traced share of the [object whose loop closed](object_coverage), 0 to 1.
    pub object_coverage: f64,
    /// The [traced share of each outline](outline_coverages) of the reference, 0 to 1.
    pub outline_coverages: Vec<f64>,
    /// The share of the reference (0 to 1) that was not traced and is certainly [out of reach](out_of_reach).
    pub out_of_reach: f64,
    /// The passage through a tunnel. `None` without one.
    pub passage: Option<Passage>,
    /// The symmetric [Hausdorff distance](hausdorff) between the estimated contour and the reference. `None` without
    /// recorded tips.
    pub hausdorff: Option<f64>,
    /// Retrievals. `None` if the policy made no marks.
    pub retrieval: Option<RetrievalFigures>,
    /// [Distance of the estimated midpoints from the tunnel's axis](axis_error). `None` without a tunnel.
    pub axis: Option<Moments>,
    /// Corners. `None` if the reference has no sharp corner.
    pub corners: Option<CornerFigures>,
    /// The time shares of the states.
    pub states: Vec<StateShare>,
    /// Length of the path of the platform's centre of mass (m).
    pub path: f64,
    /// The ratio of this length to the length of the reference.
    pub path_ratio: f64,
    /// Collisions of the platform's body.
    pub collisions: Collisions,
    /// The motion of tips out of the plane. `None` in a planar world.
    pub out_of_plane: Option<OutOfPlaneFigures>,
    /// The inclination of whiskers. `None` if no whisker recorded a contour.
    pub inclination: Option<InclinationFigures>,
    /// How perception followed the bends of whiskers.
    pub responses: Vec<Response>,
    /// Wall time of the control ticks. `None` without ticks.
    pub latency: Option<Latency>,
}

impl Score {
    /// Computes the metrics of a `run` of `rig` against the exact geometry of its scene.
    #[must_use]
    pub fn new(run: &Run, truth: &Truth, rig: &Rig) -> Self {
        let estimate = Estimate::new(&run.trace);
        let tips = tips(&run.trace, &truth.surfaces, rig);
        let last_tip = tips.iter().max_by_key(|tip| tip.tick).map(|tip| tip.tip_world);
        let path = body_path(&run.trace.ticks);
        let outlines = outline_coverages(&estimate, &truth.reference);
        Self {
            error: ErrorFigures::of(&tips),
            largest_error: tips.iter().max_by(|a, b| a.error.total_cmp(&b.error)).copied(),
            coverage: coverage(&estimate, &truth.reference),
            object_coverage: object_coverage(&outlines, last_tip, &truth.reference),
            outline_coverages: outlines,
            out_of_reach: out_of_reach(&estimate, truth, rig) / truth.reference.length(),
            passage: Passage::of((&run.trace, &tips, &estimate), &truth.axes, &truth.reference, rig),
            hausdorff: hausdorff(&estimate, &truth.reference),
            retrieval: RetrievalFigures::new(&run.trace),
            axis: axis_error(&run.trace, &truth.axes),
            corners: CornerFigures::new(&run.trace, &truth.reference),
            states: state_shares(&run.trace),
            path,
            path_ratio: path / truth.reference.length(),
            collisions: Collisions::of(&run.trace),
            out_of_plane: OutOfPlaneFigures::of(&run.trace),
            inclination: InclinationFigures::of(&run.trace, rig.sensing.friction),
            responses: responses(&run.trace, rig),
            latency: Latency::of(&run.tick_times),
        }
    }

    /// The traced share of the reference without the parts [out of reach](Self::out_of_reach), 0 to 1.
    #[must_use]
    pub fn coverage_in_reach(&self) -> f64 {
        (self.coverage / (1.0 - self.out_of_reach)).min(1.0)
    }

    /// The figures of corners, if all sharp corners were traced. Otherwise `None`, because a corner that was not found
    /// is worse than any other.
    fn all_corners(&self) -> Option<CornerFigures> {
        self.corners.filter(|corners| corners.traced == corners.count)
    }

    /// The value of a metric (SI units), for an expectation. `None` if the run has none.
    #[must_use]
    pub fn figure(&self, metric: Metric) -> Option<f64> {
        match metric {
            Metric::ErrorMean => self.error.map(|error| error.mean),
            Metric::ErrorP95 => self.error.map(|error| error.p95),
            Metric::ErrorMax => self.error.map(|error| error.max),
            Metric::Hausdorff => self.hausdorff,
            Metric::IntervalCoverage => self.error.map(|error| error.interval_coverage),
            Metric::Outliers => self.error.map(|error| error.outliers),
            Metric::Coverage => Some(self.coverage),
            Metric::ObjectCoverage => Some(self.object_coverage),
            Metric::Passage => self.passage.map(|passage| passage.share),
            Metric::WallCoverage => self.passage.map(|passage| passage.wall_coverage()),
            Metric::RetrievalRadius => self.retrieval?.radius.map(|radius| radius.mean),
            Metric::RetrievalDistance => self.retrieval?.distance.map(|distance| distance.mean),
            Metric::AxisMean => self.axis.map(|axis| axis.mean),
            Metric::CornerPlaceMax => self.all_corners()?.place.map(|place| place.max),
            Metric::CornerTimeMax => self.all_corners()?.time.map(|time| time.max),
            Metric::CornerPathMax => self.all_corners()?.path.map(|path| path.max),
            Metric::InclinationBeyond => self.inclination.as_ref().map(|inclination| inclination.beyond),
            Metric::OutOfPlaneMax => Some(self.out_of_plane?.distance),
            Metric::Slips => Some(self.out_of_plane?.slips as f64),
            Metric::Collisions => Some(self.collisions.count as f64),
        }
    }
}
