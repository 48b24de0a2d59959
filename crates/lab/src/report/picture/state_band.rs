//! The states of a run over time as a narrow band.

use svg::node::element::{Rectangle, Title};

use super::timeline::{fill, intervals, name};
use crate::report::shade::{define, shades};
use crate::report::style::{self, px};
use crate::run::Trace;

/// Width and height of the band (px).
const SIZE: (f64, f64) = (1000.0, 14.0);

/// A band with the states of a run: a self-contained SVG without texts. It can be stretched to any width.
pub(in crate::report) fn state_band(trace: &Trace) -> String {
    let all = shades(&trace.parents);
    let end = trace.ticks.last().map_or(0.0, |tick| tick.time).max(trace.period);
    let scale = SIZE.0 / end;
    let mut document = svg::Document::new()
        .set("viewBox", format!("0 0 {} {}", px(SIZE.0), px(SIZE.1)))
        .set("preserveAspectRatio", "none")
        .set("role", "img")
        .add(Title::new("states over time"));
    document = define(document, trace.ticks.iter().filter_map(|tick| all.get(tick.state?).copied()));
    for (state, ticks) in intervals(trace) {
        let ticks = &trace.ticks[ticks];
        let (Some(first), Some(last)) = (ticks.first(), ticks.last()) else { continue };
        let (from, to) = (scale * (first.time - trace.period).max(0.0), scale * last.time);
        let label = format!("{}, {:.1} to {:.1} s", name(trace, state), first.time, last.time);
        let part = Rectangle::new().set("x", px(from)).set("y", 0).set("width", px((to - from).max(1.0)));
        let part = part.set("height", px(SIZE.1)).set("fill", fill(&all, state));
        document = document.add(part.add(Title::new(style::printable(&label))));
    }
    document.to_string()
}
