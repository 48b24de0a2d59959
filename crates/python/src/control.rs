//! The control loop of a machine.

use numpy::PyArray1;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
#[cfg(feature = "recording")]
use pyo3::types::PyBytes;
use pyo3::types::{PyDict, PyType};
#[cfg(feature = "recording")]
use vibrissa::recording::record_samples;
use vibrissa_runtime::geometry::{Pose, Vector2};
use vibrissa_runtime::machine::{Artifact, LoggedMessage, Senses, Status, WhiskerScalar, WhiskerVector};
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal;

use crate::arrays::{Numbers, list, table};
use crate::error::error;
use crate::map::of_map;
use crate::pickle::{Reduced, hash_of, restored_from};
use crate::samples::GivenSamples;

/// Distance (m) of a tip from the first ones, and time (s) since the first one, for a closed loop. Scenarios mostly have the same.
const CLOSED_WITHIN: f64 = 5e-3;
const CLOSED_AFTER: f64 = 5.0;

/// A control loop: perception, machine and motion. It is the loop that simulations and robots run.
#[pyclass(module = "vibrissa")]
pub(crate) struct Control {
    inner: vibrissa_runtime::control::Control,
    /// Number of whiskers of the rig.
    width: usize,
    status: Status,
    /// The latest time (s) of a sample. Minus infinity before the first one.
    latest: f64,
    /// What a recording needs, if it was asked for.
    kept: Option<Kept>,
}

/// What a recording of a control loop needs.
#[cfg_attr(
    not(feature = "recording"),
    expect(dead_code, reason = "nothing reads the artifact and the rig without recordings")
)]
pub(crate) struct Kept {
    pub(crate) artifact: Artifact,
    pub(crate) rig: Rig,
    /// The samples before each tick.
    pub(crate) samples: Vec<Vec<signal::Sample>>,
}

/// A command to the platform, valid until the next tick.
#[pyclass(frozen, eq, module = "vibrissa")]
#[derive(PartialEq)]
pub(crate) struct Command(signal::Command);

impl Control {
    pub(crate) fn new(control: vibrissa_runtime::control::Control, width: usize, kept: Option<Kept>) -> Self {
        Self { inner: control, width, status: Status::Running, latest: f64::NEG_INFINITY, kept }
    }
}

/// The latest time (s) after these samples.
///
/// # Errors
/// A time is less than an earlier one.
fn latest_time(before: f64, samples: &[signal::Sample]) -> PyResult<f64> {
    samples.iter().try_fold(before, |latest, &signal::Sample { time, .. }| {
        if time < latest {
            return Err(error(format_args!(
                "time_s: {time} s comes after {latest} s, but the time of samples never decreases; give the samples oldest first, and start \
                 the machine anew for another run"
            )));
        }
        Ok(latest.max(time))
    })
}

#[pymethods]
impl Control {
    /// Executes one tick. The samples are those since the last tick, oldest first: a row for each in every array.
    #[pyo3(signature = (time_s, position_m, heading_rad, base_angle_rad, shear_n = None, axial_n = None))]
    fn tick(
        &mut self,
        time_s: Numbers<'_>,
        position_m: Numbers<'_>,
        heading_rad: Numbers<'_>,
        base_angle_rad: Numbers<'_>,
        shear_n: Option<Numbers<'_>>,
        axial_n: Option<Numbers<'_>>,
    ) -> PyResult<Command> {
        let given = GivenSamples {
            time: time_s,
            position: position_m,
            heading: heading_rad,
            base_angle: base_angle_rad,
            shear: shear_n,
            axial: axial_n,
        };
        let samples = given.samples(self.width)?;
        // Before the tick, so that refused samples leave the control loop as it was.
        self.latest = latest_time(self.latest, &samples)?;
        let (command, tick) = self.inner.tick(&samples);
        self.status = tick.status;
        if let Some(kept) = &mut self.kept {
            kept.samples.push(samples);
        }
        Ok(Command(command))
    }

    /// Name of the innermost active state, or `Failure` or `Success` after the end.
    #[getter]
    fn state(&self) -> &str {
        self.inner.machine().state_name()
    }

