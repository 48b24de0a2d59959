//! Deflection profile of a whisker: positions of contacts with their base angles.

use svg::node::element::path::Data;
use svg::node::element::{Circle, Group, Path};

use super::scale::Scale;
use crate::report::style::{self, Anchor, line, px, text};
use vibrissa_runtime::calibration::{AngleSurface, Calibration, ContactSet};
use vibrissa_world::geometry::Vector2;

/// Size of the picture, and the frame of the plot within it (px).
const SIZE: (f64, f64) = (900.0, 620.0);
const FRAME: [f64; 4] = [70.0, 70.0, 860.0, 560.0];
/// Colours from the least base angle to the greatest.
const COLOURS: [&str; 6] = ["#440154", "#3b528b", "#21918c", "#35a05a", "#90b020", "#d0a000"];
/// Number of lines of equal base angle.
const LEVELS: f64 = 8.0;
/// Number of cells of the plot in either direction. A line is straight within a cell.
const CELLS: usize = 120;

/// A picture of the sets of a calibration and of the fits to them. All sets are shown as bends to the left. Positions
/// of the tip in the frame of the base are coloured by base angle. Lines of equal base angle are those of the fit `z =
/// f(x, y)`. Curves are those of one channel and of the deflection polynomial. Figure 3.5 of the baseline's report is of this kind. A self-contained SVG.
#[must_use]
pub fn profile_picture(title: &str, length: f64, sets: &[ContactSet], calibration: &Calibration) -> String {
    let sets: Vec<ContactSet> = sets.iter().map(|set| set.to_left()).collect();
    let plot = Plot::new(length, &sets);
    let mut document = style::sheet(SIZE, title)
        .add(text(FRAME[0], 30.0, Anchor::Start, 18.0, style::INK, title))
        .add(text(FRAME[0], 52.0, Anchor::Start, 13.0, style::GREY, &plot.subtitle(calibration)))
        .add(plot.axes());
    if let Some(surface) = &calibration.recursive {
        document = document.add(plot.levels(surface));
    }
    document = document.add(plot.shaft(length)).add(plot.sets(&sets));
    if let Some(curve) = &calibration.one_channel {
        let [least, greatest] = curve.range;
        let at = |share: f64| curve.at(least + share * (greatest - least));
        document = document.add(plot.path((0..=100).map(|index| at(f64::from(index) / 100.0)), style::ALARM, 2.5));
    }
    if let Some(polynomial) = &calibration.polynomial {
        let at = |share: f64| polynomial.at(share * polynomial.range);
        let path = plot.path((0..=100).map(|index| at(f64::from(index) / 100.0)), style::INK, 1.5);
        document = document.add(path.set("stroke-dasharray", "6 4"));
    }
    document.to_string()
}

/// Conversion of positions in the frame of the base to the picture.
struct Plot {
    x: Scale,
    y: Scale,
    /// The greatest base angle (rad).
    greatest: f64,
}

impl Plot {
    fn new(length: f64, sets: &[ContactSet]) -> Self {
        let highest = sets.iter().map(|set| set.contact_base.y).fold(0.3 * length, f64::max);
        let [left, top, right, bottom] = FRAME;
        // One scale for both directions.
        let breadth = (1.1 * length).max(1.1 * highest * (right - left) / (bottom - top));
        let height = breadth * (bottom - top) / (right - left);
        Self {
            x: Scale { values: (-0.02 * length, breadth - 0.02 * length), positions: (left, right) },
            y: Scale { values: (-0.05 * height, 0.95 * height), positions: (bottom, top) },
            greatest: sets.iter().map(|set| set.base_angle).fold(0.0, f64::max),
        }
    }

    fn subtitle(&self, calibration: &Calibration) -> String {
        let mut parts = vec![format!("colours up to {:.0} µrad", 1e6 * self.greatest), "○ on the shaft".to_owned()];
        if calibration.recursive.is_some() {
            parts.push(format!("thin: equal base angles, every {:.0} µrad", 1e6 * self.greatest / LEVELS));
        }
        if calibration.one_channel.is_some() {
            parts.push("thick: one channel".to_owned());
        }
        if calibration.polynomial.is_some() {
            parts.push("dashed: polynomial".to_owned());
        }
        parts.join("; ")
    }

