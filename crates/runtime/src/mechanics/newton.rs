//! Newton's method for two equations.

use nalgebra::{Matrix2, Vector2};

use crate::math;

/// Maximum number of steps.
const STEPS: usize = 25;
/// Relative change of the unknowns at which the iteration has converged, because the next change is about its square.
/// If an unknown has changed its sign and the equations have a kink there, convergence is only linear. The change must
/// then reach the square of this value.
const SETTLED: f64 = 1e-6;

/// The residuals of two equations and their derivatives by the two unknowns, one row per equation.
pub(super) struct Residual {
    /// Residuals.
    pub(super) value: Vector2<f64>,
    /// Their derivatives, one row per equation.
    pub(super) slope: Matrix2<f64>,
}

/// Solves two equations from `guess`. A step changes an unknown by at most `reach` times its magnitude, or `reach` if
/// that is below 1. Where the residual is undefined, the step is halved. `None` if the method does not converge.
pub(super) fn solve(
    guess: Vector2<f64>,
    reach: f64,
    residual: impl Fn(Vector2<f64>) -> Option<Residual>,
) -> Option<Vector2<f64>> {
    let (mut unknowns, mut last) = (guess, Vector2::zeros());
    for _ in 0..STEPS {
        let Some(Residual { value, slope }) = residual(unknowns) else {
            if last == Vector2::zeros() {
                return None;
            }
            last *= 0.5;
            unknowns += last;
            continue;
        };
        let step = slope.lu().solve(&value)?;
        let change = step.component_div(&unknowns.map(|unknown| math::max(unknown.abs(), 1.0))).amax();
        if !change.is_finite() {
            return None;
        }
        last = step * math::min(reach / change, 1.0);
        let before = unknowns;
        unknowns -= last;
        let has_crossed = before.zip_map(&unknowns, |before, now| before.is_sign_negative() != now.is_sign_negative());
        if change < if has_crossed.x || has_crossed.y { SETTLED * SETTLED } else { SETTLED } {
            return Some(unknowns);
        }
    }
    None
}
