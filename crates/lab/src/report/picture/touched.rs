//! The map by touch, as a layer of a picture.

use svg::node::element::Group;
use vibrissa_runtime::map::CellSpan;

use super::map::Map;
use crate::report::outline::Outline;
use crate::report::style;
use crate::run::RunMap;

/// Least height of a drawn row (px). Rows of cells between drawn rows are left out, so that a picture stays small.
const ROW: f64 = 1.5;
/// Width of a route (px).
pub(super) const ROUTE: f64 = 2.0;
/// Half the width of the diamond of a target (px).
pub(super) const TARGET: f64 = 7.0;

/// The free ground, the blocked ground and what the map wanted next at the end of a run.
pub(super) fn layer(panel: &Map, map: &RunMap) -> Group {
    let cell = map.last.cell_size();
    // What was proved free is no longer blocked.
    let mut group = Group::new().add(ground(panel, map.last.blocked_spans(), cell, style::BLOCKED_GROUND)).add(ground(
        panel,
        map.last.free_spans(),
        cell,
        style::FREE_GROUND,
    ));
    let mut route = Outline::default();
    route.polyline(map.last.route().iter().map(|step| panel.position(step.pose.position)));
    group = group.add(route.stroked(style::ROUTE, ROUTE));
    if let Some(target) = map.last.next_target() {
        let mut diamond = Outline::default();
        diamond.diamond(panel.position(target.place), TARGET);
        group = group.add(diamond.stroked(style::ROUTE, ROUTE));
    }
    group
}

/// Cells with the side `cell` (m), row by row, as horizontal lines.
pub(super) fn ground(
    panel: &Map,
    spans: impl Iterator<Item = CellSpan>,
    cell: f64,
    colour: &str,
) -> svg::node::element::Path {
    let height = (ROW / (panel.scale * cell)).ceil().max(1.0) * cell;
    let mut lines = Outline::default();
    // The bottom (m) of the row of cells that is drawn.
    let mut drawn = f64::NEG_INFINITY;
    for CellSpan { low, high } in spans {
        if low.y > drawn + height - 0.5 * cell {
            drawn = low.y;
        }
        if (low.y - drawn).abs() < 0.5 * cell {
            let (from, y) = panel.position(low);
            let y = y - 0.5 * panel.scale * height;
            lines.polyline([(from, y), (panel.position(high).0, y)]);
        }
    }
    // Neighbouring rows overlap a little, so that no seams are seen between them.
    lines.stroked(colour, 1.2 * panel.scale * height)
}
