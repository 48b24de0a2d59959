//! States, errors and base angles of a run over time.

use std::iter;
use std::ops::Range;

use svg::node::element::{Group, Rectangle};

use super::error_class::{COLOURS, class};
use super::scale::{Scale, decade, round_step};
use crate::report::outline::Outline;
use crate::report::shade::{Shade, shades};
use crate::report::style::{self, Anchor, line, px, text, width_of};
use crate::run::{PlotRecord, Trace};
use crate::score::{ErrorFigures, Tip};
use vibrissa_runtime::machine::OutputKind;
use vibrissa_runtime::math;
use vibrissa_runtime::units::{Dimension, format_si, parse_unit};

/// Height of a strip's heading (px).
const HEADING: f64 = 24.0;
/// Height of the band of states (px).
const BAND: f64 = 24.0;
/// Height of a strip (px).
const STRIP: f64 = 120.0;
/// Least width of a state in the band (px).
const MIN_STATE_WIDTH: f64 = 3.0;
/// Largest number of decades of error.
const DECADES: f64 = 4.0;
/// Space between strips (px).
const GAP: f64 = 16.0;

/// The strips in construction.
pub(super) struct Timeline<'a> {
    trace: &'a Trace,
    time: Scale,
    group: Group,
    /// Upper edge of the next strip.
    y: f64,
}

impl<'a> Timeline<'a> {
    /// Draws strips between `left` and `right`, from `top` downwards. Returns them with their lower side.
    pub(super) fn draw(
        trace: &'a Trace,
        tips: &[Tip],
        error: Option<&ErrorFigures>,
        (left, right): (f64, f64),
        top: f64,
    ) -> (Group, f64) {
        let end = trace.ticks.last().map_or(0.0, |tick| tick.time).max(trace.period);
        let time = Scale { values: (0.0, end), positions: (left, right) };
        let mut timeline = Self { trace, time, group: Group::new(), y: top };
        timeline.states();
        timeline.errors(tips, error);
        timeline.deflections();
        for plot in trace.plots.iter().filter(|plot| !plot.values.is_empty()) {
            timeline.plot(plot);
        }
        timeline.axis();
        (timeline.group, timeline.y)
    }

    fn states(&mut self) {
        let intervals = intervals(self.trace);
        let mut present: Vec<Option<usize>> = intervals.iter().map(|(state, _)| *state).collect();
        // A failure comes last.
        present.sort_unstable_by_key(|state| (state.is_none(), *state));
        present.dedup();
        let shades = shades(&self.trace.parents);
        let fill = |state| fill(&shades, state);
        let names: Vec<_> = present.iter().map(|&state| (numbered(self.trace, state), fill(state))).collect();
        self.heading("State", &names, 12.0);
        let top = self.y;
        for (state, ticks) in intervals {
            let ticks = &self.trace.ticks[ticks];
            let (Some(first), Some(last)) = (ticks.first(), ticks.last()) else { continue };
            // A tick's state lasts until the next tick. The first one's is shown from the start.
            let from = if first.time > self.trace.period { first.time } else { 0.0 };
            let to = (last.time + self.trace.period).min(self.time.values.1);
            let (from, to) = (self.time.at(from), self.time.at(to));
            // The last state may have no duration, for instance a failure.
            let from = from.min(to - MIN_STATE_WIDTH);
            let band = Rectangle::new().set("x", px(from)).set("y", px(top)).set("width", px(to - from));
            self.add(band.set("height", px(BAND)).set("fill", fill(state)));
            // The name, or the number in front of it in the heading, if there is space.
            let label = [name(self.trace, state).to_owned(), number(state)];
            if let Some(label) = label.iter().find(|label| width_of(label, 12.0) + 6.0 < to - from) {
                self.add(text(0.5 * (from + to), top + 16.5, Anchor::Middle, 12.0, style::INK, label));
            }
        }
        self.y = top + BAND + GAP;
    }

