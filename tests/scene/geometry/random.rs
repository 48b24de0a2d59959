//! Random contours and points.

use std::f64::consts::{PI, TAU};

use proptest::prelude::*;
use vibrissa::geometry::{
    Contour, Piece, Point2, Pose, Vector2, circle, polygon, regular_polygon, rounded_rectangle, unit,
};

/// Poses within a metre of the origin, turned anywhere.
pub(crate) fn pose() -> impl Strategy<Value = Pose> {
    (point(1.0), -PI..PI).prop_map(|(position, heading)| Pose { position, heading })
}

/// Points with coordinates up to `reach` (m).
pub(crate) fn point(reach: f64) -> impl Strategy<Value = Point2> {
    (-reach..reach, -reach..reach).prop_map(|(x, y)| Point2::new(x, y))
}

/// The corners of a star-shaped polygon about the origin, from spikes to nearly a disk.
pub(crate) fn star() -> impl Strategy<Value = Vec<Point2>> {
    (3_usize..40, 0.02..0.4_f64).prop_flat_map(|(corners, smallest)| {
        prop::collection::vec((0.1..0.9_f64, smallest..0.5), corners).prop_map(move |spokes| {
            let step = TAU / corners as f64;
            let corner =
                |(k, &(share, radius)): (usize, &(f64, f64))| Point2::from(unit(step * (k as f64 + share)) * radius);
            spokes.iter().enumerate().map(corner).collect()
        })
    })
}

/// A polygon with some of its corners rounded.
fn filleted() -> impl Strategy<Value = Contour> {
    (star(), prop::collection::vec(prop_oneof![Just(0.0), 0.01..0.48_f64], 40))
        .prop_filter_map("rounding made it meet itself", |(corners, shares)| {
            Contour::closed(fillet(&corners, &shares)).ok()
        })
}

/// Rounds the corners of a polygon by arcs that touch the sides at a share of the shorter one.
fn fillet(corners: &[Point2], shares: &[f64]) -> Vec<Piece> {
    let sides = corners.len();
    let mut pieces = Vec::new();
    let mut arcs: Vec<(Point2, Point2, Option<Piece>)> = Vec::new();
    for k in 0..sides {
        let corner = corners[k];
        let back: Vector2 = corners[(k + sides - 1) % sides] - corner;
        let on: Vector2 = corners[(k + 1) % sides] - corner;
        let turn = (-back).perp(&on).atan2((-back).dot(&on));
        let reach = shares[k] * back.norm().min(on.norm());
        let radius = reach / (0.5 * turn.abs()).tan();
        if reach == 0.0 || turn.abs() < 1e-3 || radius * turn.abs() < 1e-6 {
            arcs.push((corner, corner, None));
            continue;
        }
        let (start, end) = (corner + back.normalize() * reach, corner + on.normalize() * reach);
        let ahead = (-back).normalize();
        let left = Vector2::new(-ahead.y, ahead.x);
        let centre = start + left * radius * turn.signum();
        let outward = start - centre;
        arcs.push((start, end, Some(Piece::arc(centre, radius, outward.y.atan2(outward.x), turn))));
    }
    for k in 0..sides {
        pieces.extend(arcs[k].2);
        pieces.push(Piece::segment(arcs[k].1, arcs[(k + 1) % sides].0));
    }
    pieces
}

/// A polygon whose sides bulge in or out by arcs.
fn bulged() -> impl Strategy<Value = Contour> {
    (star(), prop::collection::vec(prop_oneof![Just(0.0), -1.5..1.5_f64], 40)).prop_filter_map(
        "bulging made it meet itself",
        |(corners, bulges)| {
            let side = |k: usize| {
                let (start, end) = (corners[k], corners[(k + 1) % corners.len()]);
                let half_sweep = bulges[k];
                // Flatter arcs have their centres so far away that rounding shows.
                if half_sweep.abs() < 0.02 {
                    return Piece::segment(start, end);
                }
                let chord: Vector2 = end - start;
                let left = Vector2::new(-chord.y, chord.x);
                let centre = nalgebra::center(&start, &end) + left * (0.5 / half_sweep.tan());
                let outward = start - centre;
                Piece::arc(centre, outward.norm(), outward.y.atan2(outward.x), 2.0 * half_sweep)
            };
            Contour::closed((0..corners.len()).map(side).collect()).ok()
        },
    )
}

