//! Strips of the steps of retrievals.

use svg::node::element::{Circle, ClipPath, Definitions, Group, Rectangle};

use super::map::{DOT, MARK, Map, OUTLINE, mark_style};
use crate::report::outline::Outline;
use crate::report::style::{self, Anchor, px, text};
use crate::run::{MarkRecord, TickRecord, Trace};
use crate::score::{Retrieval, retrievals};
use vibrissa_runtime::machine::Mark;
use vibrissa_world::geometry::Point2;
use vibrissa_world::scene::Scene;

/// Width of a picture (px).
const WIDTH: f64 = 1200.0;
/// Frames in a row.
const COLUMNS: usize = 4;
/// Side of a frame (px).
const SIDE: f64 = 282.0;
/// Space between frames, and around all (px).
const GAP: f64 = 14.0;
/// Height of the text under a frame (px).
const CAPTION: f64 = 34.0;
/// Height of the heading of a retrieval (px).
const HEADING: f64 = 34.0;
/// Least number of ticks of a state with a frame.
const LEAST_TICKS: usize = 2;
/// Largest half side of a frame (m). A platform far from the edge would otherwise determine the scale.
const FARTHEST: f64 = 1.0;

/// The steps of all retrievals of a run as a self-contained SVG. `None` without a retrieval.
///
/// Each retrieval is a strip with a frame at the edge point and at the end of each state until the whisker records a tip again, as
/// in figure 4.2 of the baseline's report. A frame shows the exact outlines, the tips that the whisker has recorded until then,
/// platform and whiskers, and the circle around the edge point through the retrieved point.
#[must_use]
pub fn retrieval_picture(scene: &Scene, policy: &str, trace: &Trace) -> Option<String> {
    let retrievals = retrievals(trace);
    let rows = |retrieval: &Retrieval| steps(trace, retrieval).len().div_ceil(COLUMNS);
    let height = |retrieval: &Retrieval| HEADING + rows(retrieval) as f64 * (SIDE + CAPTION);
    let total: f64 = 70.0 + retrievals.iter().map(height).sum::<f64>();
    if retrievals.is_empty() {
        return None;
    }
    let title = format!("{}, policy {policy}: retrievals", scene.name);
    let mut document = style::sheet((WIDTH, total), &title);
    document = document.add(text(GAP, 34.0, Anchor::Start, 20.0, style::INK, &title).set("font-weight", 600));
    let mut top = 50.0;
    for (number, retrieval) in retrievals.iter().enumerate() {
        document = document.add(strip(scene, trace, retrieval, number + 1, top));
        top += height(retrieval);
    }
    Some(document.to_string())
}

/// The ticks of the frames: that of the edge point, and the last one of each state until the whisker records a tip again.
fn steps(trace: &Trace, retrieval: &Retrieval) -> Vec<usize> {
    let end = end_tick(trace, retrieval);
    let mut steps = vec![retrieval.edge_tick];
    let mut since = retrieval.edge_tick;
    for tick in retrieval.edge_tick..=end {
        let state = |tick: usize| trace.ticks.get(tick).and_then(|tick| tick.state);
        let is_last = tick == end || state(tick) != state(tick + 1);
        if is_last && (tick + 1 - since >= LEAST_TICKS || tick == end) && tick > retrieval.edge_tick {
            steps.push(tick);
        }
        if is_last {
            since = tick + 1;
        }
    }
    steps
}

/// The first tick since the retrieved point at which the whisker recorded a tip. Without one before the end of the run or the next
/// mark `lost` of the whisker, it is the tick before that.
fn end_tick(trace: &Trace, retrieval: &Retrieval) -> usize {
    let found = retrieval.found_tick;
    let lost_again =
        |mark: &&MarkRecord| mark.mark == Mark::Lost && mark.whisker == retrieval.whisker && mark.tick > found;
    let limit = trace.marks.iter().find(lost_again).map_or(trace.ticks.len(), |mark| mark.tick);
    let has_tip =
        |&tick: &usize| trace.ticks.get(tick).is_some_and(|tick| tick.whiskers[retrieval.whisker].tip.is_some());
    (found..limit).find(has_tip).unwrap_or_else(|| limit.saturating_sub(1).max(found))
}

