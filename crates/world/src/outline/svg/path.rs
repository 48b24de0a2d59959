//! Paths.

use roxmltree::Node;
use svgtypes::{PathParser, PathSegment};

use crate::geometry::{Bezier, EllipticArc, Piece, Vector2};

use super::super::transform::Transform;
use super::super::{MAX_PIECES, OutlineFault};
use super::arc::EndpointArc;
use super::attribute::unreadable;

/// The subpaths of a path, each as pieces. Subpaths closed by `Z` return to their start.
pub(super) fn read(node: Node<'_, '_>, transform: &Transform) -> Result<Vec<Vec<Piece>>, OutlineFault> {
    let text = node.attribute("d").unwrap_or_default();
    let mut pen = Pen::new(transform);
    for segment in PathParser::from(text) {
        pen.draw(segment.map_err(|_| unreadable(node, "d", text))?)?;
        if pen.count > MAX_PIECES {
            return Err(OutlineFault::TooLarge { what: "lines and arcs", limit: MAX_PIECES });
        }
    }
    pen.end_subpath();
    Ok(pen.drawn)
}

/// The state of the previous curve that a smooth curve continues.
#[derive(Copy, Clone, PartialEq)]
enum PreviousCurve {
    Cubic,
    Quadratic,
    Other,
}

/// The state of the drawing commands. Positions are in user units.
struct Pen<'p> {
    transform: &'p Transform,
    drawn: Vec<Vec<Piece>>,
    subpath: Vec<Piece>,
    start: Vector2,
    at: Vector2,
    /// The last control point, and the kind of its curve.
    control: Vector2,
    previous: PreviousCurve,
    count: usize,
}

impl<'p> Pen<'p> {
    fn new(transform: &'p Transform) -> Self {
        let [start, at, control] = [Vector2::zeros(); 3];
        Self {
            transform,
            drawn: Vec::new(),
            subpath: Vec::new(),
            start,
            at,
            control,
            previous: PreviousCurve::Other,
            count: 0,
        }
    }

    fn draw(&mut self, segment: PathSegment) -> Result<(), OutlineFault> {
        let from = if segment.is_abs() { Vector2::zeros() } else { self.at };
        let place = |x, y| from + Vector2::new(x, y);
        // The last control point, mirrored about the current point.
        let mirrored = |kind| if self.previous == kind { 2.0 * self.at - self.control } else { self.at };
        match segment {
            PathSegment::MoveTo { x, y, .. } => {
                self.end_subpath();
                (self.start, self.at, self.previous) = (place(x, y), place(x, y), PreviousCurve::Other);
                Ok(())
            }
            PathSegment::LineTo { x, y, .. } => self.line(place(x, y)),
            PathSegment::HorizontalLineTo { x, .. } => self.line(Vector2::new(from.x + x, self.at.y)),
            PathSegment::VerticalLineTo { y, .. } => self.line(Vector2::new(self.at.x, from.y + y)),
            PathSegment::CurveTo { x1, y1, x2, y2, x, y, .. } => self.cubic(place(x1, y1), place(x2, y2), place(x, y)),
            PathSegment::SmoothCurveTo { x2, y2, x, y, .. } => {
                self.cubic(mirrored(PreviousCurve::Cubic), place(x2, y2), place(x, y))
            }
            PathSegment::Quadratic { x1, y1, x, y, .. } => self.quadratic(place(x1, y1), place(x, y)),
            PathSegment::SmoothQuadratic { x, y, .. } => {
                self.quadratic(mirrored(PreviousCurve::Quadratic), place(x, y))
            }
            PathSegment::EllipticalArc { rx, ry, x_axis_rotation, large_arc, sweep, x, y, .. } => {
                let (start, end, rotation) = (self.at, place(x, y), x_axis_rotation.to_radians());
                self.arc(&EndpointArc {
                    start,
                    end,
                    radii: [rx, ry],
                    rotation,
                    is_large: large_arc,
                    is_positive: sweep,
                })
            }
            PathSegment::ClosePath { .. } => {
                self.line(self.start)?;
                self.end_subpath();
                Ok(())
            }
        }
    }

    /// Ends a subpath.
    fn end_subpath(&mut self) {
        if !self.subpath.is_empty() {
            self.drawn.push(std::mem::take(&mut self.subpath));
        }
    }

    fn line(&mut self, end: Vector2) -> Result<(), OutlineFault> {
        let piece = Piece::segment(self.transform.point(self.at.into())?, self.transform.point(end.into())?);
        // Most paths are at their start when they are closed.
        let pieces = if end == self.at { Vec::new() } else { vec![piece] };
        self.append(pieces, end);
        Ok(())
    }

    fn cubic(&mut self, first: Vector2, second: Vector2, end: Vector2) -> Result<(), OutlineFault> {
        let point = |place: Vector2| self.transform.point(place.into());
        let curve = Bezier { control: [point(self.at)?, point(first)?, point(second)?, point(end)?] };
        self.append(curve.pieces().ok_or(OutlineFault::Curve)?, end);
        (self.control, self.previous) = (second, PreviousCurve::Cubic);
        Ok(())
    }

    fn quadratic(&mut self, control: Vector2, end: Vector2) -> Result<(), OutlineFault> {
        let point = |place: Vector2| self.transform.point(place.into());
        let curve = Bezier::quadratic(point(self.at)?, point(control)?, point(end)?);
        self.append(curve.pieces().ok_or(OutlineFault::Curve)?, end);
        (self.control, self.previous) = (control, PreviousCurve::Quadratic);
        Ok(())
    }

    fn arc(&mut self, given: &EndpointArc) -> Result<(), OutlineFault> {
        // An arc with equal end points is not drawn.
        if given.start == given.end {
            return Ok(());
        }
        let Some(arc) = given.to_centre_arc() else { return self.line(given.end) };
        for corner in [arc.centre, given.start, given.end, arc.centre + arc.radii[0], arc.centre + arc.radii[1]] {
            self.transform.point(corner.into())?;
        }
        let radii = arc.radii.map(|radius| self.transform.direction(radius.into()));
        let centre = self.transform.point(arc.centre.into())?;
        let arc = EllipticArc { centre, radii, start_angle: arc.start_angle, sweep: arc.sweep };
        self.append(arc.pieces().ok_or(OutlineFault::Curve)?, given.end);
        Ok(())
    }

    fn append(&mut self, pieces: Vec<Piece>, end: Vector2) {
        self.count += pieces.len();
        self.subpath.extend(pieces);
        (self.at, self.previous) = (end, PreviousCurve::Other);
    }
}
