//! Legend of the map, and the run's figures.

use svg::Node;
use svg::node::element::{Group, Path, Rectangle};

use super::error_class::{COLOURS, LIMITS};
use super::map::{self, MIDPOINT, OUTLINE, UNTRACED, axis_style, mark_style, pose_style};
use super::scale::round_step;
use super::touched::{ROUTE, TARGET};
use crate::report::number::{mean_std, millimetres};
use crate::report::outline::Outline;
use crate::report::style::{self, Anchor, line, px, text};
use crate::run::Trace;
use crate::score::{RetrievalFigures, Score};
use vibrissa_runtime::machine::Mark;

/// Height of a line (px).
const LINE: f64 = 22.0;

/// Space before a heading (px).
const GAP: f64 = 10.0;

/// Height of the bar of error classes (px).
const BAR: f64 = 12.0;

/// Width of a mark (px).
const MARK: f64 = 34.0;

/// Descriptions of the Hausdorff distance, which is either that of a point of the outline or that of an estimate.
const OUTLINE_FARTHEST: &str = "of the outline's farthest untraced point";
const ESTIMATE_FARTHEST: &str = "of the farthest estimate";

/// The entries of the object that a picture needs.
#[derive(Debug, Clone, Copy)]
pub(super) struct ObjectEntries {
    /// True if parts of its outline were not traced.
    pub(super) untraced: bool,
    /// True if it is a tunnel with an axis.
    pub(super) axis: bool,
    /// True if there is a map by touch.
    pub(super) touched: bool,
}

/// The column beside the map in construction.
pub(super) struct Legend {
    group: Group,
    left: f64,
    width: f64,
    /// The baseline of the next line.
    y: f64,
}

impl Legend {
    /// The whole column, `width` (px) wide, with its upper left corner at (`left`, `top`). `scale` is that of the map
    /// (px per metre).
    pub(super) fn draw(
        (left, top): (f64, f64),
        width: f64,
        scale: f64,
        trace: &Trace,
        score: &Score,
        object: ObjectEntries,
    ) -> Group {
        let mut legend = Self { group: Group::new(), left, width, y: top + 12.0 };
        legend.contour(object);
        legend.estimates();
        legend.platform(trace);
        legend.marks(trace);
        legend.touched(object);
        legend.figures(trace, score);
        legend.scale_bar(scale);
        legend.group
    }

    fn contour(&mut self, object: ObjectEntries) {
        self.heading("Object");
        let mut reference = Outline::default();
        reference.polyline(self.mark());
        self.entry(reference.stroked(style::INK, OUTLINE), "outline, exact");
        if object.axis {
            let mut axis = Outline::default();
            axis.polyline(self.mark());
            self.entry(axis_style(axis), "axis of the tunnel");
            let mut dots = Outline::default();
            let [(from, y), (to, _)] = self.mark();
            (0..5).for_each(|index| dots.dot((from + 0.25 * f64::from(index) * (to - from), y)));
            self.entry(dots.dots(style::INK, MIDPOINT), "midpoints between the tips");
        }
        if object.untraced {
            let mut stretch = Outline::default();
            stretch.polyline(self.mark());
            self.entry(stretch.stroked(style::UNTRACED, UNTRACED), "not traced within 1 mm");
        }
    }

    /// The colours of the classes side by side, with the limits between them.
    fn estimates(&mut self) {
        self.y += GAP;
        self.heading("Tip estimates by error (mm)");
        let (top, width) = (self.y - 0.6 * LINE, self.width / COLOURS.len() as f64);
        for (index, colour) in COLOURS.into_iter().enumerate() {
            let left = self.left + index as f64 * width;
            let field = Rectangle::new().set("x", px(left)).set("y", px(top)).set("width", px(width));
            self.add(field.set("height", px(BAR)).set("fill", colour));
            if let Some(limit) = LIMITS.get(index) {
                let (right, y) = (left + width, top + BAR + LINE - 6.0);
                self.add(text(right, y, Anchor::Middle, 12.0, style::INK, &limit.to_string()));
            }
        }
        self.y += LINE + BAR - 4.0;
    }

    fn platform(&mut self, trace: &Trace) {
        self.y += GAP;
        self.heading("Platform");
        for (index, meaning) in ["at the start", "at intermediate times", "at the end"].into_iter().enumerate() {
            let [(from, y), (to, _)] = self.mark();
            let mut body = Outline::default();
            body.polyline([(from + 3.0, y - 6.0), (to - 3.0, y - 2.0), (to - 3.0, y + 2.0), (from + 3.0, y + 6.0)]);
            body.close();
            self.entry(pose_style(body, index, 3), meaning);
        }
        let mut path = Outline::default();
        path.polyline(self.mark());
        self.entry(path.stroked(style::PLATFORM, 1.0).set("stroke-dasharray", "5 3"), "path of its centre of mass");
        if trace.ticks.iter().any(|tick| tick.body_touches) {
            let mut cross = Outline::default();
            let [(from, y), (to, _)] = self.mark();
            cross.cross((0.5 * (from + to), y), 4.0);
            self.entry(cross.stroked(style::ALARM, 1.5), "contact of its body");
        }
    }