fn strip(scene: &Scene, trace: &Trace, retrieval: &Retrieval, number: usize, top: f64) -> Group {
    let whisker = trace.whiskers.get(retrieval.whisker).map_or("", String::as_str);
    let heading = format!(
        "{number}: whisker {whisker}, radius {:.1} mm, distance {:.0} mm, {:.1} s",
        1e3 * retrieval.radius,
        1e3 * retrieval.distance,
        retrieval.time
    );
    let mut group = Group::new().add(text(GAP, top + 20.0, Anchor::Start, 14.0, style::INK, &heading));
    let ticks = steps(trace, retrieval);
    let half = half_side(scene, trace, retrieval, &ticks);
    let start = trace.ticks.get(retrieval.edge_tick).map_or(0.0, |tick| tick.time);
    for (index, &step) in ticks.iter().enumerate() {
        let Some(tick) = trace.ticks.get(step) else { continue };
        let left = GAP + (index % COLUMNS) as f64 * (SIDE + GAP);
        let top = top + HEADING + (index / COLUMNS) as f64 * (SIDE + CAPTION);
        let map = Map::square(retrieval.edge_world, half, (left, top), SIDE);
        group = group.add(frame(&map, scene, trace, retrieval, step, &format!("frame-{number}-{index}"), (left, top)));
        let state = tick.state.and_then(|state| trace.states.get(state)).map_or("Failure", String::as_str);
        let label = if index == 0 { "edge point" } else { state };
        let label = format!("{}. {label}, {:.1} s", index + 1, tick.time - start);
        group = group.add(text(left, top + SIDE + 16.0, Anchor::Start, 12.0, style::INK, &label));
    }
    group
}

/// Half the side of the frames (m): the platform and all tips are within.
fn half_side(scene: &Scene, trace: &Trace, retrieval: &Retrieval, ticks: &[usize]) -> f64 {
    let corners = |tick: &TickRecord| scene.rig.platform.outline_body().map(|point| tick.body.point_to_world(point));
    let corners = ticks.iter().filter_map(|&tick| trace.ticks.get(tick)).flat_map(corners);
    let far = corners.map(|corner| (corner - retrieval.edge_world).amax()).filter(|far| far.is_finite());
    1.05 * far.fold(2.0 * retrieval.radius, f64::max).clamp(1e-3, FARTHEST)
}

fn frame(
    map: &Map,
    scene: &Scene,
    trace: &Trace,
    retrieval: &Retrieval,
    step: usize,
    name: &str,
    (left, top): (f64, f64),
) -> Group {
    let frame = || {
        let corner = Rectangle::new().set("x", px(left)).set("y", px(top));
        corner.set("width", px(SIDE)).set("height", px(SIDE))
    };
    let mut inside = Group::new().set("clip-path", format!("url(#{name})"));
    for solid in &scene.solids {
        inside = inside.add(map.outline(solid.outline()).filled(style::SOLID));
    }
    if let Some(tick) = trace.ticks.get(step) {
        let (body, whiskers) = map.pose(&scene.rig, trace, tick);
        inside = inside.add(body.stroked(style::PLATFORM, 1.2).set("fill", style::PLATFORM_FILL));
        inside = inside.add(whiskers.stroked(style::PLATFORM, 1.0));
    }
    for solid in &scene.solids {
        inside = inside.add(map.outline(solid.outline()).stroked(style::INK, OUTLINE));
    }
    let (x, y) = map.position(retrieval.edge_world);
    let circle = Circle::new().set("cx", px(x)).set("cy", px(y)).set("r", px(map.scale * retrieval.radius));
    inside = inside.add(circle.set("fill", "none").set("stroke", style::AXIS).set("stroke-dasharray", "4 3"));
    let mut dots = Outline::default();
    let tips = trace.ticks.iter().take(step + 1).filter_map(|tick| tick.whiskers.get(retrieval.whisker)?.tip);
    tips.map(|tip| map.position(tip)).filter(|position| map.shows(*position)).for_each(|position| dots.dot(position));
    let colour = style::WHISKERS.get(retrieval.whisker).copied().unwrap_or(style::INK);
    inside = inside.add(dots.dots(colour, 0.6 * DOT));
    let diamond = |point: Point2, mark: Mark| {
        let mut diamond = Outline::default();
        diamond.diamond(map.position(point), 0.5 * MARK);
        mark_style(diamond, mark)
    };
    inside = inside.add(diamond(retrieval.edge_world, Mark::Lost));
    if step >= retrieval.found_tick {
        inside = inside.add(diamond(retrieval.retrieved_world, Mark::Found));
    }
    Group::new()
        .add(Definitions::new().add(ClipPath::new().set("id", name).add(frame())))
        .add(inside)
        .add(frame().set("fill", "none").set("stroke", style::GREY))
}
