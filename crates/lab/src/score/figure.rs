//! The value of each declared figure.

use super::{CornerFigures, CornerStatistics, Moments, Score, TipDistance};
use vibrissa_declare::figures::Metric;

impl Score {
    /// The value of a figure (SI units, a truth as 1 or 0). `None` if the run does not have it.
    #[must_use]
    pub fn figure(&self, metric: Metric) -> Option<f64> {
        let error = self.error.as_ref();
        let passage = self.passage.as_ref();
        let retrieval = self.retrieval.as_ref();
        let corners = self.corners.as_ref();
        let inclination = self.inclination.as_ref();
        let along = |of: fn(&TipDistance) -> f64| error?.along.as_ref().map(of);
        let across = |of: fn(&TipDistance) -> f64| error?.across.as_ref().map(of);
        let corner = |of: fn(&CornerFigures) -> Option<CornerStatistics>| of(corners?);
        // A corner that was not traced is worse than any other.
        let worst = |of: fn(&CornerFigures) -> Option<CornerStatistics>| {
            of(corners.filter(|corners| corners.traced == corners.count)?).map(|worst| worst.max)
        };
        let mean = |moments: Option<Moments>| moments.map(|moments| moments.mean);
        let std = |moments: Option<Moments>| moments?.std;
        match metric {
            Metric::SimulatedTime => Some(self.time),
            Metric::ErrorMean => error.map(|error| error.mean),
            Metric::ErrorStd => error?.std,
            Metric::ErrorP95 => error.map(|error| error.p95),
            Metric::ErrorMax => error.map(|error| error.max),
            Metric::IntervalCoverage => error.map(|error| error.interval_coverage),
            Metric::Outliers => error.map(|error| error.outliers),
            Metric::Tips => Some(error.map_or(0.0, |error| error.count as f64)),
            Metric::AlongMean => along(|along| along.mean),
            Metric::AlongP95 => along(|along| along.p95),
            Metric::AlongMax => along(|along| along.max),
            Metric::AcrossMean => across(|across| across.mean),
            Metric::AcrossP95 => across(|across| across.p95),
            Metric::AcrossMax => across(|across| across.max),
            Metric::Bias => error?.bias,
            Metric::Scatter => error?.scatter,
            Metric::Coverage => Some(self.coverage),
            Metric::ObjectCoverage => Some(self.object_coverage),
            Metric::OutOfReach => Some(self.out_of_reach),
            Metric::CoverageInReach => Some(self.coverage_in_reach()),
            Metric::Passage => passage.map(|passage| passage.share),
            Metric::LeftCoverage => passage.map(|passage| passage.left_coverage),
            Metric::RightCoverage => passage.map(|passage| passage.right_coverage),
            Metric::ReachesBoth => passage.map(|passage| f64::from(u8::from(passage.reaches_both))),
            Metric::WallCoverage => passage.map(super::Passage::wall_coverage),
            Metric::Hausdorff => self.hausdorff,
            Metric::MapFreeArea => Some(self.map?.free),
            Metric::MapWrongFreeArea => Some(self.map?.wrong_free),
            Metric::MapUnknownArea => Some(self.map?.unknown),
            Metric::Retrievals => retrieval.map(|retrieval| retrieval.count as f64),
            Metric::RetrievalRadius => mean(retrieval?.radius),
            Metric::RetrievalRadiusStd => std(retrieval?.radius),
            Metric::RetrievalDistance => mean(retrieval?.distance),
            Metric::RetrievalDistanceStd => std(retrieval?.distance),
            Metric::RetrievalTime => mean(retrieval?.time),
            Metric::RetrievalTimeStd => std(retrieval?.time),
            Metric::AxisMean => mean(self.axis),
            Metric::AxisStd => std(self.axis),
            Metric::Corners => corners.map(|corners| corners.count as f64),
            Metric::CornersTraced => corners.map(|corners| corners.traced as f64),
            Metric::CornerPlace => corner(|corners| corners.place).map(|place| place.moments.mean),
            Metric::CornerPlaceStd => corner(|corners| corners.place)?.moments.std,
            Metric::CornerPlaceTracedMax => corner(|corners| corners.place).map(|place| place.max),
            Metric::CornerAngle => corner(|corners| corners.turn).map(|turn| turn.moments.mean),
            Metric::CornerAngleStd => corner(|corners| corners.turn)?.moments.std,
            Metric::CornerAngleMax => corner(|corners| corners.turn).map(|turn| turn.max),
            Metric::CornerEdge => corner(|corners| corners.edge).map(|edge| edge.moments.mean),
            Metric::CornerEdgeStd => corner(|corners| corners.edge)?.moments.std,
            Metric::CornerEdgeMax => corner(|corners| corners.edge).map(|edge| edge.max),
            Metric::CornerTime => corner(|corners| corners.time).map(|time| time.moments.mean),
            Metric::CornerTimeStd => corner(|corners| corners.time)?.moments.std,
            Metric::CornerTimeTracedMax => corner(|corners| corners.time).map(|time| time.max),
            Metric::CornerPath => corner(|corners| corners.path).map(|path| path.moments.mean),
            Metric::CornerPathStd => corner(|corners| corners.path)?.moments.std,
            Metric::CornerPathTracedMax => corner(|corners| corners.path).map(|path| path.max),
            Metric::CornerPlaceMax => worst(|corners| corners.place),
            Metric::CornerTimeMax => worst(|corners| corners.time),
            Metric::CornerPathMax => worst(|corners| corners.path),
            Metric::Path => Some(self.path),
            Metric::PathRatio => Some(self.path_ratio),
            Metric::Collisions => Some(self.collisions.count as f64),
            Metric::CollisionTime => Some(self.collisions.time),
            Metric::OutOfPlaneMax => Some(self.out_of_plane?.distance),
            Metric::Slips => Some(self.out_of_plane?.slips as f64),
            Metric::InclinationMax => inclination.map(|inclination| inclination.largest.inclination),
            Metric::InclinationMargin => inclination.map(|inclination| inclination.margin),
            Metric::InclinationBeyond => inclination.map(|inclination| inclination.beyond),
            Metric::TickMean => self.latency.map(|latency| latency.mean),
            Metric::TickP99 => self.latency.map(|latency| latency.p99),
            Metric::TickMax => self.latency.map(|latency| latency.max),
        }
    }
}
