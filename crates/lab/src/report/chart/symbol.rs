//! Symbols of a statechart.

use svg::node::element::{Circle, Group, Rectangle};

use super::label::{ANY_STATE, FAILURE, SUCCESS, arguments, behaviour, hidden, signature};
use super::layout::{Position, Size};
use crate::report::shade::shades;
use crate::report::style::{self, Anchor, px, text, width_of};
use vibrissa_language::chart::Chart;

/// Size of the letters of a name and of what stands under it (px).
const NAME: f64 = 14.0;
const REMARK: f64 = 11.0;
/// Height of a box with a name only, and of a further line (px).
const HEIGHT: f64 = 34.0;
const LINE: f64 = 16.0;
/// Least width of a box, and space beside its texts (px).
const MIN_WIDTH: f64 = 96.0;
const BESIDE: f64 = 14.0;
/// Diameter of the start symbol (px).
const START: f64 = 14.0;

/// A symbol of a statechart.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Symbol {
    /// Start of a run, or of a state with inner states.
    Start(Option<usize>),
    /// The state with this index.
    State(usize),
    /// All states, or all states within a state.
    AnyState(Option<usize>),
    /// The state with this index, which one of its inner states leaves and enters again.
    Anew(usize),
    /// The end in failure.
    Failure,
    /// The end in success.
    Success,
    /// The exit of a behaviour with this index in [`Chart::ends`].
    Exit(usize),
}

impl Symbol {
    /// The state that contains it.
    pub(super) fn container(self, chart: &Chart) -> Option<usize> {
        match self {
            Self::Start(container) | Self::AnyState(container) => container,
            Self::Anew(state) => Some(state),
            Self::State(state) => chart.states[state].parent,
            Self::Failure | Self::Success | Self::Exit(_) => None,
        }
    }

    /// The size of its title, if it is a state with inner states (px).
    pub(super) fn title_size(self, chart: &Chart) -> Size {
        let contracts = self.contracts(chart);
        let widths = contracts.iter().map(|contract| width_of(contract, REMARK));
        (widths.fold(width_of(&self.title(chart), NAME), f64::max), LINE * (1 + contracts.len()) as f64)
    }

    /// The frame of a state with inner states, and its title.
    pub(super) fn draw_frame(self, chart: &Chart, (x, y): Position, (width, height): Size) -> Group {
        let (left, top) = (x - 0.5 * width, y - 0.5 * height);
        let frame = Rectangle::new().set("x", px(left)).set("y", px(top)).set("rx", 10);
        let frame = frame.set("width", px(width)).set("height", px(height));
        let frame = frame.set("fill", "#ffffff").set("stroke", style::INK);
        let mut y = top + BESIDE + 0.75 * LINE;
        let title = text(left + BESIDE, y, Anchor::Start, NAME, style::INK, &self.title(chart));
        let mut group = Group::new().add(frame).add(title.set("font-weight", 600));
        for contract in self.contracts(chart) {
            y += LINE;
            let contract = text(left + BESIDE, y, Anchor::Start, REMARK, style::INK, contract);
            group = group.add(contract.set("font-family", style::CODE_FONT));
        }
        group
    }

    /// The contracts in its box. An overview has no space for them.
    fn contracts(self, chart: &Chart) -> &[String] {
        match self {
            _ if chart.is_overview => &[],
            Self::State(index) => &chart.states[index].contracts,
            Self::AnyState(_) => &chart.contracts,
            _ => &[],
        }
    }

    fn title(self, chart: &Chart) -> String {
        match self {
            Self::State(index) => signature(&chart.states[index]),
            _ => self.name(chart).to_owned(),
        }
    }

    /// Its size without inner states (px).
    pub(super) fn size(self, chart: &Chart) -> Size {
        if matches!(self, Self::Start(_)) {
            return (START, START);
        }
        let remarks = self.remarks(chart);
        let widths = remarks.iter().map(|remark| width_of(remark, REMARK)).chain([width_of(self.name(chart), NAME)]);
        let width = widths.fold(0.0, f64::max) + 2.0 * BESIDE;
        (width.max(MIN_WIDTH), HEIGHT + LINE * remarks.len() as f64)
    }

    /// The symbol around `centre`, with this `width`.
    pub(super) fn draw(self, chart: &Chart, (x, y): Position, width: f64) -> Group {
        if matches!(self, Self::Start(_)) {
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
            Self::AnyState(_) | Self::Anew(_) => {
                group.add(frame(0.0).set("fill", "#ffffff").set("stroke-dasharray", "5 3"))
            }
            // The final state of a statechart has a double frame.
            Self::Success | Self::Exit(_) => group.add(frame(0.0).set("fill", "#ffffff")).add(frame(3.5)),
            Self::Failure => group.add(frame(0.0).set("fill", "#ffffff")).add(frame(3.5).set("fill", style::FAILURE)),
            Self::State(index) => {
                group.add(frame(0.0).set("fill", shades(&chart.parents)[chart.states[index].index].fill()))
            }
            Self::Start(_) => group,
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
            Self::Start(_) => "",
            Self::State(index) | Self::Anew(index) => &chart.states[index].name,
            Self::AnyState(_) => ANY_STATE,
            Self::Failure => FAILURE,
            Self::Success => SUCCESS,
            Self::Exit(index) => chart.ends().get(index).map_or("", |&(_, name)| name),
        }
    }

    /// The texts under the name.
    fn remarks(self, chart: &Chart) -> Vec<String> {
        match self {
            Self::State(index) => {
                let state = &chart.states[index];
                let arguments = (!state.arguments.is_empty() && !chart.is_overview).then(|| arguments(state));
                let contracts = self.contracts(chart).iter().cloned();
                arguments.into_iter().chain(behaviour(state)).chain(hidden(state)).chain(contracts).collect()
            }
            Self::AnyState(_) => self.contracts(chart).to_vec(),
            Self::Anew(_) => vec!["entered anew".to_owned()],
            Self::Exit(index) => {
                chart.ends().get(index).map(|(behaviour, _)| format!("exit of {behaviour}")).into_iter().collect()
            }
            _ => Vec::new(),
        }
    }
}
