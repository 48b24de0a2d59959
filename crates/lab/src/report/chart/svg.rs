//! The chart as a picture.

use svg::node::element::{Group, Path};

use super::caption::Caption;
use super::label::Label;
use super::layout::Position;
use super::nest::{Span, arrange};
use super::symbol::Symbol;
use crate::report::outline::Outline;
use crate::report::shade::{define, shades};
use crate::report::style::{self, Anchor, px, text, width_of};
use vibrissa_language::chart::{Chart, Origin, Target, Transition};

/// The most states and the most transitions that a picture shows.
const LIMITS: (usize, usize) = (100, 400);
/// Margins of the chart, and the height of the title (px).
const MARGIN: f64 = 24.0;
const HEAD: f64 = 84.0;
/// Size of the title's letters and of the remark's under it (px).
const TITLE: f64 = 22.0;
const REMARK: f64 = 13.0;
/// Horizontal extent of a transition from a state to itself, and half of its height (px).
const LOOP: (f64, f64) = (26.0, 8.0);
/// Length and half the width of an arrow's head (px).
const ARROWHEAD: (f64, f64) = (8.0, 4.0);

/// The error of a chart that is too large for a picture.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "{states} states and {transitions} transitions are too many for a picture, which shows {} and {} at most; \
     show less of it by --depth or --state, or choose the format dot or mermaid",
    LIMITS.0,
    LIMITS.1
)]
pub struct ChartTooLarge {
    /// Number of states of the chart.
    pub states: usize,
    /// Number of its transitions.
    pub transitions: usize,
}

/// The chart as a self-contained SVG.
///
/// Transitions with the same ends share an arrow. States have the colours that they have in the picture of a run.
///
/// # Errors
/// [`ChartTooLarge`] if the picture would not be readable.
pub fn chart_svg(chart: &Chart) -> Result<String, ChartTooLarge> {
    let (states, transitions) = (chart.states.len(), chart.transitions.len());
    if states > LIMITS.0 || transitions > LIMITS.1 {
        return Err(ChartTooLarge { states, transitions });
    }
    let symbols = symbols(chart);
    let links = links(chart, &symbols);
    let (loops, links): (Vec<_>, Vec<_>) = links.into_iter().partition(|link| link.from == link.to);
    let beside = |index: usize| {
        let beside = loops.iter().find(|link| link.from == index).map(|link| link.caption.size());
        beside.map_or((0.0, 0.0), |(width, height)| (LOOP.0 + width, height))
    };
    let beside: Vec<_> = (0..symbols.len()).map(beside).collect();
    let spans = links.iter().map(|link| Span { from: link.from, to: link.to, label: link.caption.size() });
    let layout = arrange(chart, &symbols, &beside, &spans.collect::<Vec<_>>());

    let remark = remark(chart);
    let least = width_of(&chart.machine, TITLE).max(width_of(remark, REMARK));
    let (width, height) = (layout.size.0.max(least) + 2.0 * MARGIN, layout.size.1 + HEAD + MARGIN);
    let mut drawing = Group::new();
    drawing = drawing.set("transform", format!("translate({} {})", px(0.5 * (width - layout.size.0)), px(HEAD)));
    // A frame is behind its inside.
    let holds_others =
        |symbol: Symbol| matches!(symbol, Symbol::State(state) if chart.inside(Some(state)).next().is_some());
    for (symbol, &(centre, size)) in symbols.iter().zip(&layout.symbols).filter(|(symbol, _)| holds_others(**symbol)) {
        drawing = drawing.add(symbol.draw_frame(chart, centre, size));
    }
    for route in &layout.routes {
        drawing = drawing.add(line(curve(&route.points)));
        // The last points may coincide where an arrow ends at a box.
        if let Some(&tip) = route.points.last()
            && let Some(before) = route.points.iter().rev().find(|point| (tip.1 - point.1).abs() > 0.5)
        {
            drawing = drawing.add(arrowhead(tip, (0.0, (tip.1 - before.1).signum())));
        }
    }
    for (link, route) in links.iter().zip(&layout.routes) {
        drawing = drawing.add(link.caption.draw(route.label));
    }
    for link in &loops {
        let ((x, y), (width, _)) = layout.symbols[link.from];
        let (right, out) = (x + 0.5 * width, x + 0.5 * width + LOOP.0);
        let mut bow = Outline::default();
        bow.move_to((right, y - LOOP.1));
        bow.curve_to((out, y - 1.5 * LOOP.1), (out, y + 1.5 * LOOP.1), (right, y + LOOP.1));
        drawing = drawing.add(line(bow)).add(arrowhead((right, y + LOOP.1), (-1.0, 0.0)));
        drawing = drawing.add(link.caption.draw((out + 0.5 * link.caption.size().0, y)));
    }
    for (symbol, &(centre, size)) in symbols.iter().zip(&layout.symbols).filter(|(symbol, _)| !holds_others(**symbol)) {
        drawing = drawing.add(symbol.draw(chart, centre, size.0));
    }
    let shades = shades(&chart.parents);
    let document = style::sheet((width, height), &format!("statechart of {}", chart.machine));
    let document = define(document, chart.states.iter().map(|state| shades[state.index]))
        .add(text(MARGIN, 40.0, Anchor::Start, TITLE, style::INK, &chart.machine).set("font-weight", 600))
        .add(text(MARGIN, 62.0, Anchor::Start, REMARK, style::GREY, remark))
        .add(drawing);
    Ok(document.to_string())
}