    fn errors(&mut self, tips: &[Tip], error: Option<&ErrorFigures>) {
        self.heading("Error (mm)", &[("mean".to_owned(), style::GREY.to_owned())], 1.0);
        let (values, ticks) = decades(tips);
        let scale = self.strip(values, ticks);
        // Errors below the scale are drawn at its lower end.
        let position = |error: f64| scale.at(math::log10(error * 1e3).max(scale.values.0));
        let Some(error) = error.filter(|error| error.mean.is_finite()) else { return };
        let (left, right) = self.time.positions;
        let mean = position(error.mean);
        self.add(line((left, mean), (right, mean), style::GREY, 1.0));
        for (index, colour) in COLOURS.into_iter().enumerate() {
            let mut dots = Outline::default();
            for tip in tips.iter().filter(|tip| tip.error.is_finite() && class(tip.error) == index) {
                dots.dot((self.time.at(self.trace.ticks[tip.tick].time), position(tip.error)));
            }
            self.add(dots.dots(colour, 2.6));
        }
    }

    fn deflections(&mut self) {
        let trace = self.trace;
        let names = trace.whiskers.iter().cloned().zip(style::WHISKERS.map(str::to_owned));
        let names: Vec<_> = names.collect();
        self.heading("Deflection (µrad)", &names, 3.0);
        let readings = |whisker: usize| trace.ticks.iter().map(move |tick| tick.whiskers[whisker].deflection * 1e6);
        let scale = self.strip_around((0..names.len()).flat_map(readings));
        for (whisker, (_, colour)) in names.iter().enumerate() {
            let mut curve = Outline::default();
            let times = trace.ticks.iter().map(|tick| self.time.at(tick.time));
            curve.polyline(times.zip(readings(whisker).map(|value| scale.at(value))));
            self.add(curve.stroked(colour, 1.2));
        }
    }

    /// A plot of the policy. It has gaps where the policy did not set it.
    fn plot(&mut self, plot: &PlotRecord) {
        let trace = self.trace;
        let (unit, factor) = match &plot.kind {
            OutputKind::Number(dimension) => {
                let largest = plot.values.iter().map(|(_, value)| value.abs()).filter(|value| value.is_finite());
                readable_unit(largest.fold(0.0, f64::max), *dimension)
            }
            OutputKind::Choice(names) => {
                let numbered = names.iter().enumerate().map(|(index, name)| format!("{index} {name}"));
                (numbered.collect::<Vec<_>>().join(", "), 1.0)
            }
            OutputKind::Truth => ("1 true".to_owned(), 1.0),
            OutputKind::Vector(_) | OutputKind::Whisker => return,
        };
        let title = if unit.is_empty() { plot.name.clone() } else { format!("{} ({unit})", plot.name) };
        self.heading(&title, &[], 0.0);
        let scale = self.strip_around(plot.values.iter().map(|(_, value)| value * factor));
        let mut curve = Outline::default();
        for piece in plot.values.chunk_by(|(before, _), (after, _)| before + 1 == *after) {
            let points = piece.iter().filter(|(_, value)| value.is_finite());
            curve.polyline(
                points.map(|&(tick, value)| (self.time.at(trace.ticks[tick].time), scale.at(value * factor))),
            );
        }
        self.add(curve.stroked(style::WHISKERS[0], 1.2));
    }

    /// A strip whose scale contains zero and all finite numbers of `values`.
    fn strip_around(&mut self, values: impl Iterator<Item = f64>) -> Scale {
        let all = values.filter(|value| value.is_finite());
        let (low, high) = all.fold((0.0, 0.0), |(low, high): (f64, f64), value| (low.min(value), high.max(value)));
        let span = if high > low && (high - low).is_finite() { high - low } else { 1.0 };
        let step = round_step(span / 4.0);
        // A value beyond a tick by less than a visible distance does not extend the scale.
        let values = ((low / step + 0.01).floor() * step, ((low + span) / step - 0.01).ceil() * step);
        let ticks = Scale { values, positions: (0.0, 1.0) }.ticks(4.0);
        self.strip(values, ticks)
    }

    /// The frame and the grid of a strip for `values`, with `ticks`. Returns the scale of its values.
    fn strip(&mut self, values: (f64, f64), ticks: Vec<(f64, String)>) -> Scale {
        let (left, right) = self.time.positions;
        let (top, bottom) = (self.y, self.y + STRIP);
        let scale = Scale { values, positions: (bottom, top) };
        for (time, _) in self.time.ticks(12.0) {
            self.add(line((self.time.at(time), top), (self.time.at(time), bottom), style::GRID, 1.0));
        }
        for (value, label) in ticks {
            self.add(line((left, scale.at(value)), (right, scale.at(value)), style::GRID, 1.0));
            self.add(text(left - 7.0, scale.at(value) + 4.0, Anchor::End, 12.0, style::GREY, &label));
        }
        self.add(line((left, top), (left, bottom), style::GREY, 1.0));
        self.y = bottom + GAP;
        scale
    }

