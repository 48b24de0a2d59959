//! An extrapolation method for smooth initial value problems, nearly to machine precision.

use crate::math;

/// Substeps of the columns. The midpoint rule with each of these is extrapolated to the substep zero (Gragg, Bulirsch
/// and Stoer).
const SUBSTEPS: [u32; 7] = [2, 4, 6, 8, 10, 12, 14];
/// Error tolerance of a step, relative to 1 or to the value if that is greater.
const TOLERANCE: f64 = 1e-13;
/// Largest step, so that a callback that checks the states between steps misses little.
const GREATEST_STEP: f64 = 0.25;
/// Maximum number of steps.
const MOST_STEPS: usize = 400;

/// Integrates `state' = slope(t, state)` from `t = 0` to 1 in adaptive steps of order 14, and calls `look` with the
/// state after each step. `None` if that takes too many steps, as for a problem that is not smooth or not finite.
pub(super) fn integrate<const N: usize>(
    mut state: [f64; N],
    slope: impl Fn(f64, &[f64; N]) -> [f64; N],
    mut look: impl FnMut(&[f64; N]),
) -> Option<[f64; N]> {
    let (mut t, mut step) = (0.0, GREATEST_STEP);
    for _ in 0..MOST_STEPS {
        let is_last = t + step >= 1.0;
        let now = if is_last { 1.0 - t } else { step };
        let (next, error) = extrapolated(t, &state, now, &slope);
        if error <= TOLERANCE {
            state = next;
            look(&state);
            if is_last {
                return Some(state);
            }
            t += now;
        }
        let order = (2 * SUBSTEPS.len() - 1) as f64;
        let factor = 0.8 * math::powf(TOLERANCE / math::max(error, 1e-20), order.recip());
        step = math::min(now * factor.clamp(0.1, 4.0), GREATEST_STEP);
    }
    None
}

/// One step from `t`, and its error estimate.
fn extrapolated<const N: usize>(
    t: f64,
    state: &[f64; N],
    step: f64,
    slope: &impl Fn(f64, &[f64; N]) -> [f64; N],
) -> ([f64; N], f64) {
    let first_slope = slope(t, state);
    // The newest row of the Aitken-Neville tableau, from the rule itself to the highest order.
    let mut row = [[0.0; N]; SUBSTEPS.len()];
    for (index, &substeps) in SUBSTEPS.iter().enumerate() {
        let mut better = midpoint(t, state, &first_slope, step, substeps, slope);
        for (order, older) in row.iter_mut().take(index).enumerate() {
            let ratio = f64::from(substeps) / f64::from(SUBSTEPS[index - order - 1]);
            let share = (ratio * ratio - 1.0).recip();
            let best = std::array::from_fn(|i| better[i] + share * (better[i] - older[i]));
            *older = better;
            better = best;
        }
        row[index] = better;
    }
    let [.., before, best] = &row;
    let error = best.iter().zip(before).fold(0.0, |worst: f64, (best, before)| {
        let off = (best - before).abs() / math::max(best.abs(), 1.0);
        if off.is_nan() { f64::INFINITY } else { math::max(worst, off) }
    });
    (*best, error)
}

/// The midpoint rule with an even number of substeps. Its error has only even powers of the substep.
fn midpoint<const N: usize>(
    t: f64,
    state: &[f64; N],
    first_slope: &[f64; N],
    step: f64,
    substeps: u32,
    slope: &impl Fn(f64, &[f64; N]) -> [f64; N],
) -> [f64; N] {
    let substep = step / f64::from(substeps);
    let (mut before, mut here) = (*state, std::array::from_fn(|i| state[i] + substep * first_slope[i]));
    for index in 1..substeps {
        let slopes = slope(t + f64::from(index) * substep, &here);
        let next = std::array::from_fn(|i| before[i] + 2.0 * substep * slopes[i]);
        (before, here) = (here, next);
    }
    here
}
