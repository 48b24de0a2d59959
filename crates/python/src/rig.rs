//! The rig.

use pyo3::prelude::*;
use vibrissa::request;

use crate::error::error;
use crate::input::GivenInput;

/// A platform with whiskers, as control assumes it: that of a scenario, or the reference rig.
#[pyclass(frozen, module = "vibrissa")]
pub(crate) struct Rig(pub(crate) vibrissa_runtime::rig::Rig);

#[pymethods]
impl Rig {
    #[new]
    #[pyo3(signature = (scenario = None))]
    fn new(scenario: Option<GivenInput<'_>>) -> PyResult<Self> {
        let Some(scenario) = scenario else { return Ok(Self(vibrissa_runtime::rig::Rig::default())) };
        Ok(Self(request::scene(&scenario.into()).map_err(error)?.assumed_rig()))
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

    fn __repr__(&self) -> String {
        format!("Rig(whiskers={:?})", self.whiskers())
    }
}
