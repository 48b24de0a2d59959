//! The scene from above: objects, estimate, platform. The map by touch is the layer in `touched.rs`.

use std::f64::consts::PI;
use std::iter;
use std::ops::Range;

use svg::node::element::{ClipPath, Definitions, Group, Rectangle};

use super::Untraced;
use super::error_class::{COLOURS, class};
use super::scale::Scale;
use super::shaft::shaft_body;
use super::touched::layer;
use crate::report::outline::Outline;
use crate::report::style::{self, Anchor, line, px, text};
use crate::run::{RunMap, TickRecord, Trace};
use crate::score::{Tip, mark_positions, midpoints};
use vibrissa_runtime::machine::Mark;
use vibrissa_runtime::math;
use vibrissa_runtime::rig::Rig;
use vibrissa_world::geometry::{BoundingBox, Contour, Piece, Point2, Pose, unit};
use vibrissa_world::scene::Scene;

/// Diameter of an estimate's dot (px).
pub(super) const DOT: f64 = 5.0;

/// Width of an outline (px).
pub(super) const OUTLINE: f64 = 0.7;

/// Width of an untraced section (px).
pub(super) const UNTRACED: f64 = 12.0;

/// Half the width of the diamond of a mark (px).
pub(super) const MARK: f64 = 5.0;

/// Diameter of a midpoint's dot (px).
pub(super) const MIDPOINT: f64 = 2.6;

/// Distance of the points of an axis (m).
const AXIS_STEP: f64 = 2e-3;

/// Number of poses of the platform between the first and the last.
const POSES_BETWEEN: usize = 5;

/// The panel of the map with its position and scales.
pub(super) struct Map {
    x: Scale,
    y: Scale,
    /// Scale (px per metre).
    pub(super) scale: f64,
    /// Height of the panel (px).
    pub(super) height: f64,
    /// Number of poses of the platform that are drawn between the first and the last.
    poses_between: usize,
}

impl Map {
    /// A panel of `width` (px) with its upper left corner at (`left`, `top`). It contains the objects and the path of
    /// the platform. Its height is between `least` and `most`.
    pub(super) fn new(
        scene: &Scene,
        trace: &Trace,
        (left, top): (f64, f64),
        width: f64,
        (least, most): (f64, f64),
    ) -> Self {
        let ticks = shown_ticks(trace, POSES_BETWEEN).into_iter();
        let shown = ticks.flat_map(|tick| footprint(&scene.rig, &tick.body)).chain(path(trace));
        let shown = shown
            .fold(scene.truth.surfaces.bounding_box(), |shown, point| shown.union(&BoundingBox::around(point, point)));
        let (extent, centre) = (shown.max - shown.min, nalgebra::center(&shown.min, &shown.max));
        let scale = 0.94 * (width / extent.x).min(most / extent.y);
        let height = (scale * extent.y / 0.94).clamp(least, most);
        let half = (0.5 * width / scale, 0.5 * height / scale);
        Self {
            x: Scale { values: (centre.x - half.0, centre.x + half.0), positions: (left, left + width) },
            y: Scale { values: (centre.y - half.1, centre.y + half.1), positions: (top + height, top) },
            scale,
            height,
            poses_between: POSES_BETWEEN,
        }
    }

    /// A square panel with its `side` (px) and its upper left corner at (`left`, `top`). It shows a square of twice `half`
    /// (m) around `centre`.
    pub(super) fn square(centre: Point2, half: f64, (left, top): (f64, f64), side: f64) -> Self {
        Self {
            x: Scale { values: (centre.x - half, centre.x + half), positions: (left, left + side) },
            y: Scale { values: (centre.y - half, centre.y + half), positions: (top + side, top) },
            scale: 0.5 * side / half,
            height: side,
            poses_between: POSES_BETWEEN,
        }
    }

    /// The same panel, on which only the first and the last pose of the platform are drawn.
    pub(super) fn without_poses_between(self) -> Self {
        Self { poses_between: 0, ..self }
    }

