//! Linear least squares.

use nalgebra::{DMatrix, DVector};

/// Smallest diagonal element of the triangular factor, as a share of the largest, at which the rows determine all
/// coefficients.
const RANK: f64 = 1e-9;

/// Returns the coefficients of `N` basis functions by weighted least squares. Each row has the values of the functions,
/// the value of the sum and the weight. `None` if the rows do not determine all coefficients, for example if there are
/// fewer rows than functions.
pub(super) fn fit<const N: usize>(rows: &[([f64; N], f64, f64)]) -> Option<[f64; N]> {
    if rows.len() < N {
        return None;
    }
    let basis = DMatrix::from_fn(rows.len(), N, |row, column| rows[row].0[column] * rows[row].2.sqrt());
    let mut values = DVector::from_iterator(rows.len(), rows.iter().map(|(_, value, weight)| value * weight.sqrt()));
    if !basis.iter().all(|value| value.is_finite()) {
        return None;
    }
    // The singular values of nalgebra use `hypot` of the platform. The QR decomposition uses only exact functions.
    let factors = basis.col_piv_qr();
    let triangle = factors.r();
    let diagonal = triangle.diagonal();
    if diagonal.min() <= RANK * diagonal.max() {
        return None;
    }
    factors.q_tr_mul(&mut values);
    let mut solution = triangle.solve_upper_triangular(&values.rows(0, N))?;
    factors.p().inv_permute_rows(&mut solution);
    let coefficients = std::array::from_fn(|index| solution[index]);
    coefficients.iter().all(|coefficient| coefficient.is_finite()).then_some(coefficients)
}
