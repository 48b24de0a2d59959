//! Closing of chains of pieces.

use crate::geometry::{JOIN_TOLERANCE, MIN_PIECE_LENGTH, Piece};

use super::{OutlineFault, TOLERANCE};

/// Returns the pieces as an exact closed chain. Ends within the tolerance of each other are moved together, and pieces
/// that are too short are omitted.
pub(super) fn close(pieces: Vec<Piece>) -> Result<Vec<Piece>, OutlineFault> {
    let pieces: Vec<Piece> = pieces.into_iter().filter(|piece| piece.length() >= 2.0 * MIN_PIECE_LENGTH).collect();
    // The required end of each piece.
    let starts = pieces.iter().cycle().skip(1).map(Piece::start);
    let mut closed = Vec::with_capacity(pieces.len());
    for (piece, end) in pieces.iter().zip(starts) {
        let gap = (end - piece.end()).norm();
        if gap <= 0.5 * JOIN_TOLERANCE {
            closed.push(*piece);
        } else if gap <= 2.0 * TOLERANCE {
            // Both ends belong together because both are within the tolerance of a third.
            closed.extend(piece.ending_at(end));
        } else {
            return Err(OutlineFault::Open { from: piece.end(), to: end });
        }
    }
    Ok(closed)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use std::f64::consts::PI;

    use proptest::prelude::*;

    use super::*;
    use crate::geometry::{Contour, Point2};

    proptest! {
        #[test]
        fn an_arc_between_its_own_ends_is_itself(
            x in -1.0..1.0_f64, radius in 1e-3..1.0_f64, from in -PI..PI, sweep in -PI..PI,
        ) {
            prop_assume!(sweep.abs() > 1e-2);
            let Piece::Arc(arc) = Piece::arc(Point2::new(x, 0.2), radius, from, sweep) else { unreachable!() };
            let Piece::Arc(again) = Piece::arc_between(arc.start(), arc.end(), sweep) else { unreachable!() };
            prop_assert!((again.centre - arc.centre).norm() + (again.radius - arc.radius).abs() < 1e-11);
            prop_assert!((again.start() - arc.start()).norm() + (again.end() - arc.end()).norm() < 1e-14);
        }

        #[test]
        fn a_small_gap_is_closed_and_nothing_moves_far(gap in -9e-7..9e-7_f64, sweep in 0.1..6.0_f64) {
            let arc = Piece::arc(Point2::origin(), 0.1, 0.0, sweep);
            let shifted = arc.end() + nalgebra::Vector2::new(gap, 0.0);
            let pieces = close(vec![arc, Piece::segment(shifted, arc.start())]).unwrap();
            let contour = Contour::closed(pieces).unwrap();
            for k in 0..=100 {
                let place = arc.point_at(arc.length() * f64::from(k) / 100.0);
                prop_assert!(contour.nearest(place).distance <= 2e-6);
            }
        }
    }

    #[test]
    fn a_wide_gap_is_told_with_its_ends() {
        let side = Piece::segment(Point2::origin(), Point2::new(0.1, 0.0));
        assert_eq!(close(vec![side]), Err(OutlineFault::Open { from: side.end(), to: side.start() }));
    }
}