    /// The panel with its content.
    pub(super) fn draw(
        &self,
        scene: &Scene,
        trace: &Trace,
        touched: Option<&RunMap>,
        untraced: &[Untraced<'_>],
        tips: &[Tip],
    ) -> Group {
        let frame = || {
            Rectangle::new()
                .set("x", px(self.x.positions.0))
                .set("y", px(self.y.positions.1))
                .set("width", px(self.x.positions.1 - self.x.positions.0))
                .set("height", px(self.height))
        };
        let mut inside = Group::new().set("clip-path", "url(#map)");
        let solids = || scene.solids.iter().map(|solid| self.outline(solid.outline()));
        inside = solids().fold(inside, |inside, solid| inside.add(solid.filled(style::SOLID)));
        // Over the solids, so that ground that is claimed wrongly is seen.
        inside = touched.map(|map| layer(self, map)).into_iter().fold(inside, Group::add);
        for Untraced { contour, stretches } in untraced {
            inside = inside.add(self.stretches(contour, stretches).stroked(style::UNTRACED, UNTRACED));
        }
        inside = inside.add(self.platform(&scene.rig, trace));
        // The largest errors are drawn last, so that they stay visible.
        for (index, colour) in COLOURS.into_iter().enumerate() {
            let mut dots = Outline::default();
            let of_class = tips.iter().filter(|tip| class(tip.error) == index);
            let positions = of_class.map(|tip| self.position(tip.tip_world)).filter(|position| self.shows(*position));
            positions.for_each(|position| dots.dot(position));
            inside = inside.add(dots.dots(colour, DOT));
        }
        inside = solids().fold(inside, |inside, solid| inside.add(solid.stroked(style::INK, OUTLINE)));
        let mut dots = Outline::default();
        let positions = midpoints(trace, &scene.truth.axes).map(|midpoint| self.position(midpoint.point_world));
        positions.filter(|position| self.shows(*position)).for_each(|position| dots.dot(position));
        inside = inside.add(dots.dots(style::INK, MIDPOINT));
        // The axis is drawn over the midpoints, which may cover it.
        for axis in &scene.truth.axes {
            let mut line = Outline::default();
            line.polyline(axis.points(AXIS_STEP).into_iter().map(|point| self.position(point)));
            inside = inside.add(axis_style(line));
        }
        for mark in Mark::ALL {
            let mut diamonds = Outline::default();
            let positions = mark_positions(trace).into_iter().filter(|position| position.mark == mark);
            let positions = positions.map(|position| self.position(position.point_world));
            positions.filter(|position| self.shows(*position)).for_each(|position| diamonds.diamond(position, MARK));
            inside = inside.add(mark_style(diamonds, mark));
        }
        let mut touches = Outline::default();
        for tick in trace.ticks.iter().filter(|tick| tick.body_touches && has_position(tick)) {
            touches.cross(self.position(tick.body.position), 4.0);
        }
        inside = inside.add(touches.stroked(style::ALARM, 1.5));
        Group::new()
            .add(Definitions::new().add(ClipPath::new().set("id", "map").add(frame())))
            .add(self.axes())
            .add(inside)
            .add(frame().set("fill", "none").set("stroke", style::GREY))
    }

    /// The left and the right side, and the top and the bottom (px).
    pub(super) fn sides(&self) -> [(f64, f64); 2] {
        [self.x.positions, (self.y.positions.1, self.y.positions.0)]
    }

    pub(super) fn position(&self, point: Point2) -> (f64, f64) {
        (self.x.at(point.x), self.y.at(point.y))
    }

    /// True if a position is on the panel. Tips can be anywhere.
    pub(super) fn shows(&self, (x, y): (f64, f64)) -> bool {
        (self.x.positions.0..=self.x.positions.1).contains(&x) && (self.y.positions.1..=self.y.positions.0).contains(&y)
    }

    /// The exact outline: segments as lines, arcs as arcs.
    pub(super) fn outline(&self, contour: &Contour) -> Outline {
        let mut outline = Outline::default();
        outline.move_to(self.position(contour.point_at(0.0)));
        for piece in contour.pieces() {
            match piece {
                Piece::Segment(segment) => outline.line_to(self.position(segment.end)),
                Piece::Arc(arc) => {
                    let parts = (arc.sweep.abs() / (0.75 * PI)).ceil().max(1.0);
                    for part in iter::successors(Some(1.0), |k| Some(k + 1.0)).take_while(|k| *k <= parts) {
                        let end = self.position(arc.point_at(arc.length() * part / parts));
                        outline.arc_to(self.scale * arc.radius, arc.sweep > 0.0, end);
                    }
                }
            }
        }
        if contour.is_closed() {
            outline.close();
        }
        outline
    }

    /// Sections of a contour, as polylines that are accurate enough for a wide line.
    fn stretches(&self, contour: &Contour, stretches: &[Range<f64>]) -> Outline {
        let mut outline = Outline::default();
        for stretch in stretches {
            let length = stretch.end - stretch.start;
            let steps = (self.scale * length / 3.0).ceil().max(1.0);
            let shares = iter::successors(Some(0.0), |k| Some(k + 1.0)).take_while(|k| *k <= steps);
            outline.polyline(shares.map(|k| self.position(contour.point_at(stretch.start + length * k / steps))));
        }
        outline
    }

    fn platform(&self, rig: &Rig, trace: &Trace) -> Group {
        let ticks = shown_ticks(trace, self.poses_between);
        let mut group = Group::new();
        for (index, tick) in ticks.iter().enumerate() {
            let (body, whiskers) = self.pose(rig, trace, tick);
            group = group.add(pose_style(body, index, ticks.len())).add(whiskers.stroked(style::PLATFORM, 0.8));
        }
        let mut kept: Vec<(f64, f64)> = Vec::new();
        for position in path(trace).map(|point| self.position(point)) {
            // Distances below a pixel are not visible.
            if kept.last().is_none_or(|last| math::hypot(position.0 - last.0, position.1 - last.1) >= 1.0) {
                kept.push(position);
            }
        }
        let mut path = Outline::default();
        path.polyline(kept);
        group.add(path.stroked(style::PLATFORM, 1.0).set("stroke-dasharray", "5 3"))
    }

    /// The outline of the platform and the shafts of its whiskers in a tick. A whisker that the policy does not bind has no known
    /// bend. It is left out, because it would be drawn through objects.
    pub(super) fn pose(&self, rig: &Rig, trace: &Trace, tick: &TickRecord) -> (Outline, Outline) {
        let position = |point| self.position(tick.body.point_to_world(point));
        let bound = rig.whiskers.iter().filter(|whisker| trace.whiskers.contains(&whisker.name));
        let whiskers = bound.fold(Outline::default(), |mut shafts, whisker| {
            let [base, first, second, tip] = shaft_body(whisker, trace, tick).map(position);
            shafts.move_to(base);
            shafts.curve_to(first, second, tip);
            shafts
        });
        let mut body = Outline::default();
        body.polyline(rig.platform.outline_body().map(position));
        body.close();
        (body, whiskers)
    }

    fn axes(&self) -> Group {
        let millimetres = |scale: &Scale| Scale { values: (scale.values.0 * 1e3, scale.values.1 * 1e3), ..*scale };
        let (x, y) = (millimetres(&self.x), millimetres(&self.y));
        let (left, right) = x.positions;
        let (bottom, top) = y.positions;
        let mut group = Group::new();
        for (value, label) in x.ticks((right - left) / 100.0) {
            group = group.add(line((x.at(value), top), (x.at(value), bottom), style::GRID, 1.0)).add(text(
                x.at(value),
                bottom + 17.0,
                Anchor::Middle,
                12.0,
                style::GREY,
                &label,
            ));
        }
        for (value, label) in y.ticks((bottom - top) / 100.0) {
            group = group.add(line((left, y.at(value)), (right, y.at(value)), style::GRID, 1.0)).add(text(
                left - 7.0,
                y.at(value) + 4.0,
                Anchor::End,
                12.0,
                style::GREY,
                &label,
            ));
        }
        group.add(text(0.5 * (left + right), bottom + 36.0, Anchor::Middle, 12.0, style::GREY, "x (mm)")).add(text(
            left - 7.0,
            top - 9.0,
            Anchor::End,
            12.0,
            style::GREY,
            "y (mm)",
        ))
    }
}

/// The outline of the platform at one of `count` poses: filled at the first, bold at the last.
pub(super) fn pose_style(body: Outline, index: usize, count: usize) -> svg::node::element::Path {
    if index == 0 {
        body.stroked(style::PLATFORM, 1.2).set("fill", style::PLATFORM_FILL)
    } else if index + 1 == count {
        body.stroked(style::INK, 2.0)
    } else {
        body.stroked(style::PLATFORM, 0.8).set("stroke-opacity", "0.7")
    }
}

/// The axis of a tunnel.
pub(super) fn axis_style(line: Outline) -> svg::node::element::Path {
    line.stroked(style::AXIS, 1.4).set("stroke-dasharray", "7 4")
}

/// Diamonds for marks: hollow at lost edges, filled at points where contact was found again.
pub(super) fn mark_style(diamonds: Outline, mark: Mark) -> svg::node::element::Path {
    match mark {
        Mark::Lost => diamonds.stroked(style::ALARM, 1.5).set("fill", "#ffffff"),
        Mark::Found => diamonds.stroked(style::INK, 1.5).set("fill", style::INK),
    }
}

/// The path of the platform's centre of mass.
fn path(trace: &Trace) -> impl Iterator<Item = Point2> {
    trace.ticks.iter().filter(|tick| has_position(tick)).map(|tick| tick.body.position)
}

/// The ticks in which the platform is drawn: the first, the last, and so many at equal time intervals between.
fn shown_ticks(trace: &Trace, between: usize) -> Vec<&TickRecord> {
    let ticks: Vec<_> = trace.ticks.iter().filter(|tick| has_position(tick)).collect();
    let Some(last) = ticks.len().checked_sub(1) else { return ticks };
    let count = (between + 1).min(last.max(1));
    let mut chosen: Vec<_> = (0..=count).map(|k| last * k / count).collect();
    chosen.dedup();
    chosen.into_iter().map(|index| ticks[index]).collect()
}

/// Limit of drawn positions (m). A diverged platform would otherwise determine the scale.
const HORIZON: f64 = 1e6;

fn has_position(tick: &TickRecord) -> bool {
    let within = |coordinate: f64| coordinate.abs() <= HORIZON;
    within(tick.body.position.x) && within(tick.body.position.y) && tick.body.heading.is_finite()
}

/// The points that bound the drawing of a rig (world frame).
fn footprint(rig: &Rig, pose: &Pose) -> Vec<Point2> {
    let tips =
        rig.whiskers.iter().map(|whisker| whisker.base_body + whisker.shaft.length * unit(whisker.direction_body));
    rig.platform.outline_body().into_iter().chain(tips).map(|point| pose.point_to_world(point)).collect()
}
