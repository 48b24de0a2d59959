//! Newton's method for two equations.

use nalgebra::{Matrix2, Vector2};

/// Steps after which a solution is given up.
const STEPS: usize = 25;
/// The change, relative to 1 or to the unknown, after which a solution has settled: the next would be about its square. Behind a
/// change of an unknown's sign it would be about as great, if the equations have a kink there: then its square has to be reached.
const SETTLED: f64 = 1e-6;

/// What two unknowns leave of two equations, and its derivatives by them, a row for each equation.
pub(super) struct Residual {
    pub(super) value: Vector2<f64>,
    pub(super) slope: Matrix2<f64>,
}

/// Solves two equations from `guess` on, no step changing an unknown by more than `reach` times itself, or `reach` if it is
/// below 1, and half of a step where there is nothing at its end; `None` if the method does not settle.
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
        let change = step.component_div(&unknowns.map(|unknown| unknown.abs().max(1.0))).amax();
        if !change.is_finite() {
            return None;
        }
        last = step * (reach / change).min(1.0);
        let before = unknowns;
        unknowns -= last;
        let has_crossed = before.zip_map(&unknowns, |before, now| before.is_sign_negative() != now.is_sign_negative());
        if change < if has_crossed.x || has_crossed.y { SETTLED * SETTLED } else { SETTLED } {
            return Some(unknowns);
        }
    }
    None
}