    /// A heading with names and their colours, in as many rows as necessary. The mark of a name has a height of `mark`
    /// (px).
    fn heading(&mut self, content: &str, names: &[(String, String)], mark: f64) {
        let (left, right) = self.time.positions;
        self.add(text(left, self.y + 12.0, Anchor::Start, 13.0, style::INK, content).set("font-weight", 600));
        let first = left + width_of(content, 13.0) + 18.0;
        let mut x = first;
        for (name, colour) in names {
            let width = 20.0 + width_of(name, 12.0) + 14.0;
            if x + width > right && x > first {
                (x, self.y) = (first, self.y + 18.0);
            }
            let square = Rectangle::new().set("x", px(x)).set("y", px(self.y + 8.0 - 0.5 * mark));
            self.add(square.set("width", 14).set("height", px(mark)).set("fill", colour.as_str()));
            self.add(text(x + 20.0, self.y + 12.0, Anchor::Start, 12.0, style::INK, name));
            x += width;
        }
        self.y += HEADING;
    }

    fn axis(&mut self) {
        let (left, right) = self.time.positions;
        let y = self.y - GAP;
        self.add(line((left, y), (right, y), style::GREY, 1.0));
        for (time, label) in self.time.ticks(12.0) {
            self.add(text(self.time.at(time), y + 17.0, Anchor::Middle, 12.0, style::GREY, &label));
        }
        self.add(text(0.5 * (left + right), y + 36.0, Anchor::Middle, 12.0, style::GREY, "time (s)"));
        self.y = y + 36.0;
    }

    fn add(&mut self, node: impl Into<Box<dyn svg::Node>>) {
        self.group = std::mem::take(&mut self.group).add(node);
    }
}

/// The unit in which [`format_si`] shows a number of this size, and the factor from SI units to it.
fn readable_unit(size_si: f64, dimension: Dimension) -> (String, f64) {
    let shown = format_si(size_si, dimension);
    let unit = shown.split_once(' ').map_or("", |(_, unit)| unit);
    (unit.to_owned(), parse_unit(unit).map_or(1.0, |unit| unit.from_si(1.0)))
}

/// The powers of ten (mm) around the errors of `tips`, and a tick at each.
fn decades(tips: &[Tip]) -> ((f64, f64), Vec<(f64, String)>) {
    let powers = tips.iter().map(|tip| math::log10(tip.error * 1e3)).filter(|power| power.is_finite());
    let (least, greatest) =
        powers.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), power| (low.min(power), high.max(power)));
    let high = if greatest.is_finite() { greatest.ceil() } else { 0.0 };
    let low = least.floor().clamp(high - DECADES, high - 1.0);
    let powers = iter::successors(Some(low), |power| Some(power + 1.0)).take_while(|power| *power <= high);
    ((low, high), powers.map(|power| (power, decade(power))).collect())
}

/// Runs of ticks in the same state.
pub(super) fn intervals(trace: &Trace) -> Vec<(Option<usize>, Range<usize>)> {
    let mut intervals: Vec<(Option<usize>, Range<usize>)> = Vec::new();
    for (index, tick) in trace.ticks.iter().enumerate() {
        match intervals.last_mut() {
            Some((state, ticks)) if *state == tick.state => ticks.end = index + 1,
            _ => intervals.push((tick.state, index..index + 1)),
        }
    }
    intervals
}

pub(super) fn name(trace: &Trace, state: Option<usize>) -> &str {
    state.and_then(|state| trace.states.get(state)).map_or("Failure", String::as_str)
}

/// The number of a state: its index in the machine plus 1. A failure has none.
fn number(state: Option<usize>) -> String {
    state.map_or_else(String::new, |state| (state + 1).to_string())
}

/// The number and the name of a state.
fn numbered(trace: &Trace, state: Option<usize>) -> String {
    format!("{} {}", number(state), name(trace, state)).trim_start().to_owned()
}

/// The fill of a state's area.
pub(super) fn fill(shades: &[Shade], state: Option<usize>) -> String {
    state.and_then(|state| shades.get(state)).map_or_else(|| style::FAILURE.to_owned(), |shade| shade.fill())
}
