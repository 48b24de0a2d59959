//! Retrievals of the contour.

use crate::run::{MarkRecord, Trace};
use vibrissa_runtime::machine::Mark;
use vibrissa_runtime::signal::MAX_WHISKERS;
use vibrissa_world::geometry::Point2;

use super::tip::is_finite;
use super::{Statistics, body_path};

/// One retrieval: from the point at which a whisker lost the object to the point at which it found it again (section
/// 5.2 of the baseline).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Retrieval {
    /// Index of the whisker in the trace.
    pub whisker: usize,
    /// The edge point (m, world frame), which is the last recorded tip before the mark `lost`.
    pub edge_world: Point2,
    /// The retrieved point (m, world frame), which is the tip at the mark `found`.
    pub retrieved_world: Point2,
    /// The baseline's retrieval radius (m): the distance between both points.
    pub radius: f64,
    /// The baseline's retrieval distance (m): the length of the path of the platform's centre of mass from the edge
    /// point to the retrieved point.
    pub distance: f64,
    /// Time from the edge point to the retrieved point (s).
    pub time: f64,
    /// Index of the tick of the edge point in the trace.
    pub edge_tick: usize,
    /// Index of the tick of the retrieved point.
    pub found_tick: usize,
}

/// Mean and sample standard deviation of a figure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moments {
    /// Mean.
    pub mean: f64,
    /// Sample standard deviation. `None` for a single value.
    pub std: Option<f64>,
}

/// The figures of all retrievals of a run, over all whiskers. They are `None` without retrievals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RetrievalFigures {
    /// The number of retrievals.
    pub count: usize,
    /// Retrieval radii (m).
    pub radius: Option<Moments>,
    /// Retrieval distances (m).
    pub distance: Option<Moments>,
    /// Retrieval times (s).
    pub time: Option<Moments>,
}

/// The position and time of a mark.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MarkPosition {
    /// The mark.
    pub mark: Mark,
    /// Index of the whisker in the trace.
    pub whisker: usize,
    /// Index of the tick in the trace. For `lost`, it is the tick of the edge point.
    pub tick: usize,
    /// The edge point or the retrieved point (m, world frame).
    pub point_world: Point2,
}

/// The positions of a run's marks, in the order of the marks.
///
/// A policy marks a whisker `lost` after some time without contact. The whisker is then no longer at the edge. The mark
/// therefore refers to the last recorded tip, or to the current tip if none was recorded. Marks whose position is not
/// finite are ignored.
#[must_use]
pub fn mark_positions(trace: &Trace) -> Vec<MarkPosition> {
    // The last tip of every whisker before the current tick, and its tick.
    let mut last: [Option<(usize, Point2)>; MAX_WHISKERS] = [None; MAX_WHISKERS];
    let mut ticks = trace.ticks.iter().enumerate().peekable();
    let place = |&MarkRecord { mark, whisker, tick, tip_world }: &MarkRecord| {
        while let Some((index, record)) = ticks.next_if(|&(index, _)| index <= tick) {
            for (last, whisker) in last.iter_mut().zip(&record.whiskers) {
                *last = whisker.tip.filter(is_finite).map(|tip| (index, tip)).or(*last);
            }
        }
        let edge = last.get(whisker)?.filter(|_| mark == Mark::Lost);
        let (tick, point_world) = edge.unwrap_or((tick, tip_world));
        (is_finite(&point_world) && tick < trace.ticks.len()).then_some(MarkPosition {
            mark,
            whisker,
            tick,
            point_world,
        })
    };
    trace.marks.iter().filter_map(place).collect()
}

/// The retrievals of a run in the order of their ends. Each consists of a `found` and the first `lost` of the same
/// whisker since its previous `found`. A `lost` without a later `found` is ignored, as is a `found` without a `lost`.
#[must_use]
pub fn retrievals(trace: &Trace) -> Vec<Retrieval> {
    let mut retrievals = Vec::new();
    let mut lost: Vec<MarkPosition> = Vec::new();
    for place in mark_positions(trace) {
        let before = lost.iter().position(|edge| edge.whisker == place.whisker);
        match (place.mark, before) {
            (Mark::Lost, None) => lost.push(place),
            (Mark::Found, Some(before)) => retrievals.push(retrieval(trace, &lost.swap_remove(before), &place)),
            (Mark::Lost, Some(_)) | (Mark::Found, None) => {}
        }
    }
    retrievals
}

fn retrieval(trace: &Trace, edge: &MarkPosition, found: &MarkPosition) -> Retrieval {
    Retrieval {
        whisker: edge.whisker,
        edge_world: edge.point_world,
        retrieved_world: found.point_world,
        radius: (found.point_world - edge.point_world).norm(),
        distance: body_path(&trace.ticks[edge.tick..=found.tick]),
        time: trace.ticks[found.tick].time - trace.ticks[edge.tick].time,
        edge_tick: edge.tick,
        found_tick: found.tick,
    }
}

impl RetrievalFigures {
    /// The figures of a run. `None` if its policy made no marks.
    #[must_use]
    pub fn new(trace: &Trace) -> Option<Self> {
        let retrievals = retrievals(trace);
        let moments = |figure: fn(&Retrieval) -> f64| {
            let statistics = Statistics::of(retrievals.iter().map(figure).collect())?;
            Some(Moments { mean: statistics.mean(), std: statistics.std() })
        };
        (!trace.marks.is_empty()).then(|| Self {
            count: retrievals.len(),
            radius: moments(|retrieval| retrieval.radius),
            distance: moments(|retrieval| retrieval.distance),
            time: moments(|retrieval| retrieval.time),
        })
    }
}
