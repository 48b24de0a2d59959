//! The result of a run.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use vibrissa::report::picture;
use vibrissa::results::Document;
use vibrissa::trial::{Trial, TrialResult};
use vibrissa_runtime::signal::Sample;

use crate::error::error;
use crate::{samples, ticks};

/// The result of a run.
#[pyclass(frozen, module = "vibrissa")]
pub(crate) struct Result {
    trial: Trial,
    scored: TrialResult,
    /// The figures, as `run --json` prints them.
    #[pyo3(get)]
    figures: Py<PyDict>,
    /// The ticks as arrays, with the names of `run --ticks`.
    #[pyo3(get)]
    ticks: Py<PyDict>,
    /// The plots of the policy as arrays.
    #[pyo3(get)]
    plots: Py<PyDict>,
    /// The samples as arrays. `None` unless the run was asked for them.
    #[pyo3(get)]
    samples: Option<Py<PyDict>>,
}

impl Result {
    pub(crate) fn new(
        py: Python<'_>,
        trial: Trial,
        scored: TrialResult,
        recorded: Option<Vec<Vec<Sample>>>,
    ) -> PyResult<Self> {
        let text = serde_json::to_string(&trial.document(&scored).versioned(None)).map_err(error)?;
        let figures = py.import("json")?.call_method1("loads", (text,))?.cast_into::<PyDict>()?;
        let width = trial.assumed_rig.whiskers.len();
        let samples = recorded.map(|recorded| samples::dictionary(py, &recorded, width).map(Bound::unbind));
        Ok(Self {
            figures: figures.unbind(),
            ticks: ticks::dictionary(py, &scored.run.trace)?.unbind(),
            plots: ticks::plots(py, &scored.run.trace)?.unbind(),
            samples: samples.transpose()?,
            trial,
            scored,
        })
    }
}

#[pymethods]
impl Result {
    /// `completed`, `ended`, `timeout`, `failed` or `diverged`. `ended` means that some `violations` are left.
    #[getter]
    fn outcome(&self) -> &'static str {
        self.scored.ending().name()
    }

    /// The reason of the outcome. `None` if a stop condition completed the run.
    #[getter]
    fn reason(&self) -> Option<&str> {
        self.scored.run.reason.as_deref()
    }

    /// The expectations of the scenario that do not hold.
    #[getter]
    fn violations(&self) -> Vec<String> {
        self.scored.violations.iter().map(ToString::to_string).collect()
    }

    /// Names of the whiskers that the policy binds: the columns of the ticks.
    #[getter]
    fn whiskers(&self) -> Vec<&str> {
        self.scored.run.trace.whiskers.iter().map(String::as_str).collect()
    }

    /// Names of the states. The ticks have their indices.
    #[getter]
    fn states(&self) -> Vec<&str> {
        self.scored.run.trace.states.iter().map(String::as_str).collect()
    }

    /// The messages of the policy: time (s), name of the state, text.
    #[getter]
    fn messages(&self) -> Vec<(f64, Option<String>, String)> {
        ticks::messages(&self.scored.run.trace)
    }

    /// The picture of the run, an SVG file.
    fn picture(&self, py: Python<'_>) -> String {
        let (trial, scored) = (&self.trial, &self.scored);
        py.detach(|| picture(&trial.scene, &trial.policy_label(), &scored.run, &scored.score))
    }

    fn __repr__(&self) -> String {
        let Trial { scene, program, .. } = &self.trial;
        format!("Result(scenario={:?}, policy={:?}, outcome={:?})", scene.name, program.name, self.outcome())
    }
}
