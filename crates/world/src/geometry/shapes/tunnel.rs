//! Tunnels: two walls along a centre line.

use std::f64::consts::TAU;

use vibrissa_runtime::math;

use super::error::{finite, positive};
use super::polar_curve::{PLACES_PER_WAVE, polar_derivatives};
use super::{ShapeError, TunnelAxis};
use crate::geometry::fit::{MIN_PARTS, fit, most_arcs};
use crate::geometry::{Contour, Piece, Point2, Pose, Side, Strip, Vector2, perpendicular, unit};

/// An upper bound of the number of additional pieces per side of a round tunnel's outer wall, for its opening.
const FUNNEL_PIECES: usize = 512;

/// The centre line of a tunnel, in the tunnel's frame, with the rule for the distance of its walls.
#[derive(Clone, Debug, PartialEq)]
pub enum CentreLine {
    /// Straight runs from the frame's origin.
    Polyline {
        /// The length (m) and the heading (rad) of each run.
        runs: Vec<(f64, f64)>,
        /// The positions of the walls' corners.
        corners: Corners,
    },
    /// `y = a sin(k x)` for `x` from 0 to a length. The distance of the walls is perpendicular to the line.
    Sine {
        /// The amplitude `a` (m).
        amplitude: f64,
        /// The wave number `k` (rad/m).
        wave_number: f64,
        /// The end along x (m).
        length: f64,
    },
    /// A closed line around the frame's origin, counter-clockwise: `r = R + a sin(n θ)`. The distance of the walls is
    /// radial. The outer wall has an opening.
    Polar {
        /// The mean radius `R` (m).
        radius: f64,
        /// The amplitude `a` (m).
        amplitude: f64,
        /// The number of waves `n` per turn.
        waves: u32,
        /// The entrance and exit.
        opening: Opening,
    },
}

/// The positions of a tunnel's wall corners. They are always on the mean of the normals of both runs.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Corners {
    /// At the distance of the walls, so that the tunnel is narrower between two corners than at its ends.
    AtDistance,
    /// At the intersection of the parallels of both runs, so that the tunnel has the same width everywhere.
    Mitred,
}

/// An opening in the outer wall of a round tunnel.
///
/// Positions are shares of the length of the complete outer wall's centre line, counted from θ = 0.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Opening {
    /// The beginning.
    pub from: f64,
    /// The end.
    pub to: f64,
    /// The share of the wall on either side that is bent outwards.
    pub funnel_length: f64,
    /// The radial displacement of the two ends (m).
    pub funnel_depth: f64,
}

/// Two walls of constant thickness, and the axis between them, in world coordinates.
#[derive(Clone, Debug)]
pub struct Tunnel {
    /// The axis.
    pub axis: TunnelAxis,
    /// The wall on the left. It is closed in a round tunnel.
    pub left: Strip,
    /// The wall on the right.
    pub right: Strip,
}

impl Tunnel {
    /// A tunnel in the frame of `pose`. The centre lines of its walls are a `width` (m) apart, and its walls have a
    /// `thickness` (m).
    ///
    /// Curves are approximated by arcs within a micrometre. The sides of a wall are exactly parallel.
    ///
    /// ```
    /// use vibrissa_world::geometry::{CentreLine, Corners, Point2, Pose, Side, Tunnel};
    /// let straight = CentreLine::Polyline { runs: vec![(1.0, 0.0)], corners: Corners::Mitred };
    /// let tunnel = Tunnel::new(&straight, 0.22, 0.02, &Pose::default())?;
    /// // The side of a wall that faces the tunnel.
    /// assert!((tunnel.left.side(Side::Right).signed_distance(Point2::new(0.5, 0.0)) - 0.1).abs() < 1e-15);
    /// # Ok::<(), vibrissa_world::geometry::ShapeError>(())
    /// ```
    ///
    /// # Errors
    /// If a number is not finite or not positive where it must be, or the tunnel is too tight for its width.
    pub fn new(line: &CentreLine, width: f64, thickness: f64, pose: &Pose) -> Result<Self, ShapeError> {
        positive("width", width)?;
        positive("thickness", thickness)?;
        line.check()?;
        let wall = |aside: f64, opened: bool| -> Result<Strip, ShapeError> {
            let middle = line.aside(aside, opened)?;
            Ok(Strip::new(&middle.transformed(pose), thickness)?)
        };
        let drawn = line.aside(0.0, false)?.transformed(pose);
        let (left, right) = (wall(-0.5 * width, false)?, wall(0.5 * width, true)?);
        // The axis continues across an opening.
        let whole = if matches!(line, CentreLine::Polar { .. }) { wall(0.5 * width, false)? } else { right.clone() };
        let axis = TunnelAxis::new(drawn, left.side(Side::Right).clone(), whole.side(Side::Left).clone());
        Ok(Self { axis, left, right })
    }
}

