//! Curves with bands over the values of an axis.

use svg::node::element::path::Data;
use svg::node::element::{Circle, Group, Path};

use super::scale::Scale;
use crate::report::style::{self, Anchor, line, px, text};

/// A curve with its name.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::report) struct Curve {
    pub(in crate::report) name: String,
    /// Index of a value of the axis, the figure and its 95 % interval.
    pub(in crate::report) points: Vec<(usize, f64, Option<[f64; 2]>)>,
}

/// The values of an axis.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::report) struct Axis {
    pub(in crate::report) name: String,
    /// Each value as text, and as a number if all of them are numbers.
    pub(in crate::report) values: Vec<(String, f64)>,
}

/// Width of the picture and height of its plot (px).
const WIDTH: f64 = 600.0;
const PLOT: [f64; 4] = [70.0, 54.0, 570.0, 330.0];
/// Height of a line of the legend (px).
const LINE: f64 = 20.0;
const DOT: f64 = 4.0;
/// The least distance of neighbouring labels below the axis (px).
const LABEL_GAP: f64 = 12.0;

/// A picture of curves with their bands. `limits` bounds the figure. `None` without a point. A self-contained SVG.
pub(in crate::report) fn curve_picture(
    title: &str,
    axis: &Axis,
    limits: Option<(f64, f64)>,
    curves: &[Curve],
) -> Option<String> {
    let plot = Plot::new(axis, limits, curves)?;
    let [left, _, right, bottom] = PLOT;
    let height = bottom + 50.0 + LINE * curves.len() as f64 + 14.0;
    let mut document = style::sheet((WIDTH, height), title)
        .add(text(left, 30.0, Anchor::Start, 16.0, style::INK, title))
        .add(plot.grid(axis))
        .add(text(right, bottom + 40.0, Anchor::End, 13.0, style::INK, &axis.name));
    for (index, curve) in curves.iter().enumerate() {
        let y = bottom + 62.0 + LINE * index as f64;
        document = document
            .add(plot.band(curve, colour(index)))
            .add(plot.line(curve, colour(index)))
            .add(line((left, y - 4.0), (left + 24.0, y - 4.0), colour(index), 2.5))
            .add(text(left + 32.0, y, Anchor::Start, 13.0, style::INK, &curve.name));
    }
    Some(document.to_string())
}

fn colour(index: usize) -> &'static str {
    style::WHISKERS[index % style::WHISKERS.len()]
}

struct Plot {
    x: Scale,
    y: Scale,
    values: Vec<f64>,
}

impl Plot {
    fn new(axis: &Axis, limits: Option<(f64, f64)>, curves: &[Curve]) -> Option<Self> {
        let [left, top, right, bottom] = PLOT;
        let values: Vec<f64> = axis.values.iter().map(|(_, value)| *value).collect();
        let (first, last) = ends(values.iter().copied())?;
        // Different texts may have the same value, such as 10 mm and 1 cm.
        let margin = if last > first { 0.04 * (last - first) } else { 1.0 };
        let heights = curves.iter().flat_map(|curve| &curve.points).flat_map(|(_, value, interval)| {
            let [low, high] = interval.unwrap_or([*value; 2]);
            [*value, low, high]
        });
        let (low, high) = limits.or_else(|| ends(heights.chain([0.0])))?;
        let high = if high > low { high } else { low + 1.0 };
        Some(Self {
            x: Scale { values: (first - margin, last + margin), positions: (left, right) },
            y: Scale { values: (low, high), positions: (bottom, top) },
            values,
        })
    }

    fn grid(&self, axis: &Axis) -> Group {
        let [left, top, right, bottom] = PLOT;
        let mut group = Group::new();
        for (value, label) in self.y.ticks(5.0) {
            let y = self.y.at(value);
            group = group.add(line((left, y), (right, y), style::GRID, 1.0));
            group = group.add(text(left - 8.0, y + 4.0, Anchor::End, 12.0, style::GREY, &label));
        }
        let mut free = f64::NEG_INFINITY;
        let mut labels: Vec<(f64, &str)> =
            axis.values.iter().map(|(label, value)| (self.x.at(*value), label.as_str())).collect();
        labels.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (x, label) in labels {
            group = group.add(line((x, top), (x, bottom), style::GRID, 1.0));
            let half = 0.5 * style::width_of(label, 12.0);
            if x - half >= free {
                group = group.add(text(x, bottom + 18.0, Anchor::Middle, 12.0, style::GREY, label));
                free = x + half + LABEL_GAP;
            }
        }
        group
    }

