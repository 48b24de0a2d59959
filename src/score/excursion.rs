//! When a whisker left its contour, and when it came back.

use crate::geometry::Point2;
use crate::run::Trace;
use vibrissa_runtime::machine::Mark;

use super::estimate::LONGEST_BREAK;
use super::tip::{valid_tips, whiskers};
use super::{body_path, mark_places};

/// A time without tips: from the last that a whisker recorded before it lost its contour to the first after it is back on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Excursion {
    /// Index of the whisker in the trace.
    pub whisker: usize,
    /// Where it left the contour (m, world frame): the last tip before.
    pub edge_world: Point2,
    /// Time (s).
    pub time: f64,
    /// Length of the path of the platform's centre of mass (m).
    pub path: f64,
}

/// The excursions of a run, in the order of time; one from which the whisker has not come back is none.
///
/// Every break in a whisker's tips of more than [`LONGEST_BREAK`] ticks is one. A policy that marks says more: one goes from the
/// tip before a `lost` to the first tip with or after the `found` that follows it. So what a policy does between finding and
/// following, such as whisking back, is part of it, as long as it does not record meanwhile. What overlaps is one excursion.
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

/// From which tick to which, of which whisker, from which edge point.
type Span = (usize, usize, usize, Point2);

/// Spans of one whisker, those that overlap as one.
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
        (tick - from > LONGEST_BREAK).then_some((from, tick, whisker, edge))
    };
    valid_tips(trace, whisker).filter_map(span).collect()
}

fn marked(trace: &Trace, whisker: usize) -> Vec<Span> {
    let (mut spans, mut lost) = (Vec::new(), None);
    for place in mark_places(trace).into_iter().filter(|place| place.whisker == whisker) {
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
