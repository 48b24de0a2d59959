//! Elliptic arcs.

use std::f64::consts::TAU;

use vibrissa_runtime::math;

use super::fit::fit;
use super::{Piece, Point2, Vector2, perpendicular};

/// The initial number of parts of a whole ellipse.
const PARTS: f64 = 16.0;

/// The relative tolerance for equal and perpendicular radii of a circle.
const ROUND: f64 = 1e-9;

/// An elliptic arc: `centre + u cos t + v sin t`, with `t` from the start angle over the sweep.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct EllipticArc {
    /// The centre (m).
    pub centre: Point2,
    /// Two conjugate radii `u` and `v` (m), such as the semi-axes. At `centre + u` the direction is `v`, at
    /// `centre + v` it is `−u`. A linear map of the ellipse maps the radii too.
    pub radii: [Vector2; 2],
    /// The start angle (rad).
    pub start_angle: f64,
    /// The sweep angle (rad), at most 2π, negative from `v` to `u`.
    pub sweep: f64,
}

impl EllipticArc {
    /// Approximates the arc by pieces within a micrometre, from its start to its end, without corners. A circular arc
    /// gives one piece. `None` if the ellipse is degenerate, or a number is not finite.
    ///
    /// ```
    /// use std::f64::consts::TAU;
    /// use vibrissa_world::geometry::{Contour, EllipticArc, Point2, Vector2};
    /// let radii = [Vector2::new(0.2, 0.0), Vector2::new(0.0, 0.1)];
    /// let ellipse = EllipticArc { centre: Point2::origin(), radii, start_angle: 0.0, sweep: TAU };
    /// let contour = Contour::closed(ellipse.pieces().unwrap())?;
    /// assert!((contour.area() - 0.01 * TAU).abs() < 1e-6);
    /// # Ok::<(), vibrissa_world::geometry::ContourError>(())
    /// ```
    #[must_use]
    pub fn pieces(&self) -> Option<Vec<Piece>> {
        let [u, v] = self.radii;
        let radius = u.norm();
        let turned = perpendicular(u) * u.perp(&v).signum();
        if (turned - v).norm() <= ROUND * radius {
            let hand = u.perp(&v).signum();
            let start_angle = math::atan2(u.y, u.x) + hand * self.start_angle;
            return Some(vec![Piece::arc(self.centre, radius, start_angle, hand * self.sweep)]);
        }
        let place = |angle: f64| {
            let (sin, cos) = math::sin_cos(angle);
            (self.centre + u * cos + v * sin, (v * cos - u * sin) * self.sweep.signum())
        };
        let parts = (1..=16_u32).find(|&parts| f64::from(parts) >= PARTS * self.sweep.abs() / TAU)?;
        fit(place, self.start_angle, self.start_angle + self.sweep, parts)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use proptest::prelude::*;

    use super::*;
    use crate::geometry::{Contour, unit};

    proptest! {
        #[test]
        fn the_pieces_lie_on_the_ellipse(
            across in 0.01..0.5_f64, along in 0.01..0.5_f64, heading in 0.0..TAU, from in 0.0..TAU, sweep in -6.2..6.2_f64,
        ) {
            prop_assume!(sweep.abs() > 0.01);
            let radii = [along * unit(heading), across * perpendicular(unit(heading))];
            let arc = EllipticArc { centre: Point2::new(0.1, -0.2), radii, start_angle: from, sweep };
            let contour = Contour::open(arc.pieces().unwrap()).unwrap();
            for k in 0..=1000 {
                let (sin, cos) = math::sin_cos(from + sweep * f64::from(k) / 1000.0);
                let place = arc.centre + radii[0] * cos + radii[1] * sin;
                prop_assert!(contour.nearest(place).distance < 1.1e-6);
            }
            prop_assert!(contour.corners().is_empty());
        }
    }

    #[test]
    fn a_round_one_is_an_arc_whichever_way_its_radii_turn() {
        let radii = [Vector2::new(0.0, 0.3), Vector2::new(0.3, 0.0)];
        let arc = EllipticArc { centre: Point2::origin(), radii, start_angle: 0.2, sweep: 1.0 };
        let pieces = arc.pieces().unwrap();
        let place = |t: f64| Point2::new(0.3 * math::sin(t), 0.3 * math::cos(t));
        assert_eq!(pieces.len(), 1);
        assert!((pieces[0].start() - place(0.2)).norm() + (pieces[0].end() - place(1.2)).norm() < 1e-15);
    }

    #[test]
    fn a_flat_one_has_no_arcs() {
        let radii = [Vector2::new(0.3, 0.0), Vector2::new(0.0, 0.0)];
        assert_eq!(EllipticArc { centre: Point2::origin(), radii, start_angle: 0.0, sweep: TAU }.pieces(), None);
    }
}
