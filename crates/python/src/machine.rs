//! Compiled machines.

use std::path::PathBuf;
use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyType};
use vibrissa::diagnostic::{Colour, terminal};
use vibrissa::request::{self, PolicyInput, PreparedPolicy};
use vibrissa_runtime::machine::Artifact;
use vibrissa_runtime::map::MapSettings;

use crate::control::{Control, Kept};
use crate::error::error;
use crate::input::{GivenPolicy, settings};
use crate::pickle::{Reduced, hash_of, restored_from};
use crate::rig::Rig;

/// A compiled policy.
#[pyclass(frozen, eq, module = "vibrissa")]
#[derive(PartialEq)]
pub(crate) struct Machine {
    artifact: Artifact,
    /// Warnings about probable mistakes in the text of the policy, as the program prints them.
    #[pyo3(get)]
    warnings: String,
}

/// A parameter of a machine. Values are texts with a unit, or names of choices.
#[pyclass(frozen, get_all, eq, hash, module = "vibrissa")]
#[derive(PartialEq, Eq, Hash)]
pub(crate) struct Parameter {
    name: String,
    description: String,
    /// The value of this machine.
    value: String,
    default: String,
    /// Smallest and largest value.
    range: Option<(String, String)>,
    choices: Vec<String>,
}

/// A file or the bytes of a compiled machine.
#[derive(FromPyObject)]
enum GivenMachine {
    Bytes(Vec<u8>),
    Path(PathBuf),
}

/// Compiles a policy.
#[pyfunction]
#[pyo3(signature = (policy, *, set = None))]
pub(crate) fn compile(policy: GivenPolicy<'_>, set: Option<&Bound<'_, PyDict>>) -> PyResult<Machine> {
    let prepared = request::policy(&policy.into(), &settings(set)?).map_err(error)?;
    Ok(Machine { warnings: warnings(&prepared), artifact: prepared.artifact })
}

/// The warnings of a policy, as the program prints them.
pub(crate) fn warnings(prepared: &PreparedPolicy) -> String {
    prepared.text.as_ref().map_or_else(String::new, |text| terminal(text, &prepared.warnings, Colour::Plain))
}

impl Machine {
    pub(crate) fn artifact(&self) -> &Artifact {
        &self.artifact
    }
}

#[pymethods]
impl Machine {
    /// Loads a compiled machine from a file or from its bytes.
    #[classmethod]
    fn load(_class: &Bound<'_, PyType>, source: GivenMachine) -> PyResult<Self> {
        let artifact = match source {
            GivenMachine::Bytes(bytes) => Artifact::from_bytes(&bytes).map_err(error)?,
            GivenMachine::Path(path) => {
                let shown = path.display().to_string();
                let prepared = request::policy(&PolicyInput::File(path), &[]).map_err(error)?;
                if prepared.text.is_some() {
                    return Err(error(format_args!("{shown} is the text of a policy; use `vibrissa.compile`")));
                }
                prepared.artifact
            }
        };
        Ok(Self { artifact, warnings: String::new() })
    }

    /// The bytes of the machine, as `vibrissa compile` writes them.
    fn to_bytes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        Ok(PyBytes::new(py, &self.artifact.to_bytes().map_err(error)?))
    }

    /// The control loop of a rig under this machine, at the start of a run. Without a rig, that of the reference rig. With `map`, it
    /// has a map also if the policy does not use one. With `record`, it keeps its samples for a recording.
    #[pyo3(signature = (rig = None, *, map = false, record = false))]
    fn start(&self, py: Python<'_>, rig: Option<Bound<'_, Rig>>, map: bool, record: bool) -> PyResult<Control> {
        let rig = rig.map_or_else(vibrissa_runtime::rig::Rig::default, |rig| rig.get().0.clone());
        let program = Arc::new(self.artifact.program.clone());
        // Tables of perception may take a while.
        let control = py.detach(|| {
            let control = vibrissa_runtime::control::Control::new(&rig, program)?;
            if map && control.map().is_none() {
                control.with_map(&rig, MapSettings::for_rig(&rig))
            } else {
                Ok(control)
            }
        });
        let control = control.map_err(error)?;
        let kept = record.then(|| Kept { artifact: self.artifact.clone(), rig: rig.clone(), samples: Vec::new() });
        Ok(Control::new(control, rig.whiskers.len(), kept))
    }

    /// Name of the machine.
    #[getter]
    fn name(&self) -> &str {
        &self.artifact.program.name
    }

    /// Names of the whiskers that the machine binds.
    #[getter]
    fn whiskers(&self) -> Vec<&str> {
        self.artifact.program.whiskers.iter().map(String::as_str).collect()
    }

    /// Names of the states.
    #[getter]
    fn states(&self) -> Vec<&str> {
        self.artifact.program.states.iter().map(|state| &*state.name).collect()
    }

    /// The parameters.
    #[getter]
    fn parameters(&self) -> Vec<Parameter> {
        let program = &self.artifact.program;
        let parameter = |(parameter, &value): (&vibrissa_runtime::machine::Parameter, &f64)| Parameter {
            name: parameter.name.clone(),
            description: parameter.description.clone(),
            value: parameter.text(value),
            default: parameter.text(parameter.default),
            range: parameter.range.map(|(low, high)| (parameter.text(low), parameter.text(high))),
            choices: parameter.choices.clone(),
        };
        program.parameters.iter().zip(&program.initial_registers).map(parameter).collect()
    }

    fn __hash__(&self) -> u64 {
        hash_of(&self.name())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let machine = slf.get();
        restored_from(slf, (machine.to_bytes(slf.py())?, &machine.warnings))
    }

    #[classmethod]
    fn _restore(_class: &Bound<'_, PyType>, bytes: &[u8], warnings: String) -> PyResult<Self> {
        Ok(Self { artifact: Artifact::from_bytes(bytes).map_err(error)?, warnings })
    }

    fn __repr__(&self) -> String {
        format!("Machine(name={:?})", self.name())
    }
}

#[pymethods]
impl Parameter {
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let Self { name, description, value, default, range, choices } = slf.get();
        restored_from(slf, (name, description, value, default, range, choices))
    }

    #[classmethod]
    fn _restore(
        _class: &Bound<'_, PyType>,
        name: String,
        description: String,
        value: String,
        default: String,
        range: Option<(String, String)>,
        choices: Vec<String>,
    ) -> Self {
        Self { name, description, value, default, range, choices }
    }

    fn __repr__(&self) -> String {
        format!("Parameter(name={:?}, value={:?})", self.name, self.value)
    }
}
