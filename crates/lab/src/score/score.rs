//! All metrics of a run.

use super::coverage::{coverage_of, outline_shares, traced_outlines};
use super::reach::out_of_reach_of;
use super::{
    Collisions, CornerFigures, ErrorFigures, Estimate, InclinationFigures, Latency, MapFigures, Moments,
    OutOfPlaneFigures, Passage, Response, RetrievalFigures, StateShare, Tip, axis_error, body_path, hausdorff,
    object_coverage, responses, state_shares, tips,
};
use crate::run::Run;
use vibrissa_runtime::rig::Rig;
use vibrissa_world::scene::Truth;

/// All metrics of a run. Lengths are in metres, times in seconds.
#[derive(Debug, Clone, PartialEq)]
pub struct Score {
    /// Simulated time (s).
    pub time: f64,
    /// Errors of the tip estimates. `None` without recorded tips.
    pub error: Option<ErrorFigures>,
    /// The tip estimate with the largest error. `None` without recorded tips.
    pub largest_error: Option<Tip>,
    /// The [traced share of the reference](super::coverage), 0 to 1.
    pub coverage: f64,
    /// The traced share of the [object whose loop closed](object_coverage), 0 to 1.
    pub object_coverage: f64,
    /// The [traced share of each outline](super::traced) of the reference, 0 to 1.
    pub outline_coverages: Vec<f64>,
    /// The share of the reference (0 to 1) that was not traced and is certainly [out of reach](super::out_of_reach).
    pub out_of_reach: f64,
    /// The passage through a tunnel. `None` without one.
    pub passage: Option<Passage>,
    /// The symmetric [Hausdorff distance](hausdorff) between the estimated contour and the reference. `None` without
    /// recorded tips.
    pub hausdorff: Option<f64>,
    /// The map by touch. `None` if the policy uses none.
    pub map: Option<MapFigures>,
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
    /// Processor time of the control ticks. `None` without ticks.
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
        let traced = traced_outlines(&estimate, &truth.reference);
        let start = run.trace.ticks.first().map(|tick| tick.body);
        let outlines = outline_shares(&traced, &truth.reference);
        Self {
            time: run.trace.ticks.last().map_or(0.0, |tick| tick.time),
            error: ErrorFigures::of(&tips),
            largest_error: tips.iter().max_by(|a, b| a.error.total_cmp(&b.error)).copied(),
            coverage: coverage_of(&traced, &truth.reference),
            object_coverage: object_coverage(&outlines, last_tip, &truth.reference),
            outline_coverages: outlines,
            out_of_reach: out_of_reach_of(&traced, truth, rig, start) / truth.reference.length(),
            passage: Passage::of((&run.trace, &tips, &estimate), &truth.axes, &truth.reference, rig),
            hausdorff: hausdorff(&estimate, &truth.reference),
            map: run.map.as_ref().map(|map| MapFigures::new(&map.last, &truth.surfaces)),
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
}
