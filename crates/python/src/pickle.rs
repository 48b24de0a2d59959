//! Pickling: how objects pass to other processes.

use std::hash::{DefaultHasher, Hash, Hasher};

use pyo3::PyClass;
use pyo3::prelude::*;
use pyo3::types::{PyTuple, PyType};

/// What `__reduce__` returns: a function, and the arguments with which it makes the object again.
pub(crate) type Reduced<'py> = (Bound<'py, PyAny>, Bound<'py, PyTuple>);

/// Makes an object again by the method `_restore` of its class. Its constructor would not do, because the object has values
/// that no argument gives.
pub(crate) fn restored_from<'py, T: PyClass>(
    object: &Bound<'py, T>,
    arguments: impl IntoPyObject<'py, Target = PyTuple, Output = Bound<'py, PyTuple>, Error = PyErr>,
) -> PyResult<Reduced<'py>> {
    let restore = PyType::new::<T>(object.py()).getattr("_restore")?;
    Ok((restore, arguments.into_pyobject(object.py())?))
}

/// The hash of a value. Equal objects need the same one.
pub(crate) fn hash_of(value: &impl Hash) -> u64 {
    let mut hasher = DefaultHasher::new();
    value.hash(&mut hasher);
    hasher.finish()
}
