//! Combinations of parameters that touches do not determine.

use nalgebra::SymmetricEigen;
use vibrissa_runtime::calibration::{Parameter, TouchFit, tolerances};

/// Standard deviation, in units of the tolerances, above which touches have hardly determined a combination.
const HARDLY: f64 = 0.5;
/// Smallest share of a parameter in a combination that is named.
const NAMED: f64 = 0.3;

/// The combinations of a whisker's parameters that the touches of a fit do not determine, as text. They are
/// eigenvectors of the covariance in units of the tolerances.
#[must_use]
pub fn undetermined(fit: &TouchFit) -> Vec<String> {
    let tolerances = tolerances();
    let known = fit.covariance.fixed_view::<{ Parameter::WHISKER }, { Parameter::WHISKER }>(0, 0);
    let scaled = known.map_with_location(|row, column, value| value / (tolerances[row] * tolerances[column]));
    let SymmetricEigen { eigenvalues, eigenvectors } = scaled.symmetric_eigen();
    let weak = eigenvalues.iter().zip(eigenvectors.column_iter()).filter(|(variance, _)| variance.sqrt() > HARDLY);
    weak.map(|(_, vector)| {
        let parts = Parameter::ALL.iter().zip(vector.iter()).filter(|(_, share)| share.abs() > NAMED);
        let parts: Vec<_> = parts.map(|(parameter, share)| format!("{share:+.1} {}", parameter.name())).collect();
        parts.join(" ")
    })
    .collect()
}