/// A remark about omitted parts, or about the numbers, if there are any.
fn remark(chart: &Chart) -> &'static str {
    if chart.is_overview {
        return "inner states and details of transitions are left out; --state NAME shows those of one state";
    }
    let is_numbered = chart.transitions.iter().any(|transition| transition.number.is_some());
    if is_numbered { "numbers: the order in which transitions of one state are tried" } else { "" }
}

/// The symbols of a chart, in the order of the layout.
fn symbols(chart: &Chart) -> Vec<Symbol> {
    let has_start = chart.states.iter().any(|state| state.initial && state.parent.is_none());
    let mut symbols: Vec<Symbol> = has_start.then_some(Symbol::Start(None)).into_iter().collect();
    let starts = chart.states.iter().filter(|state| state.initial && state.parent.is_some());
    symbols.extend(starts.map(|state| Symbol::Start(state.parent)));
    symbols.extend((0..chart.states.len()).map(Symbol::State));
    symbols.extend(chart.has_any_state().then_some(Symbol::AnyState(None)));
    for (from, to) in chart.transitions.iter().map(|transition| ends(chart, transition)) {
        for symbol in [from, to] {
            if matches!(symbol, Symbol::AnyState(Some(_)) | Symbol::Anew(_)) && !symbols.contains(&symbol) {
                symbols.push(symbol);
            }
        }
    }
    symbols.extend((0..chart.ends().len()).map(Symbol::Exit));
    symbols.extend(chart.has_success().then_some(Symbol::Success));
    symbols.extend(chart.has_failure().then_some(Symbol::Failure));
    symbols
}

/// The symbols at both ends of a transition. Transitions between a state and its inner states are drawn inside the
/// state.
fn ends(chart: &Chart, transition: &Transition) -> (Symbol, Symbol) {
    let from = match transition.origin {
        Origin::AnyState => Symbol::AnyState(None),
        Origin::State(from) => Symbol::State(from),
    };
    match (transition.origin, &transition.target) {
        (_, Target::Success(_)) => (from, Symbol::Success),
        (_, Target::Failure(_)) => (from, Symbol::Failure),
        (_, Target::Exit { behaviour, name, .. }) => {
            let exit = chart.ends().iter().position(|end| *end == (behaviour, name));
            (from, Symbol::Exit(exit.unwrap_or_default()))
        }
        (Origin::AnyState, Target::State { state, .. }) => (Symbol::AnyState(None), Symbol::State(*state)),
        (Origin::State(from), &Target::State { state, .. }) => {
            let leads_in = from != state && chart.contains(from, state);
            let leads_out = from != state && chart.contains(state, from);
            let origin = if leads_in { Symbol::AnyState(Some(from)) } else { Symbol::State(from) };
            (origin, if leads_out { Symbol::Anew(state) } else { Symbol::State(state) })
        }
    }
}

/// All transitions between two symbols, or the arrow to an initial state.
struct Link {
    from: usize,
    to: usize,
    caption: Caption,
}

fn links(chart: &Chart, symbols: &[Symbol]) -> Vec<Link> {
    let mut bundles: Vec<(Symbol, Symbol, Vec<Label>)> = Vec::new();
    for (index, state) in chart.states.iter().enumerate().filter(|(_, state)| state.initial) {
        let label = Some(Label::of_initial(chart, index)).filter(|label| !label.is_empty());
        bundles.push((Symbol::Start(state.parent), Symbol::State(index), label.into_iter().collect()));
    }
    for (index, transition) in chart.transitions.iter().enumerate() {
        let (from, to) = ends(chart, transition);
        let label = Label::new(chart, index);
        let same_ends = |bundle: &&mut (Symbol, Symbol, Vec<Label>)| bundle.0 == from && bundle.1 == to;
        match bundles.iter_mut().find(same_ends) {
            Some(bundle) => bundle.2.push(label),
            None => bundles.push((from, to, vec![label])),
        }
    }
    let caption = if chart.is_overview { Caption::brief } else { Caption::new };
    let position = |symbol: Symbol| symbols.iter().position(|other| *other == symbol);
    let link = |(from, to, labels): (Symbol, Symbol, Vec<Label>)| {
        let colour = if to == Symbol::Failure { style::ALARM } else { style::GREY };
        Some(Link { from: position(from)?, to: position(to)?, caption: caption(&labels, colour) })
    };
    bundles.into_iter().filter_map(link).collect()
}

/// A curve through points. It is vertical at all of them.
fn curve(points: &[Position]) -> Outline {
    let mut curve = Outline::default();
    let mut before: Option<Position> = None;
    for &(x, y) in points {
        match before {
            None => curve.move_to((x, y)),
            Some((from, _)) if (from - x).abs() < 0.01 => curve.line_to((x, y)),
            Some((from, top)) => curve.curve_to((from, 0.5 * (top + y)), (x, 0.5 * (top + y)), (x, y)),
        }
        before = Some((x, y));
    }
    curve
}

fn line(outline: Outline) -> Path {
    outline.stroked(style::PLATFORM, 1.3)
}

/// The head of an arrow with its end at `tip` in a direction (a unit vector).
fn arrowhead(tip: Position, direction: Position) -> Path {
    let (length, half) = ARROWHEAD;
    let back = (tip.0 - length * direction.0, tip.1 - length * direction.1);
    let side = (-half * direction.1, half * direction.0);
    let mut head = Outline::default();
    head.polyline([(back.0 + side.0, back.1 + side.1), tip, (back.0 - side.0, back.1 - side.1)]);
    head.close();
    head.filled(style::PLATFORM)
}
