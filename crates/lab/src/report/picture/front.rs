//! Picture of cost against error, with the Pareto-optimal points.

use svg::node::element::path::Data;
use svg::node::element::{Circle, Group, Path};
use vibrissa_runtime::math;

use super::scale::Scale;
use crate::report::style::{self, Anchor, line, px, text};

/// A point with a cost and an error by each of three measures.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FrontPoint {
    /// Name of the point.
    pub(super) name: String,
    /// Index of its kind, which determines its colour.
    pub(super) kind: usize,
    /// Its cost, above 0.
    pub(super) cost: f64,
    /// Its errors, above 0. The flags are true if it is Pareto-optimal among all points, and among those of its group.
    pub(super) errors: [Option<(f64, bool, bool)>; MEASURES],
}

/// Number of measures of the error.
pub(super) const MEASURES: usize = 3;
/// Width of the picture, of a panel and of its sides, and heights (px).
const WIDTH: f64 = 1560.0;
const PANEL: (f64, f64) = (420.0, 440.0);
const LEFT: [f64; MEASURES] = [70.0, 580.0, 1090.0];
const TOP: f64 = 100.0;
/// Columns of the names, and the height of a line of them (px).
const COLUMNS: usize = 5;
const LINE: f64 = 20.0;
const DOT: f64 = 4.5;
/// Size of a number beside a point (px), and its largest distance from the point.
const NUMBER: f64 = 11.0;

/// A picture of cost against error, both on logarithmic scales. It has one panel for each error. A line connects the
/// Pareto-optimal points, and points that are Pareto-optimal in their group are filled. The first point has a ring. A
/// self-contained SVG.
pub(super) fn front_picture(
    title: &str,
    subtitle: &str,
    cost: &str,
    errors: [&str; MEASURES],
    kinds: &[&str],
    points: &[FrontPoint],
) -> String {
    let names_top = TOP + PANEL.1 + 80.0;
    let lines = points.len().div_ceil(COLUMNS);
    let height = names_top + LINE * (lines as f64 + 2.0) + 10.0;
    let mut document = style::sheet((WIDTH, height), title)
        .add(text(LEFT[0], 36.0, Anchor::Start, 20.0, style::INK, title))
        .add(text(LEFT[0], 60.0, Anchor::Start, 13.0, style::GREY, subtitle));
    for (measure, error) in errors.into_iter().enumerate() {
        if let Some(panel) = Panel::new(measure, points) {
            document = document.add(panel.draw(cost, error, points));
        }
    }
    document = document.add(kind_line(kinds, names_top - LINE));
    document.add(names(points, names_top + LINE)).to_string()
}

/// One measure of the error, with its scales.
struct Panel {
    measure: usize,
    left: f64,
    x: Scale,
    y: Scale,
}

impl Panel {
    /// The panel of an error. `None` if no point has it.
    fn new(measure: usize, points: &[FrontPoint]) -> Option<Self> {
        let known = || points.iter().filter_map(|point| Some((point.cost, point.errors[measure]?.0)));
        let left = LEFT[measure];
        let x = logarithmic(known().map(|(cost, _)| cost), (left, left + PANEL.0))?;
        let y = logarithmic(known().map(|(_, error)| error), (TOP + PANEL.1, TOP))?;
        Some(Self { measure, left, x, y })
    }

    fn draw(&self, cost: &str, error: &str, points: &[FrontPoint]) -> Group {
        let (right, bottom) = (self.left + PANEL.0, TOP + PANEL.1);
        let mut group = Group::new();
        for (position, label) in round_values(&self.x) {
            group = group.add(line((position, TOP), (position, bottom), style::GRID, 1.0));
            group = group.add(text(position, bottom + 18.0, Anchor::Middle, 12.0, style::GREY, &label));
        }
        for (position, label) in round_values(&self.y) {
            group = group.add(line((self.left, position), (right, position), style::GRID, 1.0));
            group = group.add(text(self.left - 8.0, position + 4.0, Anchor::End, 12.0, style::GREY, &label));
        }
        group = group.add(text(self.left, TOP - 14.0, Anchor::Start, 13.0, style::INK, error));
        group = group.add(text(right, bottom + 40.0, Anchor::End, 13.0, style::INK, cost));
        group = group.add(self.front(points));
        let mut taken: Vec<(f64, f64)> = points.iter().filter_map(|point| self.position(point)).collect();
        for (index, point) in points.iter().enumerate() {
            let Some((x, y)) = self.position(point) else { continue };
            let is_filled = point.errors[self.measure].is_some_and(|(_, _, is_on)| is_on);
            let colour = colour(point.kind);
            let dot = Circle::new().set("cx", px(x)).set("cy", px(y)).set("r", DOT).set("stroke", colour);
            group = group.add(dot.set("fill", if is_filled { colour } else { "#ffffff" }).set("stroke-width", 1.5));
            if index == 0 {
                let ring = Circle::new().set("cx", px(x)).set("cy", px(y)).set("r", 2.0 * DOT);
                group = group.add(ring.set("fill", "none").set("stroke", style::INK).set("stroke-width", 1.5));
            }
            let position = free_position((x, y), &taken);
            taken.push(position);
            let number = (index + 1).to_string();
            group = group.add(text(position.0, position.1 + 0.35 * NUMBER, Anchor::Middle, NUMBER, colour, &number));
        }
        group
    }

