//! B-splines.

use nalgebra::Vector3;

use super::fit::fit;
use super::{Bezier, Piece, Point2, Vector2};

/// The largest degree. Drawings have at most 5.
const MAX_DEGREE: usize = 25;

/// The largest relative difference of weights that are equal except for the digits of their file.
const EVEN: f64 = 1e-12;

/// A B-spline curve, with weights (NURBS) or without.
#[derive(Clone, Debug, PartialEq)]
pub struct BSpline {
    degree: usize,
    knots: Vec<f64>,
    /// The control points with their weights: `[w x, w y, w]`.
    control: Vec<Vector3<f64>>,
    has_weights: bool,
}

impl BSpline {
    /// Creates a curve. `weights` is empty for a curve without weights. `None` if the number of knots is not that of the control points (m)
    /// plus the degree plus 1, if the knots descend, if the weights are not positive or not one for each point, or if a number is not
    /// finite.
    ///
    /// ```
    /// use vibrissa_world::geometry::{BSpline, Contour, Point2};
    /// // A quarter of a circle.
    /// let control = [(0.2, 0.0), (0.2, 0.2), (0.0, 0.2)].map(|(x, y)| Point2::new(x, y)).to_vec();
    /// let quarter = BSpline::new(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], control, vec![1.0, 0.5_f64.sqrt(), 1.0]).unwrap();
    /// let quarter = Contour::open(quarter.pieces().unwrap())?;
    /// assert!((quarter.length() - 0.1 * std::f64::consts::PI).abs() < 1e-9);
    /// # Ok::<(), vibrissa_world::geometry::ContourError>(())
    /// ```
    #[must_use]
    pub fn new(degree: usize, knots: Vec<f64>, control: Vec<Point2>, weights: Vec<f64>) -> Option<Self> {
        let count = control.len();
        let is_shaped = (1..=MAX_DEGREE).contains(&degree) && count > degree && knots.len() == count + degree + 1;
        let is_weighted = weights.is_empty()
            || (weights.len() == count && weights.iter().all(|&weight| weight > 0.0 && weight.is_finite()));
        let are_numbers = knots.iter().chain(control.iter().flat_map(|point| point.coords.iter()));
        if !is_shaped || !is_weighted || !knots.is_sorted() || !are_numbers.into_iter().all(|number| number.is_finite())
        {
            return None;
        }
        let first = weights.first().copied().unwrap_or(1.0);
        let has_weights = weights.iter().any(|weight| (weight - first).abs() > EVEN * first);
        let weights = weights.into_iter().chain(std::iter::repeat(1.0));
        let weighted = |(point, weight): (Point2, f64)| {
            let weight = if has_weights { weight } else { 1.0 };
            Vector3::new(weight * point.x, weight * point.y, weight)
        };
        let control = control.into_iter().zip(weights).map(weighted).collect();
        Some(Self { degree, knots, control, has_weights })
    }

    /// Approximates the curve by pieces within a micrometre, from its start to its end. `None` if a part of it has a point without
    /// direction.
    #[must_use]
    pub fn pieces(&self) -> Option<Vec<Piece>> {
        let mut pieces = Vec::new();
        for last in self.degree..self.control.len() {
            if self.knots[last] < self.knots[last + 1] {
                pieces.extend(self.span_pieces(&self.span(last))?);
            }
        }
        Some(pieces)
    }

    /// The control points of the Bézier curve from the knot `last` to the next one. They are the polar forms of the curve
    /// at the two knots.
    fn span(&self, last: usize) -> Vec<Vector3<f64>> {
        let degree = self.degree;
        let ends = [self.knots[last], self.knots[last + 1]];
        let polar = |from_end: usize| {
            let mut points = self.control[last - degree..=last].to_vec();
            for level in 1..=degree {
                let at = ends[usize::from(level > degree - from_end)];
                for index in (level..=degree).rev() {
                    let knot = last - degree + index;
                    let (low, high) = (self.knots[knot], self.knots[knot + degree + 1 - level]);
                    let share = (at - low) / (high - low);
                    points[index] = points[index - 1] * (1.0 - share) + points[index] * share;
                }
            }
            points[degree]
        };
        (0..=degree).map(polar).collect()
    }

    fn span_pieces(&self, control: &[Vector3<f64>]) -> Option<Vec<Piece>> {
        let place = |point: &Vector3<f64>| Point2::new(point.x / point.z, point.y / point.z);
        if let [start, end] = control {
            let (start, end) = (place(start), place(end));
            return Some(if start == end { Vec::new() } else { vec![Piece::segment(start, end)] });
        }
        if !self.has_weights {
            match control {
                [a, b, c] => return Bezier::quadratic(place(a), place(b), place(c)).pieces(),
                [a, b, c, d] => return Bezier { control: [a, b, c, d].map(place) }.pieces(),
                _ => {}
            }
        }
        let start = place(control.first()?);
        if control.iter().all(|point| place(point) == start) {
            return Some(Vec::new());
        }
        let parts = u32::try_from(self.degree).ok()?;
        fit(|share| self.point(control, share), 0.0, 1.0, parts)
    }

