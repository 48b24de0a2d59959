//! Episodes: runs in which Python steers.

use std::sync::{Mutex, PoisonError};

use numpy::PyArray3;
use pyo3::prelude::*;
use vibrissa::report::frame;
use vibrissa::run::{Ending, Step, SteppedRun, TickRecord};
use vibrissa::trial::{ExecuteError, Trial};
use vibrissa::world::World;
use vibrissa_runtime::geometry::Vector2;
use vibrissa_runtime::signal::Command;

use crate::arrays::{list, table};
use crate::error::error;
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

/// What an episode shows after a step.
#[pyclass(frozen, module = "vibrissa")]
pub(crate) struct Observation {
    tick: TickRecord,
    width: usize,
    /// Length of the outlines that this step has traced for the first time.
    #[pyo3(get)]
    traced_m: f64,
    /// True if the episode ended because the body was driven into something.
    #[pyo3(get)]
    crashed: bool,
    /// Outcome of the run, after its last step.
    #[pyo3(get)]
    outcome: Option<&'static str>,
    /// The reason of the outcome.
    #[pyo3(get)]
    reason: Option<String>,
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
        let ticks = &run.trace().ticks;
        let newest = ticks.last().ok_or_else(|| error("the simulation failed at its first step"))?;
        let traced_m = if ticks.len() > before { self.traced.add(before, newest) } else { 0.0 };
        Ok(Observation {
            tick: *newest,
            width: run.trace().whiskers.len(),
            traced_m,
            crashed: run.trace().crashed,
            outcome: self.ending.as_ref().map(|ending| ending.outcome.name()),
            reason: self.ending.as_ref().and_then(|ending| ending.reason.clone()),
        })
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
}

#[pymethods]
impl Observation {
    /// Time since the start of the episode.
    #[getter]
    fn time_s(&self) -> f64 {
        self.tick.time
    }

    /// Position of the platform's centre of mass in the world frame.
    #[getter]
    fn position_m<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        list(py, vec![self.tick.body.position.x, self.tick.body.position.y])
    }

    /// Heading of the platform.
    #[getter]
    fn heading_rad(&self) -> f64 {
        self.tick.body.heading
    }

    /// Filtered base angles of the whiskers.
    #[getter]
    fn deflection_rad<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        list(py, self.tick.deflections[..self.width].to_vec())
    }

    /// True for each whisker that touches.
    #[getter]
    fn touching<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        list(py, self.tick.contacts[..self.width].iter().map(|contact| contact.is_touching).collect())
    }

    /// Estimated tips of the whiskers in the frame of the body, forward and to the left. NaN if unknown.
    #[getter]
    fn tip_body_m<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let body = &self.tick.body;
        let tips = self.tick.contacts[..self.width].iter().flat_map(|contact| match contact.tip_world {
            Some(tip) => {
                let tip = body.vector_from_world(tip - body.position);
                [tip.x, tip.y]
            }
            None => [f64::NAN; 2],
        });
        table(py, tips.collect(), 2)
    }

    /// True if the platform's body touched something since the last step.
    #[getter]
    fn body_touches(&self) -> bool {
        self.tick.body_touches
    }
}
