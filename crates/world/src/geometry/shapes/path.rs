//! Contours as sequences of straights, turns and arcs.

use std::f64::consts::FRAC_PI_2;

use super::ShapeError;
use super::error::{finite, finite_point, positive};
use crate::geometry::{Contour, JOIN_TOLERANCE, MIN_PIECE_LENGTH, Piece, Pose, unit};

/// The distance (m) from its start within which the end of a path counts as a mistake, unless it is within the
/// tolerance of a vertex.
const NEARLY_CLOSED: f64 = 1e-6;

/// A builder for a path of straights, turns on the spot and arcs. [`close`](Self::close) or [`open`](Self::open) return
/// the first error.
///
/// ```
/// use std::f64::consts::{FRAC_PI_2, PI};
/// use vibrissa_world::geometry::{Path, Pose};
/// // A stadium, from the start of its lower side.
/// let stadium = Path::from(Pose::default()).straight(0.3).arc(0.1, PI).straight(0.3).arc(0.1, PI).close()?;
/// assert!((stadium.length() - (0.6 + 0.2 * PI)).abs() < 1e-15);
/// // `close` adds the last side.
/// let square = Path::from(Pose::default())
///     .straight(0.2)
///     .turn(FRAC_PI_2)
///     .straight(0.2)
///     .turn(FRAC_PI_2)
///     .straight(0.2)
///     .close()?;
/// assert!((square.area() - 0.04).abs() < 1e-15);
/// # Ok::<(), vibrissa_world::geometry::ShapeError>(())
/// ```
#[derive(Clone, Debug)]
#[must_use = "a path makes a contour only when it is closed or left open"]
pub struct Path {
    start: Pose,
    end: Pose,
    pieces: Vec<Piece>,
    error: Option<ShapeError>,
}

impl From<Pose> for Path {
    fn from(start: Pose) -> Self {
        let checked =
            finite_point("start", start.position).and_then(|()| finite("heading of the start", start.heading));
        Self { start, end: start, pieces: Vec::new(), error: checked.err() }
    }
}

impl Path {
    /// Appends a straight of this `length` (m).
    pub fn straight(mut self, length: f64) -> Self {
        let end = self.end.position + length * unit(self.end.heading);
        let segment = Piece::segment(self.end.position, end);
        self.check(positive("length of a straight", length));
        let heading = self.end.heading;
        self.push(segment, heading)
    }

    /// Turns on the spot by an `angle` (rad, positive to the left).
    pub fn turn(mut self, angle: f64) -> Self {
        self.check(finite("turn", angle));
        self.end.heading += angle;
        self
    }

    /// Appends an arc with this `radius` (m) that changes the heading by `angle` (rad, positive to the left).
    pub fn arc(mut self, radius: f64, angle: f64) -> Self {
        self.check(positive("radius of an arc", radius).and_then(|()| finite("angle of an arc", angle)));
        let side = angle.signum();
        let centre = self.end.position + radius * unit(self.end.heading + side * FRAC_PI_2);
        let arc = Piece::arc(centre, radius, self.end.heading - side * FRAC_PI_2, angle);
        let heading = self.end.heading + angle;
        self.push(arc, heading)
    }

    /// Returns the closed contour. A path that does not end at its start gets a straight closing side.
    ///
    /// # Errors
    /// If a number of a step is not finite, or not positive where it must be. If the path ends very near its start but
    /// not at it. If the steps are not a contour, because they cross or touch, or because there are none.
    pub fn close(mut self) -> Result<Contour, ShapeError> {
        let gap = (self.start.position - self.end.position).norm();
        if gap > NEARLY_CLOSED {
            self.pieces.push(Piece::segment(self.end.position, self.start.position));
        } else if gap > JOIN_TOLERANCE {
            self.check(Err(ShapeError::NearlyClosed { gap }));
        }
        match self.error {
            Some(error) => Err(error),
            None => Ok(Contour::closed(self.pieces)?),
        }
    }

    /// Returns the open contour.
    ///
    /// # Errors
    /// If a number of a step is not finite, or not positive where it must be. If the steps are not an open contour,
    /// because they cross or touch, return to the start, or because there are none.
    pub fn open(self) -> Result<Contour, ShapeError> {
        match self.error {
            Some(error) => Err(error),
            None => Ok(Contour::open(self.pieces)?),
        }
    }

    fn push(mut self, piece: Piece, heading: f64) -> Self {
        if piece.length() < MIN_PIECE_LENGTH {
            self.check(Err(ShapeError::ShortStep { step: self.pieces.len(), length: piece.length() }));
        }
        self.end = Pose { position: piece.end(), heading };
        self.pieces.push(piece);
        self
    }

    /// Stores the first error.
    fn check(&mut self, checked: Result<(), ShapeError>) {
        if self.error.is_none() {
            self.error = checked.err();
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::geometry::{ContourError, Point2};

    #[test]
    fn the_first_wrong_step_is_told() {
        let path = Path::from(Pose::default()).straight(0.1).arc(-0.2, 1.0).straight(f64::NAN);
        assert_eq!(path.open().err(), Some(ShapeError::NotPositive { what: "radius of an arc", value: -0.2 }));
        let path = Path::from(Pose { heading: f64::NAN, ..Pose::default() }).straight(0.1);
        assert!(matches!(path.open().err(), Some(ShapeError::NotFinite { what: "heading of the start", .. })));
        assert_eq!(Path::from(Pose::default()).close().err(), Some(ContourError::Empty.into()));
        let path = Path::from(Pose::default()).straight(0.1).arc(0.1, 0.0).straight(0.1);
        assert_eq!(path.open().err(), Some(ShapeError::ShortStep { step: 1, length: 0.0 }));
    }

    #[test]
    fn a_path_that_misses_its_start_by_a_hair_is_refused() {
        let half = Path::from(Pose::default()).arc(0.1, PI).straight(1e-8).arc(0.1, PI);
        assert!(matches!(half.close().err(), Some(ShapeError::NearlyClosed { .. })));
    }

    #[test]
    fn a_right_turn_bends_to_the_right() {
        let path = Path::from(Pose::default()).arc(0.5, -0.5 * PI);
        assert!(path.open().is_ok_and(|contour| (contour.point_at(1.0) - Point2::new(0.5, -0.5)).norm() < 1e-15));
    }
}
