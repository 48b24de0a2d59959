//! Textures: a small height over an outline that varies along it.

use std::f64::consts::{FRAC_PI_4, SQRT_2, TAU};

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardUniform};
use vibrissa_runtime::math;

use super::fit::biarc;
use super::{Contour, ContourError, Piece, perpendicular};

/// The number of pairs of arcs per shortest wavelength. By the bound in [`fit`](super::fit), arcs are then within 1.2 %
/// of the amplitude of a sine.
const PAIRS_PER_WAVE: f64 = 4.0;
/// The largest number of sines of a random texture.
const SINES: f64 = 24.0;
/// The ratio of the longest and the shortest wavelength of a random texture.
const BAND: f64 = 4.0;
/// The largest ratio of the height and the radius of a bend of the outline.
const MOST_BENT: f64 = 0.25;

/// The height of a surface over its smooth outline, along the outward normal, as a function of the arc length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Texture {
    /// The kind.
    pub kind: TextureKind,
    /// The standard deviation of the height (m).
    pub amplitude: f64,
    /// The shortest wavelength (m). It is rounded up to a whole number of waves round the outline, at
    /// least one.
    pub wavelength: f64,
    /// The seed of phases and wavelengths.
    pub seed: u64,
}

vibrissa_runtime::kinds! {
    /// The kinds of textures.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum TextureKind,
    /// The name in scenarios.
    fn name {
        /// One sine: equal ridges at equal distances.
        Ridges = "ridges",
        /// The sum of up to 24 sines of equal amplitude. Their phases are random, and so are their wavelengths, from the
        /// shortest one to its fourfold. The height has nearly a normal distribution.
        Random = "random",
    }
}

/// The reason why an outline cannot have a texture.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TextureError {
    /// The outline is open and has no outside.
    #[error("an open outline cannot have a texture; close it")]
    Open,
    /// The outline has tight bends.
    #[error(
        "the texture is up to {height} m high, too much for a bend of radius {radius} m; use a smaller amplitude or wider bends"
    )]
    Bend {
        /// The largest height (m).
        height: f64,
        /// The radius of the bend (m).
        radius: f64,
    },
    /// Rough sides meet.
    #[error("with the texture, {0}")]
    Contour(#[from] ContourError),
}

impl Texture {
    /// An upper bound of the number of pieces of `outline` with this texture.
    #[must_use]
    pub(crate) fn most_pieces(&self, outline: &Contour) -> usize {
        outline.pieces().iter().map(|piece| 2 * self.pairs(piece)).fold(0, usize::saturating_add)
    }

    /// The number of pairs of arcs of a piece.
    fn pairs(&self, piece: &Piece) -> usize {
        let waves = PAIRS_PER_WAVE * piece.length() / self.wavelength;
        let turns = piece.length() * piece.curvature().abs() / FRAC_PI_4;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a positive count")]
        let pairs = waves.max(turns).ceil() as usize;
        pairs.max(1)
    }

    /// The sines on a closed outline of this length (m).
    fn sines(&self, length: f64) -> Vec<Sine> {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        let mut uniform = move || -> f64 { StandardUniform.sample(&mut random) };
        let finest = (length / self.wavelength).floor().max(1.0);
        let coarsest = match self.kind {
            TextureKind::Ridges => finest,
            TextureKind::Random => (finest / BAND).ceil(),
        };
        // The numbers of waves are drawn from intervals without common numbers, so that no two sines are the same. The
        // variance of the height is then exactly the sum of theirs.
        let all = finest - coarsest + 1.0;
        let count = all.min(SINES);
        let bound = |index: f64| (index * all / count).floor();
        let amplitude = self.amplitude * SQRT_2 / count.sqrt();
        let sine = |index: f64| {
            let waves = coarsest + bound(index) + (uniform() * (bound(index + 1.0) - bound(index))).floor();
            Sine { amplitude, wave_number: TAU * waves / length, phase: TAU * uniform() }
        };
        std::iter::successors(Some(0.0), |index| Some(index + 1.0))
            .take_while(|index| *index < count)
            .map(sine)
            .collect()
    }
}