    fn marks(&mut self, trace: &Trace) {
        if trace.marks.is_empty() {
            return;
        }
        self.y += GAP;
        self.heading("Marks");
        for (mark, meaning) in [(Mark::Lost, "edge lost"), (Mark::Found, "contact found again")] {
            let mut diamond = Outline::default();
            let [(from, y), (to, _)] = self.mark();
            diamond.diamond((0.5 * (from + to), y), map::MARK);
            self.entry(mark_style(diamond, mark), meaning);
        }
    }

    fn touched(&mut self, object: ObjectEntries) {
        if !object.touched {
            return;
        }
        self.y += GAP;
        self.heading("Map by touch, at the end");
        for (colour, meaning) in [(style::FREE_GROUND, "proved free"), (style::BLOCKED_GROUND, "blocked")] {
            let mut ground = Outline::default();
            ground.polyline(self.mark());
            self.entry(ground.stroked(colour, UNTRACED), meaning);
        }
        let mut target = Outline::default();
        let [(from, y), (to, _)] = self.mark();
        target.diamond((0.5 * (from + to), y), TARGET);
        self.entry(target.stroked(style::ROUTE, ROUTE), "next target");
        let mut route = Outline::default();
        route.polyline(self.mark());
        self.entry(route.stroked(style::ROUTE, ROUTE), "route");
    }

    fn figures(&mut self, trace: &Trace, score: &Score) {
        self.y += GAP;
        self.heading("Figures");
        if let Some(error) = &score.error {
            self.figure("error", &format!("{} mm", mean_std(error.mean * 1e3, error.std.map(|std| std * 1e3))));
            self.figure("95th percentile", &format!("{} mm", millimetres(error.p95 * 1e3)));
            self.figure("maximum", &format!("{} mm", millimetres(error.max * 1e3)));
        }
        if let Some(hausdorff) = score.hausdorff {
            self.figure("Hausdorff distance", &format!("{} mm", millimetres(hausdorff * 1e3)));
            // The distance is the greater of two. It is the greatest error only if the whole outline was traced.
            let of_outline = score.error.as_ref().is_some_and(|error| hausdorff > error.max);
            let meaning = if of_outline { OUTLINE_FARTHEST } else { ESTIMATE_FARTHEST };
            self.add(text(self.left, self.y - 5.0, Anchor::Start, 11.0, style::GREY, meaning));
            self.y += LINE - 6.0;
        }
        if let Some(axis) = score.axis {
            self.figure("axis error", &format!("{} mm", mean_std(axis.mean * 1e3, axis.std.map(|std| std * 1e3))));
        }
        self.figure("coverage", &format!("{:.1} %", score.coverage * 100.0));
        if let Some(RetrievalFigures { count, radius, .. }) = score.retrieval {
            let radius = radius.map_or_else(String::new, |radius| {
                format!("{} mm radius, ", mean_std(radius.mean * 1e3, radius.std.map(|std| std * 1e3)))
            });
            self.figure("retrievals", &format!("{radius}{count}"));
        }
        self.figure("tip estimates", &score.error.map_or(0, |error| error.count).to_string());
        self.figure("simulated time", &format!("{:.1} s", trace.ticks.last().map_or(0.0, |tick| tick.time)));
    }

    fn scale_bar(&mut self, scale: f64) {
        let length = round_step(60.0 / scale);
        let (left, right, y) = (self.left, self.left + length * scale, self.y + 14.0);
        let mut bar = Outline::default();
        bar.polyline([(left, y - 4.0), (left, y), (right, y), (right, y - 4.0)]);
        self.add(bar.stroked(style::INK, 1.5));
        self.add(text(right + 8.0, y + 1.0, Anchor::Start, 13.0, style::INK, &format!("{} mm", length * 1e3)));
    }

    fn heading(&mut self, content: &str) {
        let (left, y) = (self.left, self.y);
        self.add(text(left, y, Anchor::Start, 13.0, style::INK, content).set("font-weight", 600));
        self.add(line((left, y + 7.5), (left + self.width, y + 7.5), style::GRID, 1.0));
        self.y += LINE + 7.0;
    }

    fn entry(&mut self, mark: Path, meaning: &str) {
        self.add(mark);
        self.add(text(self.left + MARK + 10.0, self.y, Anchor::Start, 13.0, style::INK, meaning));
        self.y += LINE;
    }

    fn figure(&mut self, name: &str, value: &str) {
        self.add(text(self.left, self.y, Anchor::Start, 13.0, style::GREY, name));
        self.add(text(self.left + self.width, self.y, Anchor::End, 13.0, style::INK, value));
        self.y += LINE;
    }

    /// The ends of the next entry's mark.
    fn mark(&self) -> [(f64, f64); 2] {
        [self.left, self.left + MARK].map(|x| (x, self.y - 4.5))
    }

    fn add(&mut self, node: impl Into<Box<dyn Node>>) {
        self.group = std::mem::take(&mut self.group).add(node);
    }
}
