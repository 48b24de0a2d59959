//! The result of a run.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};
use vibrissa::report::picture;
use vibrissa::results::Document;
use vibrissa::trial::{Trial, TrialResult};
use vibrissa_runtime::signal::Sample;

use crate::error::error;
use crate::pickle::{Reduced, restored_from};
use crate::{samples, ticks};

/// The result of a run.
#[pyclass(frozen, module = "vibrissa")]
pub(crate) struct Result {
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
    /// `completed`, `ended`, `timeout`, `failed` or `diverged`. `ended` means that some `violations` are left.
    #[pyo3(get)]
    outcome: String,
    /// The reason of the outcome. `None` if a stop condition completed the run.
    #[pyo3(get)]
    reason: Option<String>,
    /// The expectations of the scenario that do not hold.
    #[pyo3(get)]
    violations: Vec<String>,
    /// Names of the whiskers that the policy binds: the columns of the ticks.
    #[pyo3(get)]
    whiskers: Vec<String>,
    /// Names of the states. The ticks have their indices.
    #[pyo3(get)]
    states: Vec<String>,
    /// The messages of the policy: time (s), name of the state, text.
    #[pyo3(get)]
    messages: Vec<Message>,
    /// Names of the scenario and of the policy.
    names: (String, String),
    picture: Picture,
}

/// A message of a policy: time (s), name of the state, text.
type Message = (f64, Option<String>, String);

/// The picture of a run. It takes longer than the figures, so it is drawn when it is wanted.
enum Picture {
    Drawn(String),
    Of(Box<(Trial, TrialResult)>),
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
        let trace = &scored.run.trace;
        Ok(Self {
            figures: figures.unbind(),
            ticks: ticks::dictionary(py, trace)?.unbind(),
            plots: ticks::plots(py, trace)?.unbind(),
            samples: samples.transpose()?,
            outcome: scored.ending().name().to_owned(),
            reason: scored.run.reason.clone(),
            violations: scored.violations.iter().map(ToString::to_string).collect(),
            whiskers: trace.whiskers.clone(),
            states: trace.states.clone(),
            messages: ticks::messages(trace),
            names: (trial.scene.name.clone(), trial.program.name.clone()),
            picture: Picture::Of(Box::new((trial, scored))),
        })
    }
}

#[pymethods]
impl Result {
    /// The picture of the run, an SVG file.
    fn picture(&self, py: Python<'_>) -> String {
        match &self.picture {
            Picture::Drawn(picture) => picture.clone(),
            Picture::Of(run) => {
                let (trial, scored) = run.as_ref();
                py.detach(|| picture(&trial.scene, &trial.policy_label(), &scored.run, &scored.score))
            }
        }
    }

    /// Everything that the result shows, with its picture, but without the trial.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let py = slf.py();
        let Self {
            figures, ticks, plots, samples, outcome, reason, violations, whiskers, states, messages, names, ..
        } = slf.get();
        let texts = (outcome, reason, violations, whiskers, states, messages, names);
        restored_from(slf, (figures, ticks, plots, samples, texts, slf.get().picture(py)))
    }

    #[classmethod]
    fn _restore(
        _class: &Bound<'_, PyType>,
        figures: Py<PyDict>,
        ticks: Py<PyDict>,
        plots: Py<PyDict>,
        samples: Option<Py<PyDict>>,
        texts: Texts,
        picture: String,
    ) -> Self {
        let (outcome, reason, violations, whiskers, states, messages, names) = texts;
        let picture = Picture::Drawn(picture);
        Self { figures, ticks, plots, samples, outcome, reason, violations, whiskers, states, messages, names, picture }
    }

    fn __repr__(&self) -> String {
        let (scenario, policy) = &self.names;
        format!("Result(scenario={scenario:?}, policy={policy:?}, outcome={:?})", self.outcome)
    }
}

/// The texts of a pickled result: outcome, reason, violations, whiskers, states, messages, names.
type Texts = (String, Option<String>, Vec<String>, Vec<String>, Vec<String>, Vec<Message>, (String, String));
