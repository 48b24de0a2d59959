//! The rig.

use pyo3::IntoPyObjectExt;
use pyo3::exceptions::PyAttributeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};
use vibrissa::diagnostic::Source;
use vibrissa::physics::Preset;
use vibrissa::request::{self, Input};
use vibrissa::rig::{self, Access, Part, Place, RigKey};

use crate::error::error;
use crate::input::GivenInput;
use crate::pickle::{Reduced, hash_of, restored_from};

/// A platform with whiskers, as control assumes it: that of a scenario, or the reference rig.
#[pyclass(frozen, eq, module = "vibrissa")]
#[derive(PartialEq)]
pub(crate) struct Rig(pub(crate) vibrissa_runtime::rig::Rig);

/// The names of the built-in rigs.
#[pyfunction]
pub(crate) fn rigs() -> Vec<&'static str> {
    Preset::ALL.map(Preset::name).to_vec()
}

/// The name of a key in Python, with its SI unit: `speed_limit_m_s` for `platform.speed_limit`, and
/// `whisker_hinge_stiffness_n_m_rad` for `whiskers.*.hinge.stiffness`. `None` for a key of the simulation, which no rig has.
fn python_name(key: &RigKey) -> Option<String> {
    let name = match key.place {
        Place::Platform(_) | Place::Sensing(_) => key.path.split_once('.')?.1.to_owned(),
        Place::Whisker(_) => format!("whisker_{}", key.path.strip_prefix(rig::OF_A_WHISKER)?),
        Place::Physics(_) => return None,
    };
    let unit = key.dimension.si_unit().to_lowercase().replace('^', "").replace(['/', ' '], "_");
    Some(format!("{}{}{unit}", name.replace('.', "_"), if unit.is_empty() { "" } else { "_" }))
}

/// The value of a key of one part, in SI units. `None` if it is absent or no number.
fn of_part<'py, T: Part>(py: Python<'py>, key: &RigKey, part: &mut T) -> PyResult<Option<Bound<'py, PyAny>>> {
    Ok(Some(match T::access(key.place) {
        Some(Access::Number(field)) => field(part).into_bound_py_any(py)?,
        Some(Access::Optional(field)) => match field(part) {
            Some(number) => number.into_bound_py_any(py)?,
            None => return Ok(None),
        },
        Some(Access::Count(field)) => field(part).into_bound_py_any(py)?,
        Some(Access::Flag(field)) => field(part).into_bound_py_any(py)?,
        Some(Access::Point(field)) => (field(part).x, field(part).y).into_bound_py_any(py)?,
        Some(Access::Triple(field, ..)) => field(part).into_bound_py_any(py)?,
        Some(Access::Choice(choice)) => (choice.get)(part).into_bound_py_any(py)?,
        Some(Access::Calibration(_)) | None => return Ok(None),
    }))
}

impl Rig {
    /// The value of a key, or the values of all whiskers. `None` if one is absent.
    fn value<'py>(&self, py: Python<'py>, key: &RigKey) -> PyResult<Option<Bound<'py, PyAny>>> {
        let mut rig = self.0.clone();
        match key.place {
            Place::Platform(_) => of_part(py, key, &mut rig.platform),
            Place::Sensing(_) => of_part(py, key, &mut rig.sensing),
            Place::Whisker(_) => {
                let values = rig.whiskers.iter_mut().map(|whisker| of_part(py, key, whisker));
                let values = values.collect::<PyResult<Option<Vec<_>>>>()?;
                values.map(|values| values.into_bound_py_any(py)).transpose()
            }
            Place::Physics(_) => Ok(None),
        }
    }
}

#[pymethods]
impl Rig {
    /// The rig of a scenario, or a rig with these keys: `Rig(platform={"servo": "200 ms"})`. Without both, the reference rig.
    #[new]
    #[pyo3(signature = (scenario = None, **keys))]
    fn new(scenario: Option<GivenInput<'_>>, keys: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        match (scenario, keys) {
            (None, None) => Ok(Self(vibrissa_runtime::rig::Rig::default())),
            (Some(scenario), None) => Ok(Self(request::scene(&scenario.into()).map_err(error)?.assumed_rig())),
            (None, Some(keys)) => {
                // JSON is YAML, so keys and values are checked as those of a file.
                let text: String = keys.py().import("json")?.call_method1("dumps", (keys,))?.extract()?;
                Ok(Self(request::rig(&Input::Text(Source::new("keywords", text))).map_err(error)?))
            }
            (Some(_), Some(_)) => Err(error("give a scenario or keys of a rig, not both")),
        }
    }

    /// Loads a rig without a scenario: a text or a file with the keys that `rig` has in a scenario, or the name of a built-in
    /// rig.
    #[classmethod]
    fn load(_class: &Bound<'_, PyType>, source: GivenInput<'_>) -> PyResult<Self> {
        if let GivenInput::Path(path) = &source
            && let Some(preset) = Preset::ALL.into_iter().find(|preset| path.as_os_str() == preset.name())
        {
            return Ok(Self(preset.rig().0));
        }
        let input = match source {
            GivenInput::Path(path) => Input::File(path),
            text @ GivenInput::Text(_) => text.into(),
        };
        Ok(Self(request::rig(&input).map_err(error)?))
    }

    /// Names of the whiskers, in the order of the readings of a sample.
    #[getter]
    fn whiskers(&self) -> Vec<&str> {
        self.0.whiskers.iter().map(|whisker| whisker.name.as_str()).collect()
    }

    /// Time constant of the servos for yaw rates. Without one of its own, it is that for velocities.
    #[getter]
    fn yaw_servo_s(&self) -> f64 {
        self.0.platform.servos().z
    }

    /// The value of a key, by its name in Python.
    fn __getattr__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let key = rig::KEYS.iter().find(|key| python_name(key).is_some_and(|of_key| of_key == name));
        let value = key.map(|key| self.value(py, key)).transpose()?.flatten();
        value.ok_or_else(|| PyAttributeError::new_err(format!("a rig has no `{name}`; `dir(rig)` lists what it has")))
    }

    fn __dir__(slf: &Bound<'_, Self>) -> PyResult<Vec<String>> {
        let mut names: Vec<String> = slf.get_type().dir()?.extract()?;
        for key in rig::KEYS {
            if slf.get().value(slf.py(), key)?.is_some() {
                names.extend(python_name(key));
            }
        }
        Ok(names)
    }

    fn __hash__(&self) -> u64 {
        hash_of(&self.whiskers())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        restored_from(slf, (serde_json::to_string(&slf.get().0).map_err(error)?,))
    }

    #[classmethod]
    fn _restore(_class: &Bound<'_, PyType>, json: &str) -> PyResult<Self> {
        Ok(Self(serde_json::from_str(json).map_err(error)?))
    }

    fn __repr__(&self) -> String {
        format!("Rig(whiskers={:?})", self.whiskers())
    }
}