impl CentreLine {
    /// An upper bound of the number of pieces of both walls' outlines, for a `width` (m) between their centre lines. It
    /// is a few times too large, and meaningless if the tunnel does not exist.
    #[must_use]
    pub(crate) fn most_pieces(&self, width: f64) -> usize {
        // Two sides and two ends.
        let wall = |pieces: usize| pieces.saturating_mul(2).saturating_add(2);
        match self {
            Self::Polyline { runs, .. } => 2 * wall(runs.len()),
            Self::Sine { amplitude, wave_number, length } => {
                let derivatives = |x: f64| {
                    let (sin, cos) = math::sin_cos(wave_number * x);
                    let slope = amplitude * wave_number;
                    let bend = Vector2::new(0.0, -slope * wave_number * sin);
                    [Vector2::new(1.0, slope * cos), bend, Vector2::new(0.0, -slope * wave_number * wave_number * cos)]
                };
                // A parallel of the line needs as many arcs as the line, because its curvature changes less where it is
                // longer.
                let half_wave = 0.5 * TAU / wave_number.abs();
                let least = 2 * MIN_PARTS as usize;
                let each = most_arcs(derivatives, 0.0, half_wave, PLACES_PER_WAVE) - least;
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "a cast of more gives the greatest"
                )]
                let waves = (length / half_wave).ceil() as usize;
                wall(each.saturating_mul(waves).saturating_add(least)).saturating_mul(2)
            }
            Self::Polar { radius, amplitude, waves, .. } => {
                let ring = |aside: f64| {
                    let derivatives = |angle: f64| {
                        let order = f64::from(*waves);
                        let (sin, cos) = math::sin_cos(order * angle);
                        let [first, second, third] =
                            [order * cos, -math::square(order) * sin, -math::powi(order, 3) * cos];
                        let distance = [
                            radius + aside + amplitude * sin,
                            amplitude * first,
                            amplitude * second,
                            amplitude * third,
                        ];
                        polar_derivatives(angle, distance)
                    };
                    most_arcs(derivatives, 0.0, TAU, PLACES_PER_WAVE.saturating_mul((*waves).max(1)))
                };
                wall(ring(-0.5 * width)).saturating_add(wall(ring(0.5 * width).saturating_add(FUNNEL_PIECES)))
            }
        }
    }

    fn check(&self) -> Result<(), ShapeError> {
        match self {
            Self::Polyline { runs, .. } => runs.iter().try_for_each(|&(length, heading)| {
                positive("length of a run", length)?;
                finite("heading of a run", heading)
            }),
            Self::Sine { amplitude, wave_number, length } => {
                finite("amplitude", *amplitude)?;
                finite("wave number", *wave_number)?;
                positive("length", *length)
            }
            Self::Polar { radius, amplitude, opening: Opening { from, to, funnel_length, funnel_depth }, .. } => {
                positive("radius", *radius)?;
                finite("amplitude", *amplitude)?;
                finite("depth of the funnel", *funnel_depth)?;
                for share in [from, to, funnel_length] {
                    finite("place of the opening", *share)?;
                }
                // The remaining wall is long enough for both funnels.
                let fits = 0.0 <= *from && from < to && *to <= 1.0 && *funnel_length > 0.0;
                let room = from + 1.0 - to - 2.0 * funnel_length;
                if fits && room > 0.0 { Ok(()) } else { Err(ShapeError::Opening) }
            }
        }
    }

    /// The line at a distance (m) to the right of the centre line, with or without the opening of a round tunnel.
    fn aside(&self, aside: f64, opened: bool) -> Result<Contour, ShapeError> {
        match self {
            Self::Polyline { runs, corners } => polyline(runs, *corners, aside),
            Self::Sine { amplitude, wave_number, length } => {
                let curve = |x: f64| {
                    let (sin, cos) = math::sin_cos(wave_number * x);
                    let slope = amplitude * wave_number * cos;
                    let along = Vector2::new(1.0, slope);
                    let bend = -amplitude * wave_number * wave_number * sin / math::powf(1.0 + slope * slope, 1.5);
                    // Beyond the centre of its curvature, a parallel has the opposite direction.
                    let direction = along * (1.0 + aside * bend);
                    (Point2::new(x, amplitude * sin) - aside * perpendicular(along.normalize()), direction)
                };
                let forward = (0..=1000).all(|k| curve(length * f64::from(k) / 1000.0).1.x > 0.0);
                let pieces = fit(curve, 0.0, *length, MIN_PARTS).filter(|_| forward).ok_or(ShapeError::TooTight)?;
                Ok(Contour::open(pieces)?)
            }
            Self::Polar { radius, amplitude, waves, opening } => {
                let ring = Ring { radius: radius + aside, amplitude: *amplitude, waves: f64::from(*waves) };
                let whole = ring.whole()?;
                if opened { ring.opened(&whole, opening) } else { Ok(whole) }
            }
        }
    }
}

