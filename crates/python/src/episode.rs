//! Episodes: runs in which Python steers.

use std::sync::{Mutex, PoisonError};

use numpy::PyArray3;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use vibrissa::report::frame;
use vibrissa::run::{Ending, Step, SteppedRun};
use vibrissa::trial::{ExecuteError, Trial};
use vibrissa::world::World;
use vibrissa_runtime::geometry::Vector2;
use vibrissa_runtime::signal::Command;

use crate::error::error;
use crate::observation::Observation;
use crate::raster::Pixels;
use crate::result::Result;
use crate::traced_outline::TracedOutline;

/// A run in which the caller gives the commands. The policy only perceives: the tips that it records count as traced.
#[pyclass(frozen, module = "vibrissa")]
pub(crate) struct Episode(Mutex<Inner>);

struct Inner {
    trial: Trial,
    world: Box<dyn World>,
    /// `None` after its end, when the result was taken.
    run: Option<SteppedRun>,
    traced: TracedOutline,
    ending: Option<Ending>,
}

impl Episode {
    pub(crate) fn begin(trial: &Trial) -> std::result::Result<Self, ExecuteError> {
        Ok(Self(Mutex::new(Inner {
            world: trial.world()?,
            run: Some(trial.begin()?),
            traced: TracedOutline::new(&trial.scene.truth.reference),
            trial: trial.clone(),
            ending: None,
        })))
    }
}

impl Inner {
    /// Simulates one control period. Forward velocity, velocity to the left (m/s) and yaw rate (rad/s) stay within the limits of
    /// the rig.
    fn step(&mut self, [forward, left, yaw_rate]: [f64; 3]) -> PyResult<Observation> {
        let over = || error("the episode is over; begin another one");
        let run = self.run.as_mut().filter(|_| self.ending.is_none()).ok_or_else(over)?;
        // The first step is the first look at the scene, and the platform stands still.
        if let Some(newest) = run.trace().ticks.last() {
            let platform = &self.trial.assumed_rig.platform;
            let velocity = Vector2::new(forward, left);
            let command = Command {
                velocity_world: newest.body.vector_to_world(velocity.cap_magnitude(platform.speed_limit)),
                yaw_rate: yaw_rate.clamp(-platform.yaw_rate_limit, platform.yaw_rate_limit),
            };
            if !command.is_finite() {
                return Err(error("the command is not finite; give numbers"));
            }
            run.replace_command(command);
        }
        let before = run.trace().ticks.len();
        if let Step::Ended(ending) = run.step(self.world.as_mut(), &mut ()) {
            self.ending = Some(ending);
        }
        let trace = run.trace();
        let newest = trace.ticks.last().ok_or_else(|| error("the simulation failed at its first step"))?;
        let traced_m = if trace.ticks.len() > before { self.traced.add(before, newest) } else { 0.0 };
        Ok(Observation::new(trace, newest, traced_m, self.ending.as_ref()))
    }
}

#[pymethods]
impl Episode {
    /// Simulates one control period under a command in the frame of the body. In the first step, the platform stands still.
    fn step(&self, py: Python<'_>, forward_m_s: f64, left_m_s: f64, yaw_rate_rad_s: f64) -> PyResult<Observation> {
        py.detach(|| {
            let mut inner = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            inner.step([forward_m_s, left_m_s, yaw_rate_rad_s])
        })
    }

    /// The result of the episode. It must have ended.
    fn result(&self, py: Python<'_>) -> PyResult<Result> {
        let taken = py.detach(|| {
            let mut inner = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            let ending = inner.ending.clone()?;
            let run = inner.run.take()?.finish(ending);
            Some((inner.trial.clone(), inner.trial.scored(run)))
        });
        let (trial, result) = taken.ok_or_else(|| error("the episode goes on, or its result was taken"))?;
        Result::new(py, trial, result, None)
    }

    /// The scene from above after the newest step: an array of 600 x 800 x 3 numbers from 0 to 255.
    fn frame<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<u8>>> {
        let pixels = py.detach(|| {
            let inner = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            let taken = || error("the result of the episode was taken; draw the last frame before");
            let run = inner.run.as_ref().ok_or_else(taken)?;
            Pixels::draw(&frame(&inner.trial.scene, run.trace()))
        });
        pixels?.array(py)
    }

    #[staticmethod]
    fn __reduce__() -> PyResult<()> {
        Err(PyTypeError::new_err(
            "an `Episode` cannot be pickled, because it has a simulation that goes on; pickle its `Trial` and call `trial.begin()` in \
             the other process, or pickle its `Result` at the end",
        ))
    }
}
