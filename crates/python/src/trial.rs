//! Trials.

use std::ops::ControlFlow;
use std::path::PathBuf;

use numpy::{PyArray1, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};
use vibrissa::geometry::Point2;
use vibrissa::request::TrialRequest;
use vibrissa::run::{Trace, Watcher};
use vibrissa::scene::{Jitter, WorldKind};
use vibrissa::score::{Estimate, coverage};
use vibrissa::trial::ExecuteError;
use vibrissa_runtime::machine::Observer;
use vibrissa_runtime::signal::Sample;

use crate::arrays::{Numbers, table};
use crate::episode::Episode;
use crate::error::error;
use crate::input::{GivenInput, GivenPolicy, settings};
use crate::machine::warnings;
use crate::pickle::{Reduced, restored_from};
use crate::result::Result;
use crate::rig::Rig;

/// A policy in a scene and a world, ready to run.
#[pyclass(frozen, module = "vibrissa")]
pub(crate) struct Trial {
    inner: vibrissa::trial::Trial,
    /// Warnings about probable mistakes in the text of the policy, as the program prints them.
    #[pyo3(get)]
    warnings: String,
    arguments: Arguments,
}

/// The arguments of a trial, from which another process makes it again.
struct Arguments {
    scenario: Py<PyAny>,
    policy: Option<Py<PyAny>>,
    options: Py<PyDict>,
}

#[pymethods]
impl Trial {
    #[new]
    #[pyo3(signature = (
        scenario, policy = None, *, set = None, world = None, seed = None, mismatch = None, mismatch_seed = None, uncalibrated = false,
        prune = true, jitter = None, time_limit_s = None, unused_seeds = false
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python names them")]
    fn new(
        py: Python<'_>,
        scenario: GivenInput<'_>,
        policy: Option<GivenPolicy<'_>>,
        set: Option<&Bound<'_, PyDict>>,
        world: Option<&str>,
        seed: Option<u64>,
        mismatch: Option<GivenInput<'_>>,
        mismatch_seed: Option<u64>,
        uncalibrated: bool,
        prune: bool,
        jitter: Option<(f64, f64)>,
        time_limit_s: Option<f64>,
        unused_seeds: bool,
    ) -> PyResult<Self> {
        let options = PyDict::new(py);
        // The caller may change his dictionary.
        options.set_item("set", set.map(PyDictMethods::copy).transpose()?)?;
        options.set_item("world", world)?;
        options.set_item("seed", seed)?;
        options.set_item("mismatch", mismatch.as_ref().map(|mismatch| mismatch.to_python(py)).transpose()?)?;
        options.set_item("mismatch_seed", mismatch_seed)?;
        options.set_item("uncalibrated", uncalibrated)?;
        options.set_item("prune", prune)?;
        options.set_item("jitter", jitter)?;
        options.set_item("time_limit_s", time_limit_s)?;
        options.set_item("unused_seeds", unused_seeds)?;
        let arguments = Arguments {
            scenario: scenario.to_python(py)?.unbind(),
            policy: policy.as_ref().map(|policy| policy.to_python(py)).transpose()?.map(Bound::unbind),
            options: options.unbind(),
        };
        let request = TrialRequest {
            policy: policy.map(Into::into),
            settings: settings(set)?,
            mismatch: mismatch.map(Into::into),
            mismatch_seed,
            uncalibrated,
            world: world.map(world_kind).transpose()?,
            prune,
            // The start depends on the seed as well.
            seed: seed.filter(|_| jitter.is_none()),
            unused_seeds,
            ..TrialRequest::new(scenario.into())
        };
        let prepared = py.detach(|| request.prepare()).map_err(error)?;
        let mut trial = prepared.trial;
        if let Some((position, heading)) = jitter {
            trial.seed = seed.unwrap_or(trial.seed);
            let start = Jitter { position, heading }.start(&trial.scene, trial.seed);
            let none = "almost no start within the jitter is collision-free; make `jitter` smaller";
            trial.scene.start = start.ok_or_else(|| error(none))?;
        }
        if let Some(limit) = time_limit_s {
            if !(limit > 0.0 && limit.is_finite()) {
                return Err(error("`time_limit_s` must be a positive number"));
            }
            trial.scene.stop.time = limit;
        }
        Ok(Self { inner: trial, warnings: warnings(&prepared.policy), arguments })
    }

