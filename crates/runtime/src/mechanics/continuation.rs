//! Following a solution from a known case to the one asked for.

/// The least part of the way that is tried.
const LEAST_STRIDE: f64 = 1e-5;

/// Follows a solution from `start`, at the share 0 of a way, to its end at 1: `solve` finds the one at a share from a
/// neighbouring one. In one go if it can be, else in smaller strides.
///
/// # Errors
/// The last solution on the way, where there is none near behind it.
pub(super) fn continuation<T>(start: T, solve: impl Fn(f64, &T) -> Option<T>) -> Result<T, T> {
    let (mut solution, mut done, mut stride) = (start, 0.0, 1.0_f64);
    while done < 1.0 {
        let next = (done + stride).min(1.0);
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
