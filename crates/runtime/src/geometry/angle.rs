//! Wrapping and differences of angles.

use std::f64::consts::{PI, TAU};

/// Wraps an angle (rad) to (−π, π].
///
/// ```
/// use std::f64::consts::PI;
/// use vibrissa_runtime::geometry::wrap;
/// assert!((wrap(2.5 * PI) - 0.5 * PI).abs() < 1e-15);
/// assert_eq!(wrap(-PI), PI);
/// ```
#[must_use]
pub fn wrap(angle: f64) -> f64 {
    let wrapped = angle - TAU * ((angle - PI) / TAU).ceil();
    // The subtraction rounds, so an angle just above −π can become −π.
    if wrapped <= -PI { wrapped + TAU } else { wrapped }
}

/// The smallest rotation (rad, in (−π, π], counter-clockwise positive) from the direction `from` to the direction `to`.
///
/// ```
/// use vibrissa_runtime::geometry::turn_between;
/// assert!((turn_between(3.0, -3.0) - (std::f64::consts::TAU - 6.0)).abs() < 1e-15);
/// ```
#[must_use]
pub fn turn_between(from: f64, to: f64) -> f64 {
    wrap(to - from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrapped_angle_differs_by_whole_turns_and_lies_in_range() {
        for k in -1000..1000 {
            let angle = f64::from(k) * 0.0371 * PI;
            let turns = (angle - wrap(angle)) / TAU;
            assert!((turns - turns.round()).abs() < 1e-12);
            assert!(wrap(angle) > -PI && wrap(angle) <= PI);
        }
    }

    #[test]
    fn the_rotation_back_is_the_opposite_of_the_rotation_there() {
        assert!((turn_between(0.3, 6.1) + turn_between(6.1, 0.3)).abs() < 1e-15);
    }
}