    /// Runs and scores the trial. Other threads of Python go on meanwhile.
    #[pyo3(signature = (*, samples = false))]
    fn run(&self, py: Python<'_>, samples: bool) -> PyResult<Result> {
        let mut watch = Watch { samples: samples.then(Vec::new), signal: None };
        let run = py.detach(|| self.inner.run_watched(&mut watch));
        match (run, watch.signal) {
            (Err(ExecuteError::Interrupted), Some(signal)) => Err(signal),
            (Err(cause), _) => Err(error(format_args!("{}: {cause}", self.inner.inputs.scenario.display()))),
            (Ok(result), _) => Result::new(py, self.inner.clone(), result, watch.samples),
        }
    }

    /// Begins an episode, in which the caller steers the platform instead of the policy.
    fn begin(&self, py: Python<'_>) -> PyResult<Episode> {
        let begun = py.detach(|| Episode::begin(&self.inner));
        begun.map_err(|cause| error(format_args!("{}: {cause}", self.inner.inputs.scenario.display())))
    }

    /// Name of the scenario.
    #[getter]
    fn scenario(&self) -> &str {
        &self.inner.scene.name
    }

    /// Name of the policy.
    #[getter]
    fn policy(&self) -> &str {
        &self.inner.program.name
    }

    /// Name of the simulator.
    #[getter]
    fn world(&self) -> &'static str {
        self.inner.world.kind.name()
    }

    /// Seed of the sensor noise.
    #[getter]
    fn seed(&self) -> u64 {
        self.inner.seed
    }

    /// Simulated time after which the run ends.
    #[getter]
    fn time_limit_s(&self) -> f64 {
        self.inner.scene.stop.time
    }

    /// The rig that control assumes.
    #[getter]
    fn rig(&self) -> Rig {
        Rig(self.inner.assumed_rig.clone())
    }

    /// Pose of the platform at the start: x (m), y (m), heading (rad).
    #[getter]
    fn start(&self) -> (f64, f64, f64) {
        let start = &self.inner.scene.start;
        (start.position.x, start.position.y, start.heading)
    }

    /// The exact outlines that count as traced, as polylines with points at most this far apart.
    #[pyo3(signature = (spacing_m = 1e-3))]
    fn outlines<'py>(&self, py: Python<'py>, spacing_m: f64) -> PyResult<Vec<Bound<'py, PyAny>>> {
        if spacing_m.is_nan() || spacing_m < 1e-6 {
            return Err(error("`spacing_m` must be at least 1e-6"));
        }
        let outline = |contour: &vibrissa::geometry::Contour| {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "an outline is some metres long"
            )]
            let count = (contour.length() / spacing_m).ceil().max(1.0) as usize;
            let point = |index: usize| contour.point_at(contour.length() * index as f64 / count as f64);
            table(py, (0..=count).map(point).flat_map(|point| [point.x, point.y]).collect(), 2)
        };
        self.inner.scene.truth.reference.contours().map(outline).collect()
    }

    /// The errors of tips (m, world frame) from elsewhere, such as another simulator: the distance of each from the nearest
    /// surface of the scene.
    fn errors<'py>(&self, tips_m: Numbers<'py>) -> PyResult<Bound<'py, PyAny>> {
        let rows = points(&tips_m)?;
        let surfaces = &self.inner.scene.truth.surfaces;
        let error = |tip: Point2| if is_finite(tip) { surfaces.distance(tip) } else { f64::NAN };
        let errors = PyArray1::from_vec(tips_m.py(), rows.map(error).collect());
        Ok(errors.reshape(&tips_m.shape()[..tips_m.ndim() - 1])?.into_any())
    }

    /// The share of the exact outlines (0 to 1) that tips from elsewhere trace: an array (ticks, whiskers, 2) in metres, which
    /// is not finite where nothing was recorded.
    fn coverage(&self, tips_m: Numbers<'_>) -> PyResult<f64> {
        let rows: Vec<Point2> = points(&tips_m)?.collect();
        let &[_, whiskers, _] = tips_m.shape() else {
            return Err(error("`tips_m` needs three dimensions: ticks, whiskers, and x and y"));
        };
        let of_whisker = |whisker| {
            let tips = rows.iter().skip(whisker).step_by(whiskers).copied().enumerate();
            tips.filter(|(_, tip)| is_finite(*tip))
        };
        Ok(coverage(&Estimate::of((0..whiskers).map(of_whisker)), &self.inner.scene.truth.reference))
    }

    /// The arguments, and hashes of what they name.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let Self { arguments: Arguments { scenario, policy, options }, inner, .. } = slf.get();
        let hashes = (&inner.inputs.scenario_hash, &inner.inputs.policy_hash);
        restored_from(slf, (scenario, policy, options, hashes))
    }

    #[classmethod]
    fn _restore(
        class: &Bound<'_, PyType>,
        scenario: Bound<'_, PyAny>,
        policy: Bound<'_, PyAny>,
        options: Bound<'_, PyDict>,
        hashes: (String, String),
    ) -> PyResult<Py<Self>> {
        let made = class.call((scenario, policy), Some(&options))?.cast_into::<Self>()?;
        let inputs = &made.get().inner.inputs;
        if hashes == (inputs.scenario_hash.clone(), inputs.policy_hash.clone()) {
            Ok(made.unbind())
        } else {
            Err(error(
                "a file of the trial has changed since the trial was pickled; make the trial again and pickle that one",
            ))
        }
    }

    fn __repr__(&self) -> String {
        format!("Trial(scenario={:?}, policy={:?}, world={:?})", self.scenario(), self.policy(), self.world())
    }
}