    fn at(&self, position: Vector2) -> (f64, f64) {
        (self.x.at(position.x), self.y.at(position.y))
    }

    fn colour(&self, base_angle: f64) -> &'static str {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index of a colour")]
        let index = (base_angle / self.greatest * COLOURS.len() as f64).max(0.0) as usize;
        COLOURS[index.min(COLOURS.len() - 1)]
    }

    /// Axes with their ticks (mm).
    fn axes(&self) -> Group {
        let [left, _, right, bottom] = FRAME;
        let mut group = Group::new();
        let millimetres =
            |scale: &Scale| Scale { values: (1e3 * scale.values.0, 1e3 * scale.values.1), positions: scale.positions };
        let (x, y) = (millimetres(&self.x), millimetres(&self.y));
        for (value, label) in x.ticks(8.0) {
            let position = x.at(value);
            group = group.add(line((position, FRAME[1]), (position, bottom), style::GRID, 1.0));
            group = group.add(text(position, bottom + 18.0, Anchor::Middle, 12.0, style::GREY, &label));
        }
        for (value, label) in y.ticks(5.0) {
            let position = y.at(value);
            group = group.add(line((left, position), (right, position), style::GRID, 1.0));
            group = group.add(text(left - 8.0, position + 4.0, Anchor::End, 12.0, style::GREY, &label));
        }
        let middle = f64::midpoint(left, right);
        group.add(text(middle, bottom + 42.0, Anchor::Middle, 13.0, style::INK, "along the undeflected shaft, mm"))
    }

    /// The undeflected shaft.
    fn shaft(&self, length: f64) -> Path {
        self.path([Vector2::zeros(), Vector2::new(length, 0.0)].into_iter(), style::PLATFORM, 3.0)
    }

    fn sets(&self, sets: &[ContactSet]) -> Group {
        sets.iter().fold(Group::new(), |group, set| {
            let (x, y) = self.at(set.contact_base);
            let colour = self.colour(set.base_angle);
            let dot = Circle::new().set("cx", px(x)).set("cy", px(y)).set("r", 4).set("stroke", colour);
            group.add(dot.set("fill", if set.on_shaft { "none" } else { colour }))
        })
    }

    fn path(&self, positions: impl Iterator<Item = Vector2>, colour: &str, width: f64) -> Path {
        let data = positions.enumerate().fold(Data::new(), |data, (index, position)| {
            let (x, y) = self.at(position);
            if index == 0 { data.move_to((x, y)) } else { data.line_to((x, y)) }
        });
        Path::new().set("d", data).set("fill", "none").set("stroke", colour).set("stroke-width", px(width))
    }

    /// Lines of equal base angle within the range of the polynomial, straight within each cell.
    fn levels(&self, surface: &AngleSurface) -> Group {
        let between = |(low, high): (f64, f64), index: usize| low + (high - low) * index as f64 / CELLS as f64;
        let corner = |column, row| Vector2::new(between(self.x.values, column), between(self.y.values, row));
        let mut group = Group::new();
        for level in 1..8 {
            let angle = self.greatest * f64::from(level) / LEVELS;
            let mut data = Data::new();
            for (column, row) in (0..CELLS).flat_map(|column| (0..CELLS).map(move |row| (column, row))) {
                let corners = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(i, j)| corner(column + i, row + j));
                if !corners.iter().all(|corner| surface.contains(*corner)) {
                    continue;
                }
                let over = corners.map(|corner| surface.at(corner).0 - angle);
                let crossings = (0..4).filter_map(|side| {
                    let (a, b) = (over[side], over[(side + 1) % 4]);
                    ((a < 0.0) != (b < 0.0)).then(|| corners[side].lerp(&corners[(side + 1) % 4], a / (a - b)))
                });
                for (index, crossing) in crossings.enumerate() {
                    let position = self.at(crossing);
                    data = if index % 2 == 0 { data.move_to(position) } else { data.line_to(position) };
                }
            }
            let path = Path::new().set("d", data).set("fill", "none").set("stroke", self.colour(angle));
            group = group.add(path.set("stroke-width", 1));
        }
        group
    }
}
