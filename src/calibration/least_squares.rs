//! Linear least squares.

use nalgebra::{DMatrix, DVector};

/// Singular values below this share of the greatest count as none.
const RANK: f64 = 1e-12;

/// The coefficients of `N` basis functions whose sum comes nearest to the values: `rows` gives the functions' values, the value to be
/// met and the weight of each. `None` with fewer rows than functions.
pub(super) fn fit<const N: usize>(rows: &[([f64; N], f64, f64)]) -> Option<[f64; N]> {
    if rows.len() < N {
        return None;
    }
    let basis = DMatrix::from_fn(rows.len(), N, |row, column| rows[row].0[column] * rows[row].2.sqrt());
    let values = DVector::from_iterator(rows.len(), rows.iter().map(|(_, value, weight)| value * weight.sqrt()));
    let factors = basis.svd(true, true);
    let solution = factors.solve(&values, RANK * factors.singular_values.max()).ok()?;
    let coefficients = std::array::from_fn(|index| solution[index]);
    coefficients.iter().all(|coefficient| coefficient.is_finite()).then_some(coefficients)
}