    /// `running`, `failed` or `succeeded`.
    #[getter]
    fn status(&self) -> &'static str {
        match self.status {
            Status::Running => "running",
            Status::Failed => "failed",
            Status::Succeeded => "succeeded",
        }
    }

    /// The reason of the end. `None` while the machine runs.
    #[getter]
    fn reason(&self) -> Option<String> {
        let machine = self.inner.machine();
        machine.failure().map(ToString::to_string).or_else(|| machine.success().map(str::to_owned))
    }

    /// The messages that the newest tick has logged.
    #[getter]
    fn messages(&self) -> Vec<String> {
        let machine = self.inner.machine();
        let program = machine.program();
        let shown = |LoggedMessage { message, numbers }| {
            program.outputs.messages[message].shown(&numbers, &program.whiskers).to_string()
        };
        machine.logged().map(shown).collect()
    }

    /// The whiskers that the machine binds, as perceived in the newest tick: arrays with a row for each. A loop is closed by a
    /// recorded tip within `closed_within_m` of the first ones, at least `closed_after_s` later.
    #[pyo3(signature = (*, closed_within_m = CLOSED_WITHIN, closed_after_s = CLOSED_AFTER))]
    fn perceived<'py>(
        &self,
        py: Python<'py>,
        closed_within_m: f64,
        closed_after_s: f64,
    ) -> PyResult<Bound<'py, PyDict>> {
        let perception = self.inner.perception();
        let names = &self.inner.machine().program().whiskers;
        let fitted: Vec<usize> = perception.fitted().map(|(whisker, _)| whisker).collect();
        let each = |value: &dyn Fn(usize) -> f64| list(py, fitted.iter().map(|&whisker| value(whisker)).collect());
        let perceived = PyDict::new(py);
        perceived.set_item("whisker", fitted.iter().map(|&whisker| names[whisker].as_str()).collect::<Vec<_>>())?;
        perceived.set_item("deflection_rad", each(&|whisker| perception.base_angle(whisker)))?;
        let touching = |&whisker: &usize| perception.whisker(whisker, WhiskerScalar::Touching) > 0.0;
        perceived.set_item("touching", list(py, fitted.iter().map(touching).collect()))?;
        let tips = fitted.iter().flat_map(|&whisker| {
            let tip = perception.whisker_vector(whisker, WhiskerVector::Tip);
            [tip.x, tip.y]
        });
        perceived.set_item("tip_m", table(py, tips.collect(), 2)?)?;
        let tangents = fitted.iter().flat_map(|&whisker| {
            let tangent = perception.whisker_vector(whisker, WhiskerVector::ContourTangent);
            [tangent.x, tangent.y]
        });
        perceived.set_item("tangent", table(py, tangents.collect(), 2)?)?;
        perceived.set_item("tip_spread_m", each(&|whisker| perception.recorded_deviation(whisker)))?;
        let recorded = |&whisker: &usize| perception.recorded_tip(whisker).is_some();
        perceived.set_item("recorded", list(py, fitted.iter().map(recorded).collect()))?;
        let closed = |&whisker: &usize| perception.loop_closed(whisker, closed_within_m, closed_after_s);
        perceived.set_item("loop_closed", list(py, fitted.iter().map(closed).collect()))?;
        Ok(perceived)
    }

    /// The map by touch, with the recorded contours: a dictionary. `None` if there is none.
    fn map<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        self.inner.map().map(|map| of_map(py, map, &self.inner.machine().program().whiskers)).transpose()
    }

    /// The recording of the ticks so far: the content of a file that `vibrissa replay` reads.
    #[cfg(feature = "recording")]
    fn recording<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let Some(Kept { artifact, rig, samples }) = &self.kept else {
            return Err(error("the samples have not been kept; begin with `machine.start(rig, record=True)`"));
        };
        let content = py.detach(|| record_samples(artifact, rig, samples.clone())).map_err(error)?;
        Ok(PyBytes::new(py, &content))
    }

    #[staticmethod]
    fn __reduce__() -> PyResult<()> {
        Err(PyTypeError::new_err(
            "a `Control` cannot be pickled, because it is in the middle of a run; pickle its `Machine` and its `Rig`, and call \
             `machine.start(rig)` in the other process",
        ))
    }
}

#[pymethods]
impl Command {
    /// Velocity of the platform's centre of mass in the world frame.
    #[getter]
    fn velocity_m_s<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &[self.0.velocity_world.x, self.0.velocity_world.y])
    }

    /// Yaw rate, counter-clockwise positive.
    #[getter]
    fn yaw_rate_rad_s(&self) -> f64 {
        self.0.yaw_rate
    }

    /// The velocity in the frame of a body with this heading: forward and to the left.
    fn velocity_body_m_s(&self, heading_rad: f64) -> (f64, f64) {
        let velocity = Pose { heading: heading_rad, ..Pose::default() }.vector_from_world(self.0.velocity_world);
        (velocity.x, velocity.y)
    }

    fn __hash__(&self) -> u64 {
        let signal::Command { velocity_world, yaw_rate } = self.0;
        // 0.0 makes both zeros, which are equal, the same.
        hash_of(&[velocity_world.x, velocity_world.y, yaw_rate].map(|number| (number + 0.0).to_bits()))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let signal::Command { velocity_world, yaw_rate } = slf.get().0;
        restored_from(slf, (velocity_world.x, velocity_world.y, yaw_rate))
    }

    #[classmethod]
    fn _restore(_class: &Bound<'_, PyType>, x: f64, y: f64, yaw_rate: f64) -> Self {
        Self(signal::Command { velocity_world: Vector2::new(x, y), yaw_rate })
    }

    fn __repr__(&self) -> String {
        let signal::Command { velocity_world, yaw_rate } = self.0;
        format!("Command(velocity_m_s=[{}, {}], yaw_rate_rad_s={yaw_rate})", velocity_world.x, velocity_world.y)
    }
}
