//! Random outlines that mix convex and concave parts, arcs, slots, teeth and small radii.

use super::feature::{Feature, Tool};
use super::layout::{Aim, FORWARD_FACING, Layout, outline};
use super::outline::fillet;
use super::position::{ahead, beside};
use super::sampler::Sampler;
use vibrissa_declare::catalogue::common::SIDE;
use vibrissa_declare::catalogue::shapes::{
    ASPECT, BASE, CONCAVE_RADIUS, CONVEX_RADIUS, DEPTHS, KINDS, LEANS, PLACES, ROUNDED, SIZE, TEETH, TURN, WIDTHS,
};
use vibrissa_runtime::math;
use vibrissa_world::geometry::{
    Contour, Piece, Point2, Pose, Vector2, circle, perpendicular, rounded_rectangle, unite,
};

/// Least width of a part (share of the length of the base). A feature that leaves a narrower one becomes smaller.
const MIN_NECK: f64 = 0.05;
/// Least width of a gap, and least length of a side (share of the length of the base).
const MIN_GAP: f64 = 0.01;
/// Factor of a feature's size, each time that it does not fit.
const SMALLER: f64 = 0.8;
/// The largest number of these reductions. A feature that is a third as large and does not fit is left out.
const REDUCTIONS: i32 = 5;
/// Distance between the points of an outline (share of the length of the base) by which its size is measured.
const SPACING: f64 = 0.005;

/// Lays out a scene.
pub(super) fn lay(sampler: &mut Sampler<'_>) -> Layout {
    let hand = sampler.side(&SIDE);
    let is_disk = sampler.whole(&BASE) == 1;
    let aspect = sampler.number(&ASPECT);
    let teeth = sampler.whole(&TEETH);
    let features = [0, 1, 2, 3].map(|k| Feature {
        tool: Tool::numbered(sampler.whole(&KINDS[k]), teeth),
        place: sampler.number(&PLACES[k]),
        lean: sampler.number(&LEANS[k]),
        width: sampler.number(&WIDTHS[k]),
        depth: sampler.number(&DEPTHS[k]),
    });
    let (size, turn) = (sampler.number(&SIZE), sampler.number(&TURN));
    let radii = [sampler.number(&CONVEX_RADIUS), sampler.number(&CONCAVE_RADIUS)];
    let rounded = sampler.number(&ROUNDED);
    let base = if is_disk {
        circle(Point2::origin(), 0.5)
    } else {
        rounded_rectangle(Point2::origin(), 1.0, aspect, 0.0, 0.0)
    };
    // Without an outline, the scene has no object and is refused.
    let made = base.ok().map(|base| with_features(&base, &features)).and_then(|(shape, tools)| {
        let shape = fillet(&scaled(&shape, size / diameter(&shape))?, radii, rounded);
        Some((shape.transformed(&Pose { position: Point2::origin(), heading: turn }), tools))
    });
    let base = if is_disk { "a disk" } else { "a rectangle" };
    let about = made.as_ref().map_or_else(String::new, |(shape, tools)| {
        let tools = if tools.is_empty() { String::new() } else { format!(" with {}", tools.join(", ")) };
        format!("{base}{tools}, {} corners", shape.corners().len())
    });
    let placed = made.map(|(shape, _)| {
        let points: Vec<Vector2> = shape.sample(SPACING * size).iter().map(|sample| sample.point.coords).collect();
        let centre = ahead(sampler, hand, &points);
        shape.transformed(&Pose { position: centre, heading: 0.0 })
    });
    Layout {
        about,
        path_length: placed.as_ref().map_or(0.0, Contour::length),
        objects: placed.iter().map(outline).collect(),
        start: beside(hand),
        aim: Aim::Everything,
        rig: FORWARD_FACING,
    }
}

/// The base with all features that fit, and what these are.
fn with_features(base: &Contour, features: &[Feature]) -> (Contour, Vec<&'static str>) {
    let mut shape = base.clone();
    let mut names = Vec::new();
    for feature in features {
        let Some(tool) = &feature.tool else { continue };
        let sizes = (0..=REDUCTIONS).map(|count| math::powi(SMALLER, count));
        let changed = sizes.filter_map(|size| feature.outline(base, size)).find_map(|outline| {
            let found = if tool.adds() {
                unite(&[shape.clone(), outline]).ok()?.into_iter().map(|united| united.outline).collect()
            } else {
                shape.difference(&outline)?
            };
            let [only] = <[Contour; 1]>::try_from(found).ok()?;
            is_sturdy(&only).then_some(only)
        });
        if let Some(changed) = changed {
            shape = changed;
            names.push(tool.name());
        }
    }
    (shape, names)
}

/// True if no part, no gap and no side of an outline is too small.
fn is_sturdy(outline: &Contour) -> bool {
    let is_whole = |distance: f64| outline.offset(distance).is_ok_and(|parallels| parallels.len() == 1);
    // A blade between two features is no neck, because it ends.
    let is_thick = |piece: &Piece| {
        [0.25, 0.5, 0.75].map(|share| share * piece.length()).iter().all(|&s| {
            let inside = piece.point_at(s) + MIN_GAP * perpendicular(piece.tangent_at(s));
            outline.signed_distance(inside) < -0.9 * MIN_GAP
        })
    };
    outline.pieces().iter().all(|piece| piece.length() > MIN_GAP && is_thick(piece))
        && is_whole(-0.5 * MIN_NECK)
        && is_whole(0.5 * MIN_GAP)
}

/// The largest distance between two points of an outline.
fn diameter(outline: &Contour) -> f64 {
    let samples = outline.sample(SPACING).into_iter().map(|sample| sample.point);
    let points: Vec<Point2> = outline.pieces().iter().map(Piece::start).chain(samples).collect();
    let farthest = |from: &Point2| points.iter().map(|to| (to - from).norm_squared()).fold(0.0, f64::max);
    points.iter().map(farthest).fold(0.0, f64::max).sqrt()
}

/// An outline that is larger by a factor.
fn scaled(outline: &Contour, factor: f64) -> Option<Contour> {
    let pieces = outline.pieces().iter().map(|piece| match *piece {
        Piece::Segment(side) => Piece::segment(factor * side.start, factor * side.end),
        Piece::Arc(arc) => Piece::arc(factor * arc.centre, factor * arc.radius, arc.start_angle, arc.sweep),
    });
    Contour::closed(pieces.collect()).ok()
}
