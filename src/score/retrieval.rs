//! How far a whisker went to find what it had lost.

use crate::geometry::Point2;
use crate::run::{MarkRecord, Trace};
use vibrissa_runtime::machine::Mark;
use vibrissa_runtime::signal::MAX_WHISKERS;

use super::tip::is_finite;
use super::{Statistics, body_path};

/// One retrieval: from where a whisker lost the object to where it found it again (the thesis's section 5.2).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Retrieval {
    /// Index of the whisker in the trace.
    pub whisker: usize,
    /// The edge point (m, world frame): the last tip that was recorded before the whisker was marked `lost`.
    pub edge_world: Point2,
    /// The retrieved point (m, world frame): the tip when the whisker was marked `found`.
    pub retrieved_world: Point2,
    /// The thesis's retrieval radius (m): the distance between the two.
    pub radius: f64,
    /// The thesis's retrieval distance (m): the length of the path of the platform's centre of mass, tick by tick, from the
    /// edge point to the retrieved point.
    pub distance: f64,
    /// Time from the edge point to the retrieved point (s).
    pub time: f64,
}

/// Mean and sample standard deviation of a figure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// Mean.
    pub mean: f64,
    /// Sample standard deviation; a single value has none.
    pub std: Option<f64>,
}

/// The figures of all retrievals of a run, whiskers pooled; those of no retrieval are `None`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RetrievalFigures {
    /// How many there were.
    pub count: usize,
    /// Their radii (m).
    pub radius: Option<Spread>,
    /// Their distances (m).
    pub distance: Option<Spread>,
    /// Their times (s).
    pub time: Option<Spread>,
}

/// Where a mark belongs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MarkPlace {
    /// What was marked.
    pub mark: Mark,
    /// Index of the whisker in the trace.
    pub whisker: usize,
    /// Index of the tick in the trace: for `lost`, that of the edge point.
    pub tick: usize,
    /// The edge point or the retrieved point (m, world frame).
    pub point_world: Point2,
}

/// The places of a run's marks in the order in which they were made.
///
/// A whisker is marked `lost` when it has touched nothing for a while. Its place is then somewhere in the air, so that the mark
/// belongs to the last tip recorded before; or to where the tip was if none was recorded. A mark whose place is not a number
/// counts as not made.
#[must_use]
pub fn mark_places(trace: &Trace) -> Vec<MarkPlace> {
    // The last tip of every whisker in the ticks before the mark at hand, and its own.
    let mut last: [Option<(usize, Point2)>; MAX_WHISKERS] = [None; MAX_WHISKERS];
    let mut ticks = trace.ticks.iter().enumerate().peekable();
    let place = |&MarkRecord { mark, whisker, tick, tip_world }: &MarkRecord| {
        while let Some((index, record)) = ticks.next_if(|&(index, _)| index <= tick) {
            for (last, tip) in last.iter_mut().zip(record.tips) {
                *last = tip.filter(is_finite).map(|tip| (index, tip)).or(*last);
            }
        }
        let edge = last.get(whisker)?.filter(|_| mark == Mark::Lost);
        let (tick, point_world) = edge.unwrap_or((tick, tip_world));
        (is_finite(&point_world) && tick < trace.ticks.len()).then_some(MarkPlace { mark, whisker, tick, point_world })
    };
    trace.marks.iter().filter_map(place).collect()
}

/// The retrievals of a run in the order in which they ended: every `found` of a whisker with the first `lost` of it since the
/// `found` before. A `lost` that no `found` follows is none, nor is a `found` without a `lost`.
#[must_use]
pub fn retrievals(trace: &Trace) -> Vec<Retrieval> {
    let mut retrievals = Vec::new();
    let mut lost: Vec<MarkPlace> = Vec::new();
    for place in mark_places(trace) {
        let before = lost.iter().position(|edge| edge.whisker == place.whisker);
        match (place.mark, before) {
            (Mark::Lost, None) => lost.push(place),
            (Mark::Found, Some(before)) => retrievals.push(retrieval(trace, &lost.swap_remove(before), &place)),
            (Mark::Lost, Some(_)) | (Mark::Found, None) => {}
        }
    }
    retrievals
}

fn retrieval(trace: &Trace, edge: &MarkPlace, found: &MarkPlace) -> Retrieval {
    Retrieval {
        whisker: edge.whisker,
        edge_world: edge.point_world,
        retrieved_world: found.point_world,
        radius: (found.point_world - edge.point_world).norm(),
        distance: body_path(&trace.ticks[edge.tick..=found.tick]),
        time: trace.ticks[found.tick].time - trace.ticks[edge.tick].time,
    }
}

impl RetrievalFigures {
    /// The figures of a run; `None` if its policy made no marks.
    #[must_use]
    pub fn new(trace: &Trace) -> Option<Self> {
        let retrievals = retrievals(trace);
        let spread = |figure: fn(&Retrieval) -> f64| {
            let statistics = Statistics::of(retrievals.iter().map(figure).collect())?;
            Some(Spread { mean: statistics.mean(), std: statistics.std() })
        };
        (!trace.marks.is_empty()).then(|| Self {
            count: retrievals.len(),
            radius: spread(|retrieval| retrieval.radius),
            distance: spread(|retrieval| retrieval.distance),
            time: spread(|retrieval| retrieval.time),
        })
    }
}
