//! Sets of contours.

use super::{BoundingBox, Contour, Nearest, Point2};

/// A non-empty set of contours with common distance queries. Arc lengths continue from one contour to the next.
///
/// ```
/// use vibrissa_world::geometry::{ContourSet, Point2, circle};
/// let disk = |x| circle(Point2::new(x, 0.0), 0.1);
/// let pair = ContourSet::new(vec![disk(0.0)?, disk(1.0)?]).unwrap();
/// assert!((pair.length() - 0.4 * std::f64::consts::PI).abs() < 1e-15);
/// assert!((pair.nearest(Point2::new(0.7, 0.0)).distance - 0.2).abs() < 1e-15);
/// # Ok::<(), vibrissa_world::geometry::ShapeError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ContourSet {
    first: Contour,
    rest: Vec<Contour>,
}

impl ContourSet {
    /// The set of `contours`. `None` if there are none.
    #[must_use]
    pub fn new(contours: impl IntoIterator<Item = Contour>) -> Option<Self> {
        let mut contours = contours.into_iter();
        Some(Self { first: contours.next()?, rest: contours.collect() })
    }

    /// The contours, in the given order.
    pub fn contours(&self) -> impl Iterator<Item = &Contour> {
        std::iter::once(&self.first).chain(&self.rest)
    }

    /// Total length (m).
    #[must_use]
    pub fn length(&self) -> f64 {
        self.rest.iter().fold(self.first.length(), |length, contour| length + contour.length())
    }

    /// The nearest point of all contours. Of several equally near points, always the same is returned.
    #[must_use]
    pub fn nearest(&self, point: Point2) -> Nearest {
        let mut nearest = self.first.nearest(point);
        let mut start = self.first.length();
        for contour in &self.rest {
            // Each contour has a tree of its pieces. The bounding boxes exclude distant contours.
            if contour.bounding_box().distance(point) < nearest.distance {
                let found = contour.nearest(point);
                if found.distance < nearest.distance {
                    nearest = Nearest { arc_length: start + found.arc_length, ..found };
                }
            }
            start += contour.length();
        }
        nearest
    }

    /// Distance (m) of a point from the nearest contour, never negative. Infinite if the point is not finite. It equals
    /// the distance of [`nearest`](Self::nearest) and is faster.
    #[must_use]
    pub fn distance(&self, point: Point2) -> f64 {
        self.contours().fold(f64::INFINITY, |within, contour| contour.distance_within(point, within))
    }

    /// True if a point is at most `distance` (m) away from a contour.
    #[must_use]
    pub fn is_within(&self, distance: f64, point: Point2) -> bool {
        self.contours().any(|contour| contour.is_within(distance, point))
    }

    /// The bounding box of all contours.
    #[must_use]
    pub fn bounding_box(&self) -> BoundingBox {
        self.rest.iter().fold(self.first.bounding_box(), |bounds, contour| bounds.union(&contour.bounding_box()))
    }
}

impl From<Contour> for ContourSet {
    fn from(contour: Contour) -> Self {
        Self { first: contour, rest: Vec::new() }
    }
}
