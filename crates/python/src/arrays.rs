//! Arrays of `numpy`.

use numpy::{AllowTypeChange, Element, PyArray1, PyArrayLikeDyn, PyArrayMethods};
use pyo3::prelude::*;

use crate::error::error;

/// Numbers that Python gives: an array, a list or a number.
pub(crate) type Numbers<'py> = PyArrayLikeDyn<'py, f64, AllowTypeChange>;

/// An array of one dimension.
pub(crate) fn list<T: Element>(py: Python<'_>, values: Vec<T>) -> Bound<'_, PyAny> {
    PyArray1::from_vec(py, values).into_any()
}

/// An array with rows of this width.
pub(crate) fn table<T: Element>(py: Python<'_>, values: Vec<T>, width: usize) -> PyResult<Bound<'_, PyAny>> {
    let rows = values.len().checked_div(width).unwrap_or(0);
    Ok(PyArray1::from_vec(py, values).reshape([rows, width])?.into_any())
}

/// An array with rows of this many vectors.
pub(crate) fn vectors(py: Python<'_>, values: Vec<[f64; 2]>, width: usize) -> PyResult<Bound<'_, PyAny>> {
    let rows = values.len().checked_div(width).unwrap_or(0);
    Ok(PyArray1::from_vec(py, values.concat()).reshape([rows, width, 2])?.into_any())
}

/// The numbers of an array in the order of its rows.
///
/// # Errors
/// There are not exactly `count` of them.
pub(crate) fn numbers(name: &str, given: &Numbers<'_>, count: usize) -> PyResult<Vec<f64>> {
    let numbers: Vec<f64> = given.as_array().iter().copied().collect();
    if numbers.len() == count {
        Ok(numbers)
    } else {
        Err(error(format_args!("`{name}` has {} numbers, and the samples need {count}", numbers.len())))
    }
}