/// The points of an array whose last dimension is x and y (m), in the order of its rows.
fn points<'a>(array: &'a Numbers<'_>) -> PyResult<impl Iterator<Item = Point2> + 'a> {
    if array.shape().last() != Some(&2) {
        return Err(error("the last dimension of `tips_m` must be 2: x and y"));
    }
    let numbers: Vec<f64> = array.as_array().iter().copied().collect();
    Ok((0..numbers.len() / 2).map(move |row| Point2::new(numbers[2 * row], numbers[2 * row + 1])))
}

fn is_finite(point: Point2) -> bool {
    point.x.is_finite() && point.y.is_finite()
}

fn world_kind(name: &str) -> PyResult<WorldKind> {
    let known = || WorldKind::ALL.map(|kind| format!("`{kind}`")).join(" and ");
    let kind = WorldKind::named(name);
    kind.ok_or_else(|| error(format_args!("there is no simulator `{name}`; there are {}", known())))
}

/// Number of ticks between two looks for a signal, such as Ctrl-C.
const TICKS_BETWEEN_SIGNALS: usize = 30;

/// Keeps the samples of a run, and ends it at a signal.
struct Watch {
    samples: Option<Vec<Vec<Sample>>>,
    /// The exception of a signal.
    signal: Option<PyErr>,
}

impl Observer for Watch {}

impl Watcher for Watch {
    fn before_tick(&mut self, samples: &[Sample]) {
        if let Some(kept) = &mut self.samples {
            kept.push(samples.to_vec());
        }
    }

    fn after_tick(&mut self, trace: &Trace) -> ControlFlow<()> {
        if trace.ticks.len().is_multiple_of(TICKS_BETWEEN_SIGNALS) {
            self.signal = Python::attach(|py| py.check_signals().err());
        }
        if self.signal.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// True if the package was built with MuJoCo's world.
#[pyfunction]
pub(crate) fn has_mujoco() -> bool {
    cfg!(feature = "sim")
}

/// Sets the file of MuJoCo's library.
#[pyfunction]
pub(crate) fn use_mujoco(file: PathBuf) -> PyResult<()> {
    #[cfg(feature = "sim")]
    return vibrissa::mujoco::set_library(&file).map_err(error);
    #[cfg(not(feature = "sim"))]
    return Err(error(format_args!("{}: this build has no simulator `mujoco`", file.display())));
}
