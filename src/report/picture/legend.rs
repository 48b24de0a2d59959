//! What the map's marks mean, and the run's figures.

use std::cmp::Ordering;

use svg::Node;
use svg::node::element::{Group, Path};

use super::map::{self, DOT, OUTLINE, UNTRACED, mark_style, pose_style};
use super::scale::round_step;
use crate::machine::Mark;
use crate::report::number::{mean_std, millimetres};
use crate::report::outline::Outline;
use crate::report::style::{self, Anchor, error_colour, line, text};
use crate::run::Trace;
use crate::score::{ErrorFigures, RetrievalFigures, Score};

/// Height of a line (px).
const LINE: f64 = 22.0;

/// Room before a heading (px).
const GAP: f64 = 10.0;

/// Room for a mark (px).
const MARK: f64 = 34.0;

/// The column beside the map, in the making.
pub(super) struct Legend {
    group: Group,
    left: f64,
    width: f64,
    /// The baseline of the next line.
    y: f64,
}

impl Legend {
    /// The whole column, `width` (px) wide, from (`left`, `top`) down; `scale` is the map's, px a metre.
    pub(super) fn draw(
        (left, top): (f64, f64),
        width: f64,
        scale: f64,
        trace: &Trace,
        score: &Score,
        untraced: bool,
    ) -> Group {
        let mut legend = Self { group: Group::new(), left, width, y: top + 12.0 };
        legend.contour(untraced);
        legend.estimates(score.error.as_ref());
        legend.platform(trace);
        legend.marks(trace);
        legend.figures(trace, score);
        legend.scale_bar(scale);
        legend.group
    }

    fn contour(&mut self, untraced: bool) {
        self.heading("Object");
        let mut reference = Outline::default();
        reference.polyline(self.mark());
        self.entry(reference.stroked(style::INK, OUTLINE), "outline, exact");
        if untraced {
            let mut stretch = Outline::default();
            stretch.polyline(self.mark());
            self.entry(stretch.stroked(style::UNTRACED, UNTRACED), "not traced within 1 mm");
        }
    }

    fn estimates(&mut self, error: Option<&ErrorFigures>) {
        let Some(error) = error else { return };
        self.y += GAP;
        self.heading("Tip estimates by error");
        let (mean, std) = (error.mean * 1e3, error.std.unwrap_or(0.0) * 1e3);
        let (low, high) = (mean - std, mean + std);
        if low > 0.0 {
            self.error_class(Ordering::Less, &format!("below {} mm", millimetres(low)));
            let within = format!("{} to {} mm, mean ± std", millimetres(low), millimetres(high));
            self.error_class(Ordering::Equal, &within);
        } else {
            self.error_class(Ordering::Equal, &format!("up to {} mm, mean + std", millimetres(high)));
        }
        self.error_class(Ordering::Greater, &format!("above {} mm", millimetres(high)));
    }

    fn error_class(&mut self, against_mean: Ordering, meaning: &str) {
        let mut dots = Outline::default();
        let [(from, y), (to, _)] = self.mark();
        for k in 0..4 {
            dots.dot((from + 2.0 + (to - from - 4.0) * f64::from(k) / 3.0, y));
        }
        self.entry(dots.dots(error_colour(against_mean), DOT), meaning);
    }

    fn platform(&mut self, trace: &Trace) {
        self.y += GAP;
        self.heading("Platform");
        for (index, meaning) in ["at the start", "at times between", "at the end"].into_iter().enumerate() {
            let [(from, y), (to, _)] = self.mark();
            let mut body = Outline::default();
            body.polyline([(from + 3.0, y - 6.0), (to - 3.0, y - 2.0), (to - 3.0, y + 2.0), (from + 3.0, y + 6.0)]);
            body.close();
            self.entry(pose_style(body, index, 3), meaning);
        }
        let mut way = Outline::default();
        way.polyline(self.mark());
        self.entry(way.stroked(style::PLATFORM, 1.0).set("stroke-dasharray", "5 3"), "path of its centre of mass");
        if trace.ticks.iter().any(|tick| tick.body_touches) {
            let mut cross = Outline::default();
            let [(from, y), (to, _)] = self.mark();
            cross.cross((0.5 * (from + to), y), 4.0);
            self.entry(cross.stroked(style::ALARM, 1.5), "its body touches something");
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
