//! What an episode shows after a step.

use pyo3::prelude::*;
use pyo3::types::PyType;
use vibrissa::run::{Ending, TickRecord, Trace};

use crate::arrays::{list, table};
use crate::pickle::{Reduced, restored_from};

/// What an episode shows after a step.
#[pyclass(frozen, module = "vibrissa")]
pub(crate) struct Observation {
    /// Time since the start of the episode.
    #[pyo3(get)]
    time_s: f64,
    position: [f64; 2],
    /// Heading of the platform.
    #[pyo3(get)]
    heading_rad: f64,
    deflections: Vec<f64>,
    touching: Vec<bool>,
    /// Tips in the frame of the body, one after the other.
    tips_body: Vec<f64>,
    /// True if the platform's body touched something since the last step.
    #[pyo3(get)]
    body_touches: bool,
    /// Length of the outlines that this step has traced for the first time.
    #[pyo3(get)]
    traced_m: f64,
    /// True if the episode ended because the body was driven into something.
    #[pyo3(get)]
    crashed: bool,
    /// Outcome of the run, after its last step.
    #[pyo3(get)]
    outcome: Option<String>,
    /// The reason of the outcome.
    #[pyo3(get)]
    reason: Option<String>,
}

/// The pose of a pickled observation: time, position, heading.
type At = (f64, [f64; 2], f64);
/// Its whiskers: base angles, contacts, tips.
type Whiskers = (Vec<f64>, Vec<bool>, Vec<f64>);
/// Its events: a touch of the body, the traced length, a crash, outcome and reason.
type Events = (bool, f64, bool, Option<String>, Option<String>);

impl Observation {
    pub(crate) fn new(trace: &Trace, tick: &TickRecord, traced_m: f64, ending: Option<&Ending>) -> Self {
        let body = &tick.body;
        let width = trace.whiskers.len();
        let whiskers = || tick.whiskers.iter().take(width);
        let tips = whiskers().flat_map(|whisker| match whisker.contact.tip_world {
            Some(tip) => {
                let tip = body.vector_from_world(tip - body.position);
                [tip.x, tip.y]
            }
            None => [f64::NAN; 2],
        });
        Self {
            time_s: tick.time,
            position: [body.position.x, body.position.y],
            heading_rad: body.heading,
            deflections: whiskers().map(|whisker| whisker.deflection).collect(),
            touching: whiskers().map(|whisker| whisker.contact.is_touching).collect(),
            tips_body: tips.collect(),
            body_touches: tick.body_touches,
            traced_m,
            crashed: trace.crashed,
            outcome: ending.map(|ending| ending.outcome.name().to_owned()),
            reason: ending.and_then(|ending| ending.reason.clone()),
        }
    }
}

#[pymethods]
impl Observation {
    /// Position of the platform's centre of mass in the world frame.
    #[getter]
    fn position_m<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        list(py, self.position.to_vec())
    }

    /// Filtered base angles of the whiskers.
    #[getter]
    fn deflection_rad<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        list(py, self.deflections.clone())
    }

    /// True for each whisker that touches.
    #[getter]
    fn touching<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        list(py, self.touching.clone())
    }

    /// Estimated tips of the whiskers in the frame of the body, forward and to the left. NaN if unknown.
    #[getter]
    fn tip_body_m<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        table(py, self.tips_body.clone(), 2)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let seen = slf.get();
        let at: At = (seen.time_s, seen.position, seen.heading_rad);
        let whiskers = (&seen.deflections, &seen.touching, &seen.tips_body);
        let events = (seen.body_touches, seen.traced_m, seen.crashed, &seen.outcome, &seen.reason);
        restored_from(slf, (at, whiskers, events))
    }

    #[classmethod]
    fn _restore(_class: &Bound<'_, PyType>, at: At, whiskers: Whiskers, events: Events) -> Self {
        let (time_s, position, heading_rad) = at;
        let (deflections, touching, tips_body) = whiskers;
        let (body_touches, traced_m, crashed, outcome, reason) = events;
        Self {
            time_s,
            position,
            heading_rad,
            deflections,
            touching,
            tips_body,
            body_touches,
            traced_m,
            crashed,
            outcome,
            reason,
        }
    }
}
