//! Excursions: times between loss and recovery of the contour.

use crate::run::Trace;
use vibrissa_runtime::machine::Mark;
use vibrissa_world::geometry::Point2;

use super::estimate::MAX_BREAK;
use super::tip::{valid_tips, whiskers};
use super::{body_path, mark_positions};

/// An interval without contact: from the last tip of a whisker before it lost the contour to the first tip after it
/// found the contour again.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Excursion {
    /// Index of the whisker in the trace.
    pub whisker: usize,
    /// The edge point (m, world frame), which is the last tip before the loss.
    pub edge_world: Point2,
    /// Duration (s).
    pub time: f64,
    /// Length of the path of the platform's centre of mass (m).
    pub path: f64,
}

/// The excursions of a run, ordered by time. Without recovery of the contour there is no excursion.
///
/// Every break of more than [`MAX_BREAK`] ticks in a whisker's tips is an excursion. The marks of a policy extend
/// it: from the tip before `lost` to the first tip at or after the following `found`. It therefore includes manoeuvres
/// between detection and following, as long as no tip is recorded. Overlapping excursions are merged.
#[must_use]
pub fn excursions(trace: &Trace) -> Vec<Excursion> {
    let of_whisker = |whisker| joined([breaks(trace, whisker), marked(trace, whisker)].concat());
    let mut excursions: Vec<_> = whiskers(trace).flat_map(of_whisker).collect();
    excursions.sort_by_key(|&(from, ..)| from);
    let excursion = |(from, to, whisker, edge_world): (usize, usize, usize, Point2)| Excursion {
        whisker,
        edge_world,
        time: trace.ticks[to].time - trace.ticks[from].time,
        path: body_path(&trace.ticks[from..=to]),
    };
    excursions.into_iter().map(excursion).collect()
}

/// First tick, last tick, whisker, edge point.
type Span = (usize, usize, usize, Point2);

/// Merges overlapping spans of one whisker.
fn joined(mut spans: Vec<Span>) -> Vec<Span> {
    spans.sort_by_key(|&(from, to, ..)| (from, to));
    let mut joined: Vec<Span> = Vec::with_capacity(spans.len());
    for span in spans {
        match joined.last_mut() {
            Some(last) if span.0 < last.1 => last.1 = last.1.max(span.1),
            _ => joined.push(span),
        }
    }
    joined
}

fn breaks(trace: &Trace, whisker: usize) -> Vec<Span> {
    let mut before: Option<(usize, Point2)> = None;
    let span = |(tick, tip)| {
        let (from, edge) = before.replace((tick, tip))?;
        (tick - from > MAX_BREAK).then_some((from, tick, whisker, edge))
    };
    valid_tips(trace, whisker).filter_map(span).collect()
}

fn marked(trace: &Trace, whisker: usize) -> Vec<Span> {
    let (mut spans, mut lost) = (Vec::new(), None);
    for place in mark_positions(trace).into_iter().filter(|place| place.whisker == whisker) {
        match (place.mark, lost) {
            (Mark::Lost, None) => lost = Some(place),
            (Mark::Found, Some(edge)) => {
                lost = None;
                let back = valid_tips(trace, whisker).find(|&(tick, _)| tick >= place.tick.max(edge.tick + 1));
                spans.extend(back.map(|(tick, _)| (edge.tick, tick, whisker, edge.point_world)));
            }
            (Mark::Lost, Some(_)) | (Mark::Found, None) => {}
        }
    }
    spans
}
