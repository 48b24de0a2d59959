//! What a chart's arrows lead to and leave from.

use svg::node::element::{Circle, Group, Rectangle};

use super::label::{ANY_STATE, FAILURE, arguments};
use super::layout::{Place, Size};
use crate::policy::chart::Chart;
use crate::report::style::{self, Anchor, px, text, width_of};

/// Size of the letters of a name and of what stands under it (px).
const NAME: f64 = 14.0;
const REMARK: f64 = 11.0;
/// Height of a box with a name only, and of a further line (px).
const HEIGHT: f64 = 34.0;
const LINE: f64 = 16.0;
/// Least width of a box and room beside its texts (px).
const LEAST_WIDTH: f64 = 96.0;
const BESIDE: f64 = 14.0;
/// Diameter of the mark where a run starts (px).
const START: f64 = 14.0;

/// A symbol of a statechart.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Symbol {
    /// Where a run starts.
    Start,
    /// The state with this index.
    State(usize),
    /// Every state.
    AnyState,
    /// The end in failure.
    Failure,
}

impl Symbol {
    /// Its size (px).
    pub(super) fn size(self, chart: &Chart) -> Size {
        if self == Self::Start {
            return (START, START);
        }
        let remarks = self.remarks(chart);
        let widths = remarks.iter().map(|remark| width_of(remark, REMARK)).chain([width_of(self.name(chart), NAME)]);
        let width = widths.fold(0.0, f64::max) + 2.0 * BESIDE;
        (width.max(LEAST_WIDTH), HEIGHT + LINE * remarks.len() as f64)
    }

    /// The symbol round `centre`, as wide as told.
    pub(super) fn draw(self, chart: &Chart, (x, y): Place, width: f64) -> Group {
        if self == Self::Start {
            let dot = Circle::new().set("cx", px(x)).set("cy", px(y)).set("r", px(0.5 * START));
            return Group::new().add(dot.set("fill", style::INK));
        }
        let height = self.size(chart).1;
        let frame = |inset: f64| {
            let (left, top) = (x - 0.5 * width + inset, y - 0.5 * height + inset);
            let frame = Rectangle::new().set("x", px(left)).set("y", px(top)).set("rx", px(8.0 - inset));
            let frame = frame.set("width", px(width - 2.0 * inset)).set("height", px(height - 2.0 * inset));
            frame.set("fill", "none").set("stroke", style::INK)
        };
        let mut group = Group::new();
        group = match self {
            Self::AnyState => group.add(frame(0.0).set("fill", "#ffffff").set("stroke-dasharray", "5 3")),
            // The final state of a statechart has two lines round it.
            Self::Failure => group.add(frame(0.0).set("fill", "#ffffff")).add(frame(3.5).set("fill", style::FAILURE)),
            Self::State(index) => group.add(frame(0.0).set("fill", style::STATES[index % style::STATES.len()])),
            Self::Start => group,
        };
        let remarks = self.remarks(chart);
        let mut y = y - 0.5 * LINE * remarks.len() as f64 + 5.0;
        let name = text(x, y, Anchor::Middle, NAME, style::INK, self.name(chart)).set("font-weight", 600);
        group = group.add(name);
        for remark in remarks {
            y += LINE;
            let remark = text(x, y, Anchor::Middle, REMARK, style::INK, &remark);
            group = group.add(remark.set("font-family", style::CODE_FONT));
        }
        group
    }

    fn name(self, chart: &Chart) -> &str {
        match self {
            Self::Start => "",
            Self::State(index) => &chart.states[index].name,
            Self::AnyState => ANY_STATE,
            Self::Failure => FAILURE,
        }
    }

    /// What stands under the name.
    fn remarks(self, chart: &Chart) -> Vec<String> {
        let Self::State(index) = self else { return Vec::new() };
        let state = &chart.states[index];
        let inside = state.parent.map(|parent| format!("in {}", chart.states[parent].name));
        let arguments = (!state.arguments.is_empty()).then(|| arguments(state));
        arguments.into_iter().chain(inside).collect()
    }
}
