//! Numerical continuation: tracing a solution from a known problem to another one.

use crate::math;

/// Smallest step of the continuation parameter.
const LEAST_STRIDE: f64 = 1e-5;

/// Traces a solution from `start`, at the parameter 0, to the parameter 1. `solve` finds the solution at a parameter
/// from a neighbouring one. The step is halved where that fails.
///
/// # Errors
/// The last solution found, if no solution exists near it.
pub(super) fn continuation<T>(start: T, solve: impl Fn(f64, &T) -> Option<T>) -> Result<T, T> {
    let (mut solution, mut done, mut stride) = (start, 0.0, 1.0_f64);
    while done < 1.0 {
        let next = math::min(done + stride, 1.0);
        if let Some(found) = solve(next, &solution) {
            (solution, done, stride) = (found, next, 2.0 * stride);
        } else if stride > LEAST_STRIDE {
            stride *= 0.5;
        } else {
            return Err(solution);
        }
    }
    Ok(solution)
}