/// Two lobes with a reflex cusp of 180° between them.
fn heart() -> impl Strategy<Value = Contour> {
    (0.05..0.2_f64).prop_map(|r| {
        Contour::closed(vec![
            Piece::arc(Point2::new(r, 0.0), r, 0.0, PI),
            Piece::arc(Point2::new(-r, 0.0), r, 0.0, PI),
            Piece::arc(Point2::origin(), 2.0 * r, PI, PI),
        ])
        .unwrap()
    })
}

/// Three half circles with three convex cusps of 180°.
fn arbelos() -> impl Strategy<Value = Contour> {
    (0.05..0.2_f64, 0.2..0.8_f64).prop_map(|(r, share)| {
        let (left, right) = (r * share, r * (1.0 - share));
        Contour::closed(vec![
            Piece::arc(Point2::origin(), r, 0.0, PI),
            Piece::arc(Point2::new(-r + left, 0.0), left, PI, -PI),
            Piece::arc(Point2::new(r - right, 0.0), right, PI, -PI),
        ])
        .unwrap()
    })
}

/// Circles, rounded rectangles and regular polygons.
fn convex_shape() -> impl Strategy<Value = Contour> {
    prop_oneof![
        (0.001..0.5_f64).prop_map(|radius| circle(Point2::origin(), radius).unwrap()),
        (0.01..0.5_f64, 0.01..0.5_f64, prop_oneof![Just(0.0), 0.01..0.99_f64, Just(1.0)]).prop_map(|(w, h, share)| {
            rounded_rectangle(Point2::origin(), w, h, 0.5 * share * w.min(h), 0.0).unwrap()
        }),
        (0.01..0.5_f64, 3_usize..20).prop_map(|(r, n)| regular_polygon(Point2::origin(), r, n, 0.0).unwrap()),
    ]
}

/// Convex contours, anywhere within a metre or so of the origin.
pub(crate) fn convex() -> impl Strategy<Value = Contour> {
    (convex_shape(), pose()).prop_map(|(shape, pose)| shape.transformed(&pose))
}

/// Closed contours of all kinds, anywhere within a metre or so of the origin.
pub(crate) fn closed() -> impl Strategy<Value = Contour> {
    let shape = prop_oneof![
        3 => convex_shape(),
        1 => star().prop_map(|corners| polygon(&corners).unwrap()),
        1 => filleted(),
        1 => bulged(),
        1 => heart(),
        1 => arbelos(),
    ];
    (shape, pose()).prop_map(|(shape, pose)| shape.transformed(&pose))
}

/// Open contours: some consecutive pieces of closed ones, one way or the other.
pub(crate) fn open() -> impl Strategy<Value = Contour> {
    (closed(), any::<prop::sample::Index>(), any::<bool>()).prop_filter_map("one piece", |(contour, count, back)| {
        let pieces = contour.pieces();
        let count = 1 + count.index(pieces.len());
        let mut pieces = pieces[..count.min(pieces.len() - 1)].to_vec();
        if back {
            pieces.reverse();
            for piece in &mut pieces {
                *piece = piece.reversed();
            }
        }
        Contour::open(pieces).ok()
    })
}

/// A contour of either kind.
pub(crate) fn any_contour() -> impl Strategy<Value = Contour> {
    prop_oneof![closed(), open()]
}

/// A contour and a point: far, near, or beside a corner.
pub(crate) fn with_point(contour: impl Strategy<Value = Contour>) -> impl Strategy<Value = (Contour, Point2)> {
    let far = (0.0..1.0_f64, point(1.0), Just(1.0_f64));
    let near = (0.0..1.0_f64, point(1.0), 1e-6..0.1_f64);
    let corner = (Just(-1.0), point(1.0), 1e-6..0.1_f64);
    (contour, prop_oneof![far, near, corner], any::<prop::sample::Index>()).prop_map(
        |(contour, (share, offset, scale), index)| {
            let from = if share < 0.0 {
                contour.pieces()[index.index(contour.pieces().len())].start()
            } else {
                contour.point_at(share * contour.length())
            };
            let point = from + offset.coords * scale;
            (contour, point)
        },
    )
}
