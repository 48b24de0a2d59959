//! The outlines of all solids of a scene.

use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};
use vibrissa_world::geometry::{BoundingBox, Contour, Point2, Segment, TreePoint, Vector2, tree_point};
use vibrissa_world::scene::{Truth, gap};

/// The distance (m) up to which two lines intersect, because of rounding.
const ROUNDING: f64 = 1e-9;

/// The outlines of all solids, found by their bounding boxes.
pub(super) struct Outlines<'s> {
    contours: Vec<&'s Contour>,
    boxes: RTree<GeomWithData<Rectangle<TreePoint>, usize>>,
}

impl<'s> Outlines<'s> {
    pub(super) fn new(truth: &'s Truth) -> Self {
        let contours: Vec<_> = truth.surfaces.contours().collect();
        let of_contour = |(index, contour): (usize, &&Contour)| {
            let BoundingBox { min, max } = contour.bounding_box();
            GeomWithData::new(Rectangle::from_corners(tree_point(min), tree_point(max)), index)
        };
        Self { boxes: RTree::bulk_load(contours.iter().enumerate().map(of_contour).collect()), contours }
    }

    /// The contours whose bounding boxes meet the box around some points, within the rounding error.
    fn near(&self, points: &[Point2]) -> impl Iterator<Item = &'s Contour> {
        let corner = |infinite: f64| Point2::new(infinite, infinite);
        let min = points.iter().fold(corner(f64::INFINITY), |min, point| min.inf(point));
        let max = points.iter().fold(corner(f64::NEG_INFINITY), |max, point| max.sup(point));
        let margin = Vector2::new(2.0 * ROUNDING, 2.0 * ROUNDING);
        let around = AABB::from_corners(tree_point(min - margin), tree_point(max + margin));
        self.boxes.locate_in_envelope_intersecting(around).filter_map(|of| self.contours.get(of.data).copied())
    }

    /// True if a contour is one of the outlines, and the box around it with a `margin` (m) meets the box of no other outline.
    pub(super) fn is_alone(&self, contour: &Contour, margin: f64) -> bool {
        let (BoundingBox { min, max }, margin) = (contour.bounding_box(), Vector2::new(margin, margin));
        let corners = [min - margin, max + margin];
        let mut near = self.near(&corners);
        near.next().is_some_and(|own| own.pieces() == contour.pieces()) && near.next().is_none()
    }

    pub(super) fn is_outside(&self, point: Point2) -> bool {
        self.near(&[point]).all(|contour| !contour.contains(point))
    }

    /// True if the line between two points does not cross an outline.
    pub(super) fn is_open(&self, start: Point2, end: Point2) -> bool {
        let line = Segment { start, end };
        self.near(&[start, end]).all(|contour| crosses_nothing(contour, &line))
    }

    /// The distance (m) by which a point may move and remain in a solid, or as near to an outline as `radius` (m). Not positive if it is neither.
    pub(super) fn depth(&self, point: Point2, radius: f64) -> f64 {
        let reach = Vector2::new(radius, radius);
        let depth = |contour: &Contour| {
            let distance = contour.distance(point);
            let near = radius - ROUNDING - distance;
            if contour.contains(point) { near.max(distance) } else { near }
        };
        self.near(&[point - reach, point + reach]).map(depth).fold(0.0, f64::max)
    }

    /// The distance (m) of a point from the nearest outline, at most `most` (m). 0 in a solid.
    pub(super) fn clearance(&self, point: Point2, most: f64) -> f64 {
        let reach = Vector2::new(most, most);
        let distance = |contour: &Contour| if contour.contains(point) { 0.0 } else { contour.distance(point) };
        self.near(&[point - reach, point + reach]).map(distance).fold(most, f64::min)
    }

    /// The smallest box around all outlines (world frame).
    pub(super) fn bounding_box(&self) -> BoundingBox {
        let boxes = self.contours.iter().map(|contour| contour.bounding_box());
        boxes
            .reduce(|all, own| all.union(&own))
            .unwrap_or_else(|| BoundingBox::around(Point2::origin(), Point2::origin()))
    }

    /// True if a convex polygon, given counter-clockwise, is clear of all solids.
    pub(super) fn are_clear_of(&self, corners: &[Point2; 4]) -> bool {
        let middle = middle_of(corners);
        let radius = corners.iter().map(|corner| (corner - middle).norm()).fold(0.0, f64::max);
        let inner_radius = inner_radius(corners);
        self.near(corners).all(|contour| {
            let distance = contour.distance(middle);
            if distance > radius {
                return !contour.contains(middle);
            }
            // Most poses in a narrow gap end here: the polygon contains a point of the outline.
            if distance < inner_radius - ROUNDING {
                return false;
            }
            let mut sides = sides(corners).map(|side| crosses_nothing(contour, &side));
            !contour.contains(middle) && sides.all(|clear| clear) && !is_within(corners, contour.point_at(0.0))
        })
    }
}

fn sides(corners: &[Point2; 4]) -> impl Iterator<Item = Segment> + use<> {
    let corners = *corners;
    (0..4).map(move |side| Segment { start: corners[side], end: corners[(side + 1) % 4] })
}

/// The distance (m) of the middle of a convex polygon, given counter-clockwise, from its nearest side.
pub(super) fn inner_radius(corners: &[Point2; 4]) -> f64 {
    let middle = middle_of(corners);
    let from_side = |side: Segment| (side.end - side.start).normalize().perp(&(middle - side.start));
    sides(corners).map(from_side).fold(f64::INFINITY, f64::min)
}

pub(super) fn middle_of(corners: &[Point2; 4]) -> Point2 {
    Point2::from(corners.iter().fold(Vector2::zeros(), |sum, corner| sum + corner.coords / 4.0))
}

fn crosses_nothing(contour: &Contour, line: &Segment) -> bool {
    contour.pieces_near(line).all(|piece| gap(line, piece) > ROUNDING)
}

fn is_within(corners: &[Point2; 4], point: Point2) -> bool {
    (0..4).all(|side| (corners[(side + 1) % 4] - corners[side]).perp(&(point - corners[side])) > 0.0)
}
