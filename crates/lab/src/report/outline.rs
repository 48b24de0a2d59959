//! Paths in construction.

use svg::node::element::Path;

use super::style::px;

/// The commands of a path, in px.
#[derive(Default)]
pub(super) struct Outline(String);

impl Outline {
    /// Starts a new part at a point.
    pub(super) fn move_to(&mut self, (x, y): (f64, f64)) {
        self.push("M", &[x, y]);
    }

    /// Draws a straight line to a point.
    pub(super) fn line_to(&mut self, (x, y): (f64, f64)) {
        self.push("L", &[x, y]);
    }

    /// Draws an arc of at most half a circle to a point, to the left or to the right as seen.
    pub(super) fn arc_to(&mut self, radius: f64, left: bool, (x, y): (f64, f64)) {
        self.push("A", &[radius, radius, 0.0, 0.0, f64::from(u8::from(!left)), x, y]);
    }

    /// Draws a cubic curve with these control points to a point.
    pub(super) fn curve_to(&mut self, first: (f64, f64), second: (f64, f64), (x, y): (f64, f64)) {
        self.push("C", &[first.0, first.1, second.0, second.1, x, y]);
    }

    /// Draws a line to the start of the part.
    pub(super) fn close(&mut self) {
        self.0.push('Z');
    }

    /// Draws straight lines between points. Points that are not finite leave a gap.
    pub(super) fn polyline(&mut self, points: impl IntoIterator<Item = (f64, f64)>) {
        let mut drawing = false;
        for point in points {
            let finite = point.0.is_finite() && point.1.is_finite();
            match (finite, drawing) {
                (true, true) => self.line_to(point),
                (true, false) => self.move_to(point),
                (false, _) => {}
            }
            drawing = finite;
        }
    }

    /// A dot, for paths that are drawn by [`dots`](Self::dots).
    pub(super) fn dot(&mut self, point: (f64, f64)) {
        self.move_to(point);
        self.0.push_str("h0");
    }

    /// A cross.
    pub(super) fn cross(&mut self, (x, y): (f64, f64), half: f64) {
        for slope in [half, -half] {
            self.move_to((x - half, y - slope));
            self.line_to((x + half, y + slope));
        }
    }

    /// A square on its corner.
    pub(super) fn diamond(&mut self, (x, y): (f64, f64), half: f64) {
        self.polyline([(x, y - half), (x + half, y), (x, y + half), (x - half, y)]);
        self.close();
    }

    /// The path as a line.
    pub(super) fn stroked(self, colour: &str, width: f64) -> Path {
        self.filled("none").set("stroke", colour).set("stroke-width", px(width)).set("stroke-linejoin", "round")
    }

    /// The path as round dots.
    pub(super) fn dots(self, colour: &str, diameter: f64) -> Path {
        self.stroked(colour, diameter).set("stroke-linecap", "round")
    }

    /// The path as an area.
    pub(super) fn filled(self, colour: &str) -> Path {
        Path::new().set("d", self.0).set("fill", colour)
    }

    fn push(&mut self, command: &str, numbers: &[f64]) {
        self.0.push_str(command);
        self.0.push_str(&numbers.iter().map(|&number| px(number)).collect::<Vec<_>>().join(" "));
    }
}
