//! A strip of times that shows how a map grew.

use svg::node::element::{ClipPath, Definitions, Group, Rectangle};
use vibrissa_runtime::map::CellSpan;

use super::map::{DOT, Map, OUTLINE};
use super::touched::ground;
use crate::report::outline::Outline;
use crate::report::style::{self, Anchor, px, text};
use crate::run::{RunMap, TickRecord, Trace};
use vibrissa_world::scene::Scene;

/// Width of the picture (px).
const WIDTH: f64 = 1200.0;
/// Number of panels, and of those in a row.
const PANELS: usize = 6;
const COLUMNS: usize = 3;
/// Space between panels, and around all (px).
const GAP: f64 = 14.0;
/// Greatest height of a panel (px).
const MOST_HEIGHT: f64 = 420.0;
/// Height of the text under a panel (px).
const CAPTION: f64 = 30.0;
/// Height of the title (px).
const TITLE: f64 = 56.0;

/// How the map of a run grew, at six times: the free ground, the recorded tips until then, and the platform. A self-contained SVG.
#[must_use]
pub fn growth_picture(scene: &Scene, policy: &str, trace: &Trace, map: &RunMap) -> String {
    let width = (WIDTH - GAP) / COLUMNS as f64 - GAP;
    let panel = |index: usize, height: f64| {
        let left = GAP + (index % COLUMNS) as f64 * (width + GAP);
        let top = TITLE + (index / COLUMNS) as f64 * (height + CAPTION);
        Map::new(scene, trace, (left, top), width, (0.5 * width, MOST_HEIGHT))
    };
    let height = panel(0, 0.0).height;
    let rows = PANELS.div_ceil(COLUMNS) as f64;
    let title = format!("{}, policy {policy}: how the map grew", scene.name);
    let mut document = style::sheet((WIDTH, TITLE + rows * (height + CAPTION) + GAP), &title);
    document = document.add(text(GAP, 34.0, Anchor::Start, 20.0, style::INK, &title).set("font-weight", 600));
    let last: Vec<CellSpan> = map.last.free_spans().collect();
    let end = trace.ticks.len().saturating_sub(1);
    for index in 0..PANELS {
        let wanted = end * (index + 1) / PANELS;
        let nearest = map.stages.iter().min_by_key(|stage| stage.tick.abs_diff(wanted));
        let stage = nearest.filter(|_| index + 1 < PANELS).map_or((end, &last), |stage| (stage.tick, &stage.free));
        document = document.add(drawn(&panel(index, height), scene, trace, stage, map.last.cell_size(), index));
    }
    document.to_string()
}

/// A panel after a tick with this free ground.
fn drawn(
    map: &Map,
    scene: &Scene,
    trace: &Trace,
    (tick, free): (usize, &Vec<CellSpan>),
    cell: f64,
    index: usize,
) -> Group {
    let [(left, right), (top, bottom)] = map.sides();
    let frame = || {
        let corner = Rectangle::new().set("x", px(left)).set("y", px(top));
        corner.set("width", px(right - left)).set("height", px(bottom - top))
    };
    let name = format!("stage-{index}");
    let mut inside = Group::new().set("clip-path", format!("url(#{name})"));
    for solid in &scene.solids {
        inside = inside.add(map.outline(solid.outline()).filled(style::SOLID));
    }
    inside = inside.add(ground(map, free.iter().copied(), cell, style::FREE_GROUND));
    for solid in &scene.solids {
        inside = inside.add(map.outline(solid.outline()).stroked(style::INK, OUTLINE));
    }
    let mut dots = Outline::default();
    let tips = trace.ticks.iter().take(tick + 1).flat_map(TickRecord::tips);
    tips.map(|tip| map.position(tip)).filter(|position| map.shows(*position)).for_each(|position| dots.dot(position));
    inside = inside.add(dots.dots(style::ROUTE, 0.5 * DOT));
    let mut label = String::new();
    if let Some(tick) = trace.ticks.get(tick) {
        let (body, whiskers) = map.pose(&scene.rig, trace, tick);
        inside = inside.add(body.stroked(style::PLATFORM, 1.2).set("fill", style::PLATFORM_FILL));
        inside = inside.add(whiskers.stroked(style::PLATFORM, 1.0));
        label = format!("{:.0} s", tick.time);
    }
    Group::new()
        .add(Definitions::new().add(ClipPath::new().set("id", name).add(frame())))
        .add(inside)
        .add(frame().set("fill", "none").set("stroke", style::GREY))
        .add(text(left, bottom + 17.0, Anchor::Start, 12.0, style::INK, &label))
}
