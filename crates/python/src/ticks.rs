//! The ticks of a run as arrays. Names and units are those of `run --ticks`.

use numpy::Element;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vibrissa::run::{TickRecord, Trace};
use vibrissa_runtime::machine::Mark;

use crate::arrays::{list, table, vectors};

/// A vector that a tick does not have.
const NONE: [f64; 2] = [f64::NAN; 2];

/// The ticks of a run as arrays with a row for each.
pub(crate) fn dictionary<'py>(py: Python<'py>, trace: &Trace) -> PyResult<Bound<'py, PyDict>> {
    let columns = Columns { py, trace, dictionary: PyDict::new(py) };
    columns.each("time_s", |tick| tick.time)?;
    columns.each("state", |tick| tick.state.and_then(|state| i64::try_from(state).ok()).unwrap_or(-1))?;
    columns.each_vector("position_m", |tick| tick.body.position.coords.into())?;
    columns.each("heading_rad", |tick| tick.body.heading)?;
    columns.each_vector("velocity_m_s", |tick| tick.command.velocity_world.into())?;
    columns.each("yaw_rate_rad_s", |tick| tick.command.yaw_rate)?;
    columns.each("body_touches", |tick| tick.body_touches)?;
    columns.whiskers("deflection_rad", |tick, whisker| tick.whiskers[whisker].deflection)?;
    columns.whiskers("touching", |tick, whisker| tick.whiskers[whisker].contact.is_touching)?;
    columns.whiskers("springs", |tick, whisker| tick.whiskers[whisker].snap_off)?;
    columns
        .whiskers("inclination_rad", |tick, whisker| tick.whiskers[whisker].contact.inclination.unwrap_or(f64::NAN))?;
    columns.whisker_vectors("tip_m", |tick, whisker| {
        tick.whiskers[whisker].contact.tip_world.map_or(NONE, |tip| tip.coords.into())
    })?;
    columns.whiskers("tip_spread_m", |tick, whisker| tick.whiskers[whisker].tip_deviation)?;
    columns.whisker_vectors("tangent", |tick, whisker| {
        tick.whiskers[whisker].contact.tangent_world.map_or(NONE, Into::into)
    })?;
    columns.whiskers("recorded", |tick, whisker| tick.whiskers[whisker].tip.is_some())?;
    columns.whisker_vectors("true_tip_m", |tick, whisker| {
        tick.whiskers[whisker].tip_end.map_or(NONE, |tip| tip.coords.into())
    })?;
    for mark in [Mark::Lost, Mark::Found] {
        columns.marks(mark)?;
    }
    Ok(columns.dictionary)
}

/// The plots of a run as arrays with a row for each tick: SI units, NaN in a tick that did not set it.
pub(crate) fn plots<'py>(py: Python<'py>, trace: &Trace) -> PyResult<Bound<'py, PyDict>> {
    let plots = PyDict::new(py);
    for plot in &trace.plots {
        let mut values = vec![f64::NAN; trace.ticks.len()];
        for &(tick, value) in &plot.values {
            if let Some(place) = values.get_mut(tick) {
                *place = value;
            }
        }
        plots.set_item(&plot.name, list(py, values))?;
    }
    Ok(plots)
}

/// The messages of a run: time (s), name of the state, text.
pub(crate) fn messages(trace: &Trace) -> Vec<(f64, Option<String>, String)> {
    let message = |message: &vibrissa::run::MessageRecord| {
        let time = trace.ticks.get(message.tick).map_or(f64::NAN, |tick| tick.time);
        let state = message.state.and_then(|state| trace.states.get(state)).cloned();
        (time, state, message.message.to_string())
    };
    trace.messages.iter().map(message).collect()
}

/// Arrays under their names.
struct Columns<'py, 't> {
    py: Python<'py>,
    trace: &'t Trace,
    dictionary: Bound<'py, PyDict>,
}

impl Columns<'_, '_> {
    /// A number for each tick.
    fn each<T: Element>(&self, name: &str, value: impl Fn(&TickRecord) -> T) -> PyResult<()> {
        self.dictionary.set_item(name, list(self.py, self.trace.ticks.iter().map(value).collect()))
    }

    /// A vector for each tick.
    fn each_vector(&self, name: &str, value: impl Fn(&TickRecord) -> [f64; 2]) -> PyResult<()> {
        let values: Vec<[f64; 2]> = self.trace.ticks.iter().map(value).collect();
        self.dictionary.set_item(name, table(self.py, values.concat(), 2)?)
    }

    /// A number for each tick and whisker.
    fn whiskers<T: Element>(&self, name: &str, value: impl Fn(&TickRecord, usize) -> T) -> PyResult<()> {
        self.dictionary.set_item(name, table(self.py, self.by_whisker(value), self.trace.whiskers.len())?)
    }

    /// A vector for each tick and whisker.
    fn whisker_vectors(&self, name: &str, value: impl Fn(&TickRecord, usize) -> [f64; 2]) -> PyResult<()> {
        self.dictionary.set_item(name, vectors(self.py, self.by_whisker(value), self.trace.whiskers.len())?)
    }

    /// For each tick and whisker, whether the policy made this mark.
    fn marks(&self, mark: Mark) -> PyResult<()> {
        let width = self.trace.whiskers.len();
        let mut made = vec![false; self.trace.ticks.len() * width];
        for record in self.trace.marks.iter().filter(|record| record.mark == mark && record.whisker < width) {
            if let Some(place) = made.get_mut(record.tick * width + record.whisker) {
                *place = true;
            }
        }
        self.dictionary.set_item(mark.name(), table(self.py, made, width)?)
    }

    fn by_whisker<T>(&self, value: impl Fn(&TickRecord, usize) -> T) -> Vec<T> {
        let whiskers = 0..self.trace.whiskers.len();
        self.trace
            .ticks
            .iter()
            .flat_map(|tick| whiskers.clone().map(|whisker| value(tick, whisker)).collect::<Vec<T>>())
            .collect()
    }
}
