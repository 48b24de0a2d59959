//! The picture of a run with the positions of its data.

use super::map::Map;
use crate::run::Trace;
use crate::score::Tip;
use vibrissa_world::geometry::Point2;

/// The picture of a run, and the positions on it.
pub(in crate::report) struct PlottedRun {
    /// The picture, a self-contained SVG.
    pub(in crate::report) svg: String,
    /// All tip estimates.
    pub(in crate::report) tips: Vec<PlottedTip>,
    /// The left and the right side of the strips (px). They are at the time 0 and at the end.
    pub(in crate::report) sides: (f64, f64),
    /// The upper and the lower side of the strips (px).
    pub(in crate::report) strips: (f64, f64),
    /// The end (s).
    pub(in crate::report) end: f64,
}

/// A tip estimate on a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::report) struct PlottedTip {
    /// Its position on the map (px). `None` if the map does not show it.
    pub(in crate::report) position: Option<(f64, f64)>,
    /// The estimated position (m, world frame).
    pub(in crate::report) tip_world: Point2,
    /// Its distance from the nearest surface (m).
    pub(in crate::report) error: f64,
    /// Its time (s).
    pub(in crate::report) time: f64,
    /// Index of the active state. `None` after a failure.
    pub(in crate::report) state: Option<usize>,
    /// Index of the whisker in the trace.
    pub(in crate::report) whisker: usize,
}

impl PlottedRun {
    /// The positions on the picture `svg`.
    pub(super) fn new(
        svg: String,
        trace: &Trace,
        tips: &[Tip],
        map: &Map,
        sides: (f64, f64),
        strips: (f64, f64),
    ) -> Self {
        let plotted = tips.iter().filter_map(|tip| {
            let tick = trace.ticks.get(tip.tick)?;
            Some(PlottedTip {
                position: Some(map.position(tip.tip_world)).filter(|position| map.shows(*position)),
                tip_world: tip.tip_world,
                error: tip.error,
                time: tick.time,
                state: tick.state,
                whisker: tip.whisker,
            })
        });
        let tips = plotted.collect();
        let end = trace.ticks.last().map_or(0.0, |tick| tick.time).max(trace.period);
        Self { svg, tips, sides, strips, end }
    }
}