/// A sine of the height: its amplitude (m), its wave number (rad/m) and its phase (rad).
#[derive(Debug)]
struct Sine {
    amplitude: f64,
    wave_number: f64,
    phase: f64,
}

impl Contour {
    /// The closed contour with a texture. Its arcs follow the height without additional corners.
    ///
    /// Towards a corner, the height decreases to zero within the shortest wavelength. So the corner keeps its position
    /// and its angle.
    ///
    /// # Errors
    /// [`TextureError`] if the contour is open, a bend is too tight, or rough sides meet.
    pub fn textured(&self, texture: &Texture) -> Result<Self, TextureError> {
        if !self.is_closed() {
            return Err(TextureError::Open);
        }
        let corners = self.corners().iter().map(|corner| corner.arc_length).collect();
        let sines = texture.sines(self.length());
        let height = Height { sines, taper: texture.wavelength, corners, length: self.length() };
        let mut pieces = Vec::with_capacity(texture.most_pieces(self));
        for (piece, &start) in self.pieces.iter().zip(&self.starts) {
            let pairs = texture.pairs(piece);
            let middle = start + 0.5 * piece.length();
            let corners = height.corners_about(middle);
            let place = |index: usize| {
                let along = piece.length() * index as f64 / pairs as f64;
                let (value, slope) = height.at(start + along, corners);
                let tangent = piece.tangent_at(along);
                let outwards = -perpendicular(tangent);
                (value, (piece.point_at(along) + value * outwards, tangent + slope * outwards))
            };
            let places: Vec<_> = (0..=pairs).map(place).collect();
            let highest = places.iter().map(|(value, _)| value.abs()).fold(0.0, f64::max);
            if highest * piece.curvature().abs() > MOST_BENT {
                return Err(TextureError::Bend { height: highest, radius: piece.curvature().abs().recip() });
            }
            pieces.extend(places.windows(2).flat_map(|ends| biarc(ends[0].1, ends[1].1)));
        }
        Ok(Self::closed(pieces)?)
    }
}

/// The height along a contour.
struct Height {
    sines: Vec<Sine>,
    /// The arc length (m) from a corner within which the height increases from zero.
    taper: f64,
    /// The arc lengths (m) of the corners, ascending, and that of the whole contour.
    corners: Vec<f64>,
    length: f64,
}

impl Height {
    /// The arc lengths (m) of the last corner before `s` and of the first one behind it.
    fn corners_about(&self, s: f64) -> [f64; 2] {
        let (Some(first), Some(last)) = (self.corners.first(), self.corners.last()) else {
            return [f64::NEG_INFINITY, f64::INFINITY];
        };
        let next = self.corners.partition_point(|corner| *corner <= s);
        let before = next.checked_sub(1).and_then(|index| self.corners.get(index)).copied();
        let behind = self.corners.get(next).copied();
        [before.unwrap_or(last - self.length), behind.unwrap_or(first + self.length)]
    }

    /// The height (m) at the arc length `s` between two corners, and its derivative.
    fn at(&self, s: f64, [before, behind]: [f64; 2]) -> (f64, f64) {
        let (mut value, mut slope) = (0.0, 0.0);
        for sine in &self.sines {
            let (sin, cos) = math::sin_cos(sine.wave_number * s + sine.phase);
            value += sine.amplitude * sin;
            slope += sine.amplitude * sine.wave_number * cos;
        }
        for (distance, direction) in [(s - before, 1.0), (behind - s, -1.0)] {
            let share = (distance / self.taper).clamp(0.0, 1.0);
            let (weight, change) = (share * share * (3.0 - 2.0 * share), 6.0 * share * (1.0 - share) / self.taper);
            (value, slope) = (value * weight, slope * weight + value * direction * change);
        }
        (value, slope)
    }
}
