//! The base angle as a polynomial in the contact position.

use std::f64::consts::{PI, SQRT_2};

use serde::{Deserialize, Serialize};

use super::contact_set::ContactSet;
use super::least_squares;
use crate::geometry::Vector2;
use crate::math;

/// The order of the polynomial.
const ORDER: usize = 5;
/// Number of its coefficients.
const COUNT: usize = (ORDER + 1) * (ORDER + 2) / 2;
/// Distance to another position, as a share of the mesh width, below which a position is omitted.
const APART: f64 = 0.25;

/// The base angle of a tip contact as a polynomial of order five in its position: `z = f(x, y)`, for a bend to the
/// left.
///
/// For a tip contact, each position has one shape of the shaft and so one base angle. The fit is valid between the
/// positions of the contacts. They fill a crescent, so their convex hull is too large. A position is valid if it is in
/// the convex hull of those positions that are within `reach` of it. The positions form a net, and `reach` is the
/// diagonal of its widest mesh. This closes all holes of the net and does not extend beyond it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AngleSurface {
    /// Mean of the positions (m, frame of the base): the origin of the polynomial.
    pub centre: [f64; 2],
    /// Distance (m) that corresponds to 1 in the polynomial.
    pub scale: f64,
    /// Coefficients (rad) of 1, v, v², …, u, u v, …, u⁵ for the position (u, v) relative to the centre.
    pub coefficients: [f64; COUNT],
    /// Standard deviation of the residual base angles (rad).
    #[serde(rename = "spread")]
    pub deviation: f64,
    /// Distance (m) within which a valid position needs measured ones: the diagonal of the widest mesh of their net.
    pub reach: f64,
    /// Positions (m, frame of the base) of the contacts, without those nearer to another one than a quarter of a mesh.
    #[serde(rename = "places")]
    pub positions: Vec<[f64; 2]>,
}

impl AngleSurface {
    /// Fits the polynomial to tip contacts by least squares. `None` if there are too few, or all are near one line.
    #[must_use]
    pub fn fit(sets: &[ContactSet]) -> Option<Self> {
        let positions: Vec<Vector2> = sets.iter().map(|set| set.contact_base).collect();
        let least = APART * widest_mesh(&positions);
        let mut kept: Vec<Vector2> = Vec::new();
        for position in &positions {
            if kept.iter().all(|other| (position - other).norm() >= least) {
                kept.push(*position);
            }
        }
        let reach = SQRT_2 * widest_mesh(&kept);
        let centre = positions.iter().sum::<Vector2>() / positions.len() as f64;
        let scale = positions.iter().map(|position| (position - centre).norm()).fold(0.0, math::max);
        let positions = kept.into_iter().map(Into::into).collect();
        let mut surface =
            Self { centre: centre.into(), scale, coefficients: [0.0; COUNT], deviation: 0.0, reach, positions };
        let rows: Vec<_> =
            sets.iter().map(|set| (surface.basis(set.contact_base).map(|term| term[0]), set.base_angle, 1.0)).collect();
        surface.coefficients = least_squares::fit(&rows)?;
        let square = |set: &ContactSet| math::square(surface.at(set.contact_base).0 - set.base_angle);
        surface.deviation = (sets.iter().map(square).sum::<f64>() / sets.len() as f64).sqrt();
        Some(surface)
    }

    /// The base angle (rad) of a contact at a position (m, frame of the base), and its gradient (rad/m).
    #[must_use]
    pub fn at(&self, position: Vector2) -> (f64, Vector2) {
        let mut sums = [0.0; 3];
        for (coefficient, term) in self.coefficients.iter().zip(self.basis(position)) {
            for (sum, part) in sums.iter_mut().zip(term) {
                *sum += coefficient * part;
            }
        }
        (sums[0], Vector2::new(sums[1], sums[2]) / self.scale)
    }

    /// True if the fit is valid at a position (m, frame of the base): between measured positions, or very near to one.
    #[must_use]
    pub fn contains(&self, position: Vector2) -> bool {
        let (far, near) = (math::square(self.reach), math::square(APART / SQRT_2 * self.reach));
        // The largest angles of other positions to the left and to the right of the first one, seen from the position.
        // Their sum is at least half a rotation if the position is in their convex hull.
        let mut seen: Option<(Vector2, f64, f64)> = None;
        for &known in &self.positions {
            let off = Vector2::from(known) - position;
            let square = off.norm_squared();
            if square <= near {
                return true;
            }
            if square <= far {
                let (first, left, right) = seen.get_or_insert((off, 0.0, 0.0));
                let angle = math::atan2(first.perp(&off), first.dot(&off));
                *left = math::max(*left, angle);
                *right = math::max(*right, -angle);
                if *left + *right >= PI {
                    return true;
                }
            }
        }
        false
    }

    /// The terms of the polynomial with their derivatives by u and v.
    fn basis(&self, position: Vector2) -> [[f64; 3]; COUNT] {
        let [u, v] = <[f64; 2]>::from((position - Vector2::from(self.centre)) / self.scale);
        let powers = |value: f64| {
            let mut powers = [1.0; ORDER + 1];
            for index in 1..=ORDER {
                powers[index] = powers[index - 1] * value;
            }
            powers
        };
        let (us, vs) = (powers(u), powers(v));
        // The derivative of a power.
        let slope = |powers: &[f64], order: usize| order.checked_sub(1).map_or(0.0, |less| order as f64 * powers[less]);
        let mut terms = [[0.0; 3]; COUNT];
        let orders = (0..=ORDER).flat_map(|i| (0..=ORDER - i).map(move |j| (i, j)));
        for (term, (i, j)) in terms.iter_mut().zip(orders) {
            *term = [us[i] * vs[j], slope(&us, i) * vs[j], us[i] * slope(&vs, j)];
        }
        terms
    }

    /// True if all numbers are finite and in their valid ranges.
    pub(super) fn is_sound(&self) -> bool {
        let numbers = self.coefficients.iter().chain(&self.centre).chain(self.positions.iter().flatten());
        let positive = |number: f64| number.is_finite() && number > 0.0;
        numbers.clone().all(|number| number.is_finite())
            && positive(self.scale)
            && positive(self.reach)
            && self.deviation.is_finite()
            && self.deviation >= 0.0
            && (1..=ContactSet::MOST).contains(&self.positions.len())
    }
}

/// The longest edge of the minimum spanning tree of the positions (Prim, Bell System Technical Journal 36 (1957),
/// 1389).
fn widest_mesh(positions: &[Vector2]) -> f64 {
    let mut outside: Vec<(Vector2, f64)> = positions.iter().map(|position| (*position, f64::INFINITY)).collect();
    let (mut newest, mut widest) = (outside.pop().map(|(position, _)| position), 0.0_f64);
    while let Some(position) = newest {
        let mut nearest = (0, f64::INFINITY);
        for (index, (other, step)) in outside.iter_mut().enumerate() {
            *step = math::min(*step, (*other - position).norm());
            if *step < nearest.1 {
                nearest = (index, *step);
            }
        }
        newest = (!outside.is_empty()).then(|| outside.swap_remove(nearest.0).0);
        if newest.is_some() {
            widest = math::max(widest, nearest.1);
        }
    }
    widest
}
