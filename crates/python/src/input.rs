//! Scenarios, policies and values of parameters that Python gives.

use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};
use vibrissa::built_in::{NAMED_SCENARIOS, POLICIES, SCENARIOS, TextFile};
use vibrissa::diagnostic::Source;
use vibrissa::request::{Input, PolicyInput};
use vibrissa_runtime::machine::ParameterValue;

use crate::error::error;
use crate::machine::Machine;

/// The text of a scenario, a policy or a mismatch. Messages show its name. Paths in the text are relative to the folder of the name.
#[pyclass(frozen, get_all, eq, hash, module = "vibrissa")]
#[derive(PartialEq, Eq, Hash)]
pub(crate) struct Text {
    text: String,
    name: String,
}

#[pymethods]
impl Text {
    #[new]
    #[pyo3(signature = (text, name = "text".to_owned()))]
    fn new(text: String, name: String) -> Self {
        Self { text, name }
    }

    fn __reduce__(slf: &Bound<'_, Self>) -> (Py<PyType>, (String, String)) {
        let Self { text, name } = slf.get();
        (slf.get_type().unbind(), (text.clone(), name.clone()))
    }

    fn __repr__(&self) -> String {
        format!("Text(name={:?})", self.name)
    }
}

impl Text {
    fn source(&self) -> Source {
        Source::new(self.name.as_str(), self.text.as_str())
    }
}

/// A scenario or a mismatch: a text, or a path or the name of a built-in scenario.
#[derive(FromPyObject)]
pub(crate) enum GivenInput<'py> {
    Text(Bound<'py, Text>),
    Path(PathBuf),
}

/// A policy: a text, a machine, or a path or the name of a built-in policy.
#[derive(FromPyObject)]
pub(crate) enum GivenPolicy<'py> {
    Text(Bound<'py, Text>),
    Machine(Bound<'py, Machine>),
    Path(PathBuf),
}

impl<'py> GivenInput<'py> {
    /// What Python gave. A path stays as it is written, because `./disk` is a file and `disk` is a built-in scenario.
    pub(crate) fn to_python(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        match self {
            Self::Text(text) => Ok(text.clone().into_any()),
            Self::Path(path) => Ok(path.as_os_str().into_pyobject(py)?.into_any()),
        }
    }
}

impl<'py> GivenPolicy<'py> {
    /// What Python gave.
    pub(crate) fn to_python(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        match self {
            Self::Text(text) => Ok(text.clone().into_any()),
            Self::Machine(machine) => Ok(machine.clone().into_any()),
            Self::Path(path) => Ok(path.as_os_str().into_pyobject(py)?.into_any()),
        }
    }
}

impl From<GivenInput<'_>> for Input {
    fn from(given: GivenInput<'_>) -> Self {
        match given {
            GivenInput::Text(text) => Self::Text(text.get().source()),
            GivenInput::Path(path) => TextFile::named(NAMED_SCENARIOS, &path).map_or(Self::File(path), Self::BuiltIn),
        }
    }
}

impl From<GivenPolicy<'_>> for PolicyInput {
    fn from(given: GivenPolicy<'_>) -> Self {
        match given {
            GivenPolicy::Text(text) => Self::Text(text.get().source()),
            GivenPolicy::Machine(machine) => Self::Machine(Box::new(machine.get().artifact().clone())),
            GivenPolicy::Path(path) => TextFile::named(POLICIES, &path).map_or(Self::File(path), Self::BuiltIn),
        }
    }
}

/// The names of the scenarios of the bench, in its order.
#[pyfunction]
pub(crate) fn scenarios() -> Vec<&'static str> {
    SCENARIOS.iter().map(TextFile::name).collect()
}

/// The names of the built-in policies.
#[pyfunction]
pub(crate) fn policies() -> Vec<&'static str> {
    POLICIES.iter().map(TextFile::name).collect()
}

/// Values of parameters: a text with a unit, a number, a bool, or the name of a choice.
pub(crate) fn settings(given: Option<&Bound<'_, PyDict>>) -> PyResult<Vec<(String, ParameterValue)>> {
    let setting = |(name, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
        let name: String = name.extract()?;
        let text = match value.extract::<bool>() {
            Ok(truth) => truth.to_string(),
            Err(_) => value.str()?.to_string(),
        };
        match ParameterValue::parse(&text) {
            Ok(value) => Ok((name, value)),
            Err(cause) => Err(error(format_args!("`{name}`: {cause}; {}", cause.hint()))),
        }
    };
    given.into_iter().flatten().map(setting).collect()
}
