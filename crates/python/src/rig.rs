//! The rig.

use pyo3::prelude::*;
use pyo3::types::PyType;
use vibrissa::physics::Preset;
use vibrissa::request::{self, Input};

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

#[pymethods]
impl Rig {
    #[new]
    #[pyo3(signature = (scenario = None))]
    fn new(scenario: Option<GivenInput<'_>>) -> PyResult<Self> {
        let Some(scenario) = scenario else { return Ok(Self(vibrissa_runtime::rig::Rig::default())) };
        Ok(Self(request::scene(&scenario.into()).map_err(error)?.assumed_rig()))
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

    /// Rate of the control loop.
    #[getter]
    fn control_rate_hz(&self) -> f64 {
        self.0.sensing.control_rate
    }

    /// Rate of the samples.
    #[getter]
    fn sample_rate_hz(&self) -> f64 {
        self.0.sensing.sample_rate
    }

    /// Largest speed of the platform's centre of mass.
    #[getter]
    fn speed_limit_m_s(&self) -> f64 {
        self.0.platform.speed_limit
    }

    /// Largest yaw rate of the platform.
    #[getter]
    fn yaw_rate_limit_rad_s(&self) -> f64 {
        self.0.platform.yaw_rate_limit
    }

    /// Time constant of the servos for velocities.
    #[getter]
    fn servo_s(&self) -> f64 {
        self.0.platform.servos().x
    }

    /// Time constant of the servos for yaw rates.
    #[getter]
    fn yaw_servo_s(&self) -> f64 {
        self.0.platform.servos().z
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
