//! The base angle as a polynomial in the place of the touch.

use serde::Deserialize;

use super::contact_set::{ContactSet, MOST};
use super::least_squares;
use crate::geometry::Vector2;

/// The order of the polynomial.
const ORDER: usize = 5;
/// Its coefficients.
const COUNT: usize = (ORDER + 1) * (ORDER + 2) / 2;

/// The base angle that a touch by the tip makes, as a polynomial of order five in its place: `z = f(x, y)`, for a bend to the left.
///
/// For a touch by the tip the place says all, since a place has one shape of the shaft. It holds near the places that it was fitted to,
/// which fill a crescent and not their hull.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AngleSurface {
    /// The middle of the places (m, frame of the base), and the distance (m) that is taken for 1.
    pub centre: [f64; 2],
    /// See `centre`.
    pub scale: f64,
    /// Coefficients (rad) of 1, v, v², …, u, u v, …, u⁵ for the place (u, v) from the centre.
    pub coefficients: [f64; COUNT],
    /// Standard deviation of the sets' base angles about it (rad).
    pub spread: f64,
    /// How far from a place it holds (m): halfway from the loneliest set to its neighbour.
    pub reach: f64,
    /// The places (m, frame of the base), but for those that are nearer to another than half of that.
    pub places: Vec<[f64; 2]>,
}

impl AngleSurface {
    /// The polynomial that comes nearest to sets of touches by the tip. `None` if they are too few, or all near one line.
    #[must_use]
    pub fn fit(sets: &[ContactSet]) -> Option<Self> {
        let places: Vec<Vector2> = sets.iter().map(|set| set.contact_base).collect();
        let apart = |a: &Vector2, b: &Vector2| (a - b).norm();
        let from_neighbour = |(index, place): (usize, &Vector2)| {
            let others = places.iter().enumerate().filter(|(other, _)| *other != index);
            others.map(|(_, other)| apart(place, other)).fold(f64::INFINITY, f64::min)
        };
        let reach = 0.5 * places.iter().enumerate().map(from_neighbour).fold(0.0, f64::max);
        let mut kept: Vec<Vector2> = Vec::new();
        for place in &places {
            if kept.iter().all(|other| apart(place, other) >= 0.5 * reach) {
                kept.push(*place);
            }
        }
        let centre = places.iter().sum::<Vector2>() / places.len() as f64;
        let scale = places.iter().map(|place| (place - centre).norm()).fold(0.0, f64::max);
        let places = kept.into_iter().map(Into::into).collect();
        let mut surface = Self { centre: centre.into(), scale, coefficients: [0.0; COUNT], spread: 0.0, reach, places };
        let rows: Vec<_> =
            sets.iter().map(|set| (surface.basis(set.contact_base).map(|term| term[0]), set.base_angle, 1.0)).collect();
        surface.coefficients = least_squares::fit(&rows)?;
        let square = |set: &ContactSet| (surface.at(set.contact_base).0 - set.base_angle).powi(2);
        surface.spread = (sets.iter().map(square).sum::<f64>() / sets.len() as f64).sqrt();
        Some(surface)
    }

    /// The base angle (rad) of a touch at a place (m, frame of the base), and its change with the place (rad/m).
    #[must_use]
    pub fn at(&self, place: Vector2) -> (f64, Vector2) {
        let mut sums = [0.0; 3];
        for (coefficient, term) in self.coefficients.iter().zip(self.basis(place)) {
            for (sum, part) in sums.iter_mut().zip(term) {
                *sum += coefficient * part;
            }
        }
        (sums[0], Vector2::new(sums[1], sums[2]) / self.scale)
    }

    /// Whether it holds at a place (m, frame of the base).
    #[must_use]
    pub fn contains(&self, place: Vector2) -> bool {
        let square = self.reach * self.reach;
        self.places.iter().any(|&known| (place - Vector2::from(known)).norm_squared() <= square)
    }

    /// The terms of the polynomial with their changes by u and v.
    fn basis(&self, place: Vector2) -> [[f64; 3]; COUNT] {
        let [u, v] = <[f64; 2]>::from((place - Vector2::from(self.centre)) / self.scale);
        let powers = |value: f64| {
            let mut powers = [1.0; ORDER + 1];
            for index in 1..=ORDER {
                powers[index] = powers[index - 1] * value;
            }
            powers
        };
        let (us, vs) = (powers(u), powers(v));
        // The change of a power.
        let slope = |powers: &[f64], order: usize| order.checked_sub(1).map_or(0.0, |less| order as f64 * powers[less]);
        let mut terms = [[0.0; 3]; COUNT];
        let orders = (0..=ORDER).flat_map(|i| (0..=ORDER - i).map(move |j| (i, j)));
        for (term, (i, j)) in terms.iter_mut().zip(orders) {
            *term = [us[i] * vs[j], slope(&us, i) * vs[j], us[i] * slope(&vs, j)];
        }
        terms
    }

    /// Whether it is a surface: finite, and near places that are.
    pub(super) fn is_sound(&self) -> bool {
        let numbers = self.coefficients.iter().chain(&self.centre).chain(self.places.iter().flatten());
        let positive = |number: f64| number.is_finite() && number > 0.0;
        numbers.clone().all(|number| number.is_finite())
            && positive(self.scale)
            && positive(self.reach)
            && self.spread.is_finite()
            && self.spread >= 0.0
            && (1..=MOST).contains(&self.places.len())
    }
}
