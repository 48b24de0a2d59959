//! Newton's method for two equations.

use nalgebra::{Matrix2, Vector2};

/// Steps after which a solution is given up.
const STEPS: usize = 25;
/// The change, relative to 1 or to the unknown, after which a solution has settled: the next would be about its square.
const SETTLED: f64 = 1e-9;

/// What two unknowns leave of two equations, and its derivatives by them, a row for each equation.
pub(super) struct Residual {
    pub(super) value: Vector2<f64>,
    pub(super) slope: Matrix2<f64>,
}

/// Solves two equations from `guess` on, no step changing an unknown by more than `reach` times itself, or `reach` if it is
/// below 1; `None` if the method does not settle.
pub(super) fn solve(
    guess: Vector2<f64>,
    reach: f64,
    residual: impl Fn(Vector2<f64>) -> Option<Residual>,
) -> Option<Vector2<f64>> {
    let mut unknowns = guess;
    for _ in 0..STEPS {
        let Residual { value, slope } = residual(unknowns)?;
        let step = slope.lu().solve(&value)?;
        let change = step.component_div(&unknowns.map(|unknown| unknown.abs().max(1.0))).amax();
        if !change.is_finite() {
            return None;
        }
        unknowns -= step * (reach / change).min(1.0);
        if change < SETTLED {
            return Some(unknowns);
        }
    }
    None
}