fn polyline(runs: &[(f64, f64)], corners: Corners, aside: f64) -> Result<Contour, ShapeError> {
    let right_of = |heading: f64| -perpendicular(unit(heading));
    let mut corner = Point2::origin();
    let mut vertices = Vec::with_capacity(runs.len() + 1);
    for (index, &(length, heading)) in runs.iter().enumerate() {
        let before = if index == 0 { heading } else { runs[index - 1].1 };
        let sum = right_of(before) + right_of(heading);
        let mean = sum.try_normalize(1e-6).ok_or(ShapeError::TooTight)?;
        let distance = match corners {
            Corners::AtDistance => aside,
            Corners::Mitred => aside / mean.dot(&right_of(heading)),
        };
        vertices.push(corner + distance * mean);
        corner += length * unit(heading);
    }
    vertices.extend(runs.last().map(|&(_, heading)| corner + aside * right_of(heading)));
    // A run between two corners may have no length left.
    let forward =
        vertices.windows(2).zip(runs).all(|(ends, &(_, heading))| (ends[1] - ends[0]).dot(&unit(heading)) > 0.0);
    if !forward {
        return Err(ShapeError::TooTight);
    }
    Ok(Contour::open(vertices.windows(2).map(|ends| Piece::segment(ends[0], ends[1])).collect())?)
}

/// `r = R + a sin(n θ)`.
struct Ring {
    radius: f64,
    amplitude: f64,
    waves: f64,
}

impl Ring {
    /// The radius at an angle, and its derivative.
    fn at(&self, angle: f64) -> (f64, f64) {
        let (sin, cos) = math::sin_cos(self.waves * angle);
        (self.radius + self.amplitude * sin, self.amplitude * self.waves * cos)
    }

    fn whole(&self) -> Result<Contour, ShapeError> {
        if self.radius <= self.amplitude.abs() {
            return Err(ShapeError::TooTight);
        }
        let curve = |angle| place(angle, self.at(angle));
        let pieces = fit(curve, 0.0, TAU, MIN_PARTS).ok_or(ShapeError::TooTight)?;
        Ok(Contour::closed(pieces)?)
    }

    /// The ring without its opening, with both ends bent outwards.
    fn opened(&self, whole: &Contour, opening: &Opening) -> Result<Contour, ShapeError> {
        let angle = |share: f64| {
            let point = whole.point_at(share * whole.length());
            math::atan2(point.y, point.x).rem_euclid(TAU)
        };
        // From the end of the opening around to its beginning.
        let start = angle(opening.to);
        let beyond = |share: f64| start + (angle(share.rem_euclid(1.0)) - start).rem_euclid(TAU);
        let (straight, bends) =
            (beyond(opening.to + opening.funnel_length), beyond(opening.from - opening.funnel_length));
        let end = beyond(opening.from);
        let curve = |angle: f64| {
            let (mut radius, mut growth) = self.at(angle);
            for (tip, foot) in [(start, straight), (end, bends)] {
                let share = (angle - foot) / (tip - foot);
                if share > 0.0 {
                    radius += opening.funnel_depth * share * share;
                    growth += 2.0 * opening.funnel_depth * share / (tip - foot);
                }
            }
            place(angle, (radius, growth))
        };
        let mut pieces = Vec::new();
        for (from, to) in [(start, straight), (straight, bends), (bends, end)] {
            pieces.extend(fit(curve, from, to, MIN_PARTS).ok_or(ShapeError::TooTight)?);
        }
        Ok(Contour::open(pieces)?)
    }
}

fn place(angle: f64, (radius, growth): (f64, f64)) -> (Point2, Vector2) {
    let outward = unit(angle);
    (Point2::from(radius * outward), growth * outward + radius * perpendicular(outward))
}
