//! The exception of the package.

use pyo3::PyErr;
use pyo3::create_exception;
use pyo3::exceptions::PyException;

create_exception!(
    vibrissa,
    Error,
    PyException,
    "An input cannot be used, or a run cannot begin. The text is what the program prints."
);

/// The exception with the text of an error.
pub(crate) fn error(cause: impl std::fmt::Display) -> PyErr {
    Error::new_err(cause.to_string())
}