    /// The point of a Bézier curve with weights, and its derivative, by repeated interpolation.
    fn point(&self, control: &[Vector3<f64>], share: f64) -> (Point2, Vector2) {
        let mut points = control.to_vec();
        while points.len() > 2 {
            points = points.windows(2).map(|pair| pair[0] * (1.0 - share) + pair[1] * share).collect();
        }
        let (point, slope) =
            (points[0] * (1.0 - share) + points[1] * share, (points[1] - points[0]) * self.degree as f64);
        let place = Point2::new(point.x / point.z, point.y / point.z);
        (place, (slope.xy() - place.coords * slope.z) / point.z)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use proptest::prelude::*;

    use super::*;
    use crate::geometry::Contour;

    /// The point of a spline by the recursive definition of its basis functions.
    fn by_definition(spline: &BSpline, at: f64) -> Point2 {
        fn basis(knots: &[f64], index: usize, degree: usize, at: f64) -> f64 {
            if degree == 0 {
                return f64::from(u8::from(knots[index] <= at && at < knots[index + 1]));
            }
            let share = |low: f64, high: f64, part: f64| if high > low { part / (high - low) } else { 0.0 };
            share(knots[index], knots[index + degree], at - knots[index]) * basis(knots, index, degree - 1, at)
                + share(knots[index + 1], knots[index + degree + 1], knots[index + degree + 1] - at)
                    * basis(knots, index + 1, degree - 1, at)
        }
        let sum = |part: fn(&Vector3<f64>) -> f64| {
            let terms = spline.control.iter().enumerate();
            terms.map(|(index, point)| part(point) * basis(&spline.knots, index, spline.degree, at)).sum::<f64>()
        };
        let weight = sum(|point| point.z);
        Point2::new(sum(|point| point.x) / weight, sum(|point| point.y) / weight)
    }

    fn spline() -> impl Strategy<Value = BSpline> {
        let point = (-0.02..0.02_f64, -0.05..0.05_f64);
        let weights = prop_oneof![Just(Vec::new()), prop::collection::vec(0.3..3.0_f64, 8)];
        (1_usize..6, prop::collection::vec(point, 8), prop::collection::vec(0.05..1.0_f64, 15), weights).prop_map(
            |(degree, points, steps, weights)| {
                // The points proceed to the right, so that the curve does not cross itself.
                let control: Vec<Point2> =
                    (0_u8..).zip(points).map(|(k, (x, y))| Point2::new(0.05 * f64::from(k) + x, y)).collect();
                let mut at = 0.0;
                let knots = steps.iter().take(control.len() + degree + 1).map(|step| {
                    at += step;
                    at
                });
                BSpline::new(degree, knots.collect(), control, weights).unwrap()
            },
        )
    }

    proptest! {
        #[test]
        fn the_pieces_lie_on_the_curve_that_the_basis_functions_define(spline in spline()) {
            let pieces = spline.pieces().unwrap();
            let contour = Contour::open(pieces).unwrap();
            let (from, to) = (spline.knots[spline.degree], spline.knots[spline.control.len()]);
            for k in 0..500 {
                let place = by_definition(&spline, from + (to - from) * f64::from(k) / 500.0);
                prop_assert!(contour.nearest(place).distance < 1.1e-6);
            }
        }
    }

    #[test]
    fn a_spline_with_wrong_numbers_is_none() {
        let points = |count: u8| (0..count).map(|k| Point2::new(f64::from(k), 0.0)).collect::<Vec<_>>();
        let knots = vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
        assert!(BSpline::new(2, knots.clone(), points(3), Vec::new()).is_some());
        assert!(BSpline::new(0, knots.clone(), points(3), Vec::new()).is_none());
        assert!(BSpline::new(2, knots.clone(), points(4), Vec::new()).is_none());
        assert!(BSpline::new(2, knots.clone(), points(3), vec![1.0]).is_none());
        assert!(BSpline::new(2, knots.clone(), points(3), vec![1.0, 0.0, 1.0]).is_none());
        assert!(BSpline::new(2, vec![0.0, 0.0, 0.0, 1.0, 0.5, 1.0], points(3), Vec::new()).is_none());
        assert!(BSpline::new(2, knots, vec![Point2::new(f64::NAN, 0.0); 3], Vec::new()).is_none());
    }
}