    fn at(&self, index: usize, height: f64) -> Option<(f64, f64)> {
        let (low, high) = self.y.values;
        Some((self.x.at(*self.values.get(index)?), self.y.at(height.clamp(low, high))))
    }

    /// The points in the order of their positions.
    fn sorted<'c>(&self, curve: &'c Curve) -> Vec<&'c (usize, f64, Option<[f64; 2]>)> {
        let mut points: Vec<_> = curve.points.iter().filter(|point| point.0 < self.values.len()).collect();
        points.sort_by(|a, b| self.values[a.0].total_cmp(&self.values[b.0]));
        points
    }

    /// The band between the ends of the intervals.
    fn band(&self, curve: &Curve, colour: &str) -> Path {
        let points = self.sorted(curve);
        let end = |side: usize| {
            points.iter().filter_map(move |(index, _, interval)| self.at(*index, interval.as_ref()?[side]))
        };
        let outline: Vec<(f64, f64)> = end(1).chain(end(0).collect::<Vec<_>>().into_iter().rev()).collect();
        let data = path(&outline);
        let data = if outline.is_empty() { data } else { data.close() };
        Path::new().set("d", data).set("fill", colour).set("fill-opacity", 0.18).set("stroke", "none")
    }

    fn line(&self, curve: &Curve, colour: &str) -> Group {
        let points: Vec<(f64, f64)> =
            self.sorted(curve).iter().filter_map(|(index, value, _)| self.at(*index, *value)).collect();
        let stroke = Path::new().set("d", path(&points)).set("fill", "none").set("stroke", colour);
        points.iter().fold(Group::new().add(stroke.set("stroke-width", 2)), |group, (x, y)| {
            group.add(Circle::new().set("cx", px(*x)).set("cy", px(*y)).set("r", DOT).set("fill", colour))
        })
    }
}

fn path(points: &[(f64, f64)]) -> Data {
    points.iter().enumerate().fold(
        Data::new(),
        |data, (index, &point)| {
            if index == 0 { data.move_to(point) } else { data.line_to(point) }
        },
    )
}

/// The least and the greatest of some numbers. `None` without any.
fn ends(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let finite = values.filter(|value| value.is_finite());
    let (low, high) =
        finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    (low <= high).then_some((low, high))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use super::*;

    fn axis(values: &[(&str, f64)]) -> Axis {
        Axis {
            name: "gain".to_owned(),
            values: values.iter().map(|(text, value)| ((*text).to_owned(), *value)).collect(),
        }
    }

    #[test]
    fn a_curve_has_its_band_its_name_and_the_values_of_its_axis() {
        let curve = Curve {
            name: "a <b>".to_owned(),
            points: vec![(1, 50.0, Some([20.0, 80.0])), (0, 100.0, Some([80.0, 100.0])), (9, 1.0, None)],
        };
        let picture =
            curve_picture("pass rate", &axis(&[("0 %", 0.0), ("10 %", 0.1)]), Some((0.0, 100.0)), &[curve]).unwrap();
        assert!(picture.contains("fill-opacity=\"0.18\"") && picture.contains("a &lt;b&gt;"), "{picture}");
        assert!(["\n0 %\n", "\n10 %\n", "\ngain\n"].iter().all(|text| picture.contains(text)), "{picture}");
        assert!(!picture.contains("NaN") && !picture.contains("inf"), "{picture}");
    }

    #[test]
    fn equal_values_and_equal_figures_have_positions() {
        let curve = Curve { name: "a".to_owned(), points: vec![(0, 0.0, None), (1, 0.0, None)] };
        let picture = curve_picture("error", &axis(&[("10 mm", 0.01), ("1 cm", 0.01)]), None, &[curve]).unwrap();
        assert!(!picture.contains("NaN") && !picture.contains("inf"), "{picture}");
    }

    #[test]
    fn without_a_value_there_is_no_picture() {
        assert_eq!(curve_picture("error", &axis(&[]), None, &[]), None);
    }
}