    fn position(&self, point: &FrontPoint) -> Option<(f64, f64)> {
        let (error, ..) = point.errors[self.measure]?;
        Some((self.x.at(math::log10(point.cost)), self.y.at(math::log10(error))))
    }

    /// The step curve of the least error for each cost.
    fn front(&self, points: &[FrontPoint]) -> Path {
        let is_on = |point: &&FrontPoint| point.errors[self.measure].is_some_and(|(_, is_on, _)| is_on);
        let mut positions: Vec<(f64, f64)> =
            points.iter().filter(is_on).filter_map(|point| self.position(point)).collect();
        positions.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut data = Data::new();
        let mut before = None;
        for (x, y) in positions {
            data = match before {
                None => data.move_to((x, TOP)).line_to((x, y)),
                Some(height) => data.line_to((x, height)).line_to((x, y)),
            };
            before = Some(y);
        }
        if let Some(height) = before {
            data = data.line_to((self.left + PANEL.0, height));
        }
        Path::new().set("d", data).set("fill", "none").set("stroke", style::GREY).set("stroke-width", 1.5)
    }
}

/// A position beside a point (px) for its number: the nearest free one, or else the first.
fn free_position((x, y): (f64, f64), taken: &[(f64, f64)]) -> (f64, f64) {
    let around = |radius: f64| {
        (0..12).map(move |k| {
            let angle = f64::from(k) * std::f64::consts::TAU / 12.0 - std::f64::consts::FRAC_PI_4;
            (x + radius * math::cos(angle), y + radius * math::sin(angle))
        })
    };
    let is_free = |position: &(f64, f64)| {
        taken
            .iter()
            .all(|other| (position.0 - other.0).abs() > 1.2 * NUMBER || (position.1 - other.1).abs() > 0.9 * NUMBER)
    };
    let mut positions = [14.0, 20.0, 28.0, 38.0, 50.0].into_iter().flat_map(around);
    positions.find(is_free).unwrap_or((x + 14.0, y))
}

/// The scale of the logarithms of some numbers above 0, with margins. `None` without numbers.
fn logarithmic(values: impl Iterator<Item = f64>, positions: (f64, f64)) -> Option<Scale> {
    const MARGIN_SHARE: f64 = 0.08;
    let logarithms = values.map(math::log10).filter(|value| value.is_finite());
    let (low, high) =
        logarithms.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    let margin = MARGIN_SHARE * (high - low).max(0.1);
    (low <= high).then_some(Scale { values: (low - margin, high + margin), positions })
}

/// The numbers 1, 2 and 5 times powers of ten on a logarithmic scale: their positions and texts.
fn round_values(scale: &Scale) -> Vec<(f64, String)> {
    let (low, high) = scale.values;
    #[expect(clippy::cast_possible_truncation, reason = "the exponents of measured values")]
    let powers = low.floor() as i32..=high.floor() as i32;
    let values = powers.flat_map(|power| [1.0, 2.0, 5.0].map(|digit: f64| (digit * math::powi(10.0, power), power)));
    let on_scale = values.filter(|(value, _)| (low..=high).contains(&math::log10(*value)));
    on_scale
        .map(|(value, power)| {
            let decimals = usize::try_from(-power).unwrap_or(0);
            (scale.at(math::log10(value)), format!("{value:.decimals$}"))
        })
        .collect()
}

fn colour(kind: usize) -> &'static str {
    style::WHISKERS[kind % style::WHISKERS.len()]
}

/// The legend of the colours.
fn kind_line(kinds: &[&str], y: f64) -> Group {
    let mut x = LEFT[0];
    kinds.iter().enumerate().fold(Group::new(), |group, (kind, name)| {
        let position = x;
        x += style::width_of(name, 13.0) + 40.0;
        let dot = Circle::new().set("cx", px(position)).set("cy", px(y - 4.0)).set("r", DOT).set("fill", colour(kind));
        group.add(dot).add(text(position + 10.0, y, Anchor::Start, 13.0, style::INK, name))
    })
}

/// The names by their numbers in columns.
fn names(points: &[FrontPoint], top: f64) -> Group {
    let lines = points.len().div_ceil(COLUMNS);
    let breadth = (WIDTH - LEFT[0]) / COLUMNS as f64;
    points.iter().enumerate().fold(Group::new(), |group, (index, point)| {
        let (column, row) = ((index / lines) as f64, (index % lines) as f64);
        let name = format!("{} · {}", index + 1, point.name);
        group.add(text(LEFT[0] + column * breadth, top + row * LINE, Anchor::Start, 13.0, colour(point.kind), &name))
    })
}
