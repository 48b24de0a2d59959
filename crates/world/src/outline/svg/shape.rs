//! Shapes: rectangles, ellipses, polygons.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use roxmltree::Node;
use svgtypes::NumberListParser;

use crate::geometry::{EllipticArc, Piece, Point2};

use super::super::transform::Transform;
use super::super::{MAX_PIECES, OutlineFault};
use super::attribute::{length, length_or_zero, unreadable};

/// The outlines of a shape, each as pieces. Empty for a shape without size, which is not drawn.
pub(super) fn read(node: Node<'_, '_>, transform: &Transform) -> Result<Vec<Vec<Piece>>, OutlineFault> {
    let pieces = match node.tag_name().name() {
        "rect" => rectangle(node, transform)?,
        "circle" => {
            let radius = length_or_zero(node, "r")?;
            ellipse(node, transform, [radius, radius])?
        }
        "ellipse" => {
            let (rx, ry) = radii(node)?;
            ellipse(node, transform, [rx, ry])?
        }
        "polygon" => {
            let mut corners = points(node, transform)?;
            corners.extend(corners.first().copied());
            sides(&corners)
        }
        "polyline" => sides(&points(node, transform)?),
        _ => {
            let end = |x, y| transform.point([length_or_zero(node, x)?, length_or_zero(node, y)?]);
            vec![Piece::segment(end("x1", "y1")?, end("x2", "y2")?)]
        }
    };
    Ok(if pieces.is_empty() { Vec::new() } else { vec![pieces] })
}

fn rectangle(node: Node<'_, '_>, transform: &Transform) -> Result<Vec<Piece>, OutlineFault> {
    let (x, y) = (length_or_zero(node, "x")?, length_or_zero(node, "y")?);
    let (width, height) = (length_or_zero(node, "width")?, length_or_zero(node, "height")?);
    if width <= 0.0 || height <= 0.0 {
        return Ok(Vec::new());
    }
    let (rx, ry) = radii(node)?;
    let (rx, ry) = (rx.min(0.5 * width), ry.min(0.5 * height));
    let is_sharp = rx <= 0.0 || ry <= 0.0;
    let (rx, ry) = if is_sharp { (0.0, 0.0) } else { (rx, ry) };
    let (right, bottom) = (x + width, y + height);
    let sides = [
        [[x + rx, y], [right - rx, y]],
        [[right, y + ry], [right, bottom - ry]],
        [[right - rx, bottom], [x + rx, bottom]],
        [[x, bottom - ry], [x, y + ry]],
    ];
    let centres = [[right - rx, y + ry], [right - rx, bottom - ry], [x + rx, bottom - ry], [x + rx, y + ry]];
    let mut pieces = Vec::new();
    for ([from, to], (centre, quarter)) in sides.into_iter().zip(centres.into_iter().zip(-1_i8..)) {
        pieces.push(Piece::segment(transform.point(from)?, transform.point(to)?));
        if !is_sharp {
            pieces.extend(elliptic(transform, centre, [rx, ry], f64::from(quarter) * FRAC_PI_2, FRAC_PI_2)?);
        }
    }
    Ok(pieces)
}

fn ellipse(node: Node<'_, '_>, transform: &Transform, [rx, ry]: [f64; 2]) -> Result<Vec<Piece>, OutlineFault> {
    if rx <= 0.0 || ry <= 0.0 {
        return Ok(Vec::new());
    }
    let centre = [length_or_zero(node, "cx")?, length_or_zero(node, "cy")?];
    // Two halves, so that a distorted circle is joined like any other outline.
    let mut pieces = elliptic(transform, centre, [rx, ry], 0.0, PI)?;
    if let [Piece::Arc(half)] = pieces.as_slice() {
        return Ok(vec![Piece::arc(half.centre, half.radius, half.start_angle, TAU.copysign(half.sweep))]);
    }
    pieces.extend(elliptic(transform, centre, [rx, ry], PI, PI)?);
    Ok(pieces)
}

fn elliptic(
    transform: &Transform,
    centre: [f64; 2],
    [rx, ry]: [f64; 2],
    start_angle: f64,
    sweep: f64,
) -> Result<Vec<Piece>, OutlineFault> {
    // Points outside of the bounding box's corners are not on the ellipse.
    for corner in [[-rx, -ry], [rx, ry]] {
        transform.point([centre[0] + corner[0], centre[1] + corner[1]])?;
    }
    let radii = [transform.direction([rx, 0.0]), transform.direction([0.0, ry])];
    let arc = EllipticArc { centre: transform.point(centre)?, radii, start_angle, sweep };
    arc.pieces().ok_or(OutlineFault::Curve)
}

/// `rx` and `ry`. One of them may represent both.
fn radii(node: Node<'_, '_>) -> Result<(f64, f64), OutlineFault> {
    let (rx, ry) = (length(node, "rx")?, length(node, "ry")?);
    Ok((rx.or(ry).unwrap_or(0.0), ry.or(rx).unwrap_or(0.0)))
}

fn points(node: Node<'_, '_>, transform: &Transform) -> Result<Vec<Point2>, OutlineFault> {
    let text = node.attribute("points").unwrap_or_default();
    let numbers = NumberListParser::from(text).take(2 * MAX_PIECES + 4).collect::<Result<Vec<f64>, _>>();
    let numbers = numbers.map_err(|_| unreadable(node, "points", text))?;
    let (pairs, rest) = numbers.as_chunks();
    if !rest.is_empty() {
        return Err(unreadable(node, "points", text));
    }
    pairs.iter().map(|&pair| transform.point(pair)).collect()
}

fn sides(corners: &[Point2]) -> Vec<Piece> {
    corners.iter().zip(corners.iter().skip(1)).map(|(&start, &end)| Piece::segment(start, end)).collect()
}
