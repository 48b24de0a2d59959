//! Work whose time is measured.

use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use vibrissa_language::compile_with_warnings;
use vibrissa_runtime::machine::Program;
use vibrissa_runtime::percept::Perception;
use vibrissa_text::diagnostic::Source;
use vibrissa_world::scenario;
use vibrissa_world::scene::WorldKind;

use super::error::ScaleError;
use super::result_lines::ResultLines;
use super::{policy, scene};
use crate::trial::{Trial, TrialResult, in_parallel, processor_time};

/// Work that is done once by each call, which returns its time (s).
pub(super) type Case = Box<dyn FnMut() -> Result<f64, ScaleError>>;

/// Simulated time of a run (s), and number of the runs, where neither is the size of the axis.
pub(super) const RUN_TIME: usize = 20;
pub(super) const RUNS: usize = 200;

/// A scenario under a policy in a simulator.
pub(super) struct RunCase {
    scenario: Source,
    /// The content of the file that the scenario names.
    file: String,
    program: Arc<Program>,
    world: WorldKind,
}

impl RunCase {
    /// A scenario with the content of the file that it names.
    ///
    /// # Errors
    /// [`ScaleError`] if its run cannot begin.
    pub(super) fn new(
        (text, file): (String, String),
        program: Arc<Program>,
        world: WorldKind,
    ) -> Result<Self, ScaleError> {
        let case = Self { scenario: Source::new("scale.yaml", text), file, program, world };
        let trial = case.trial()?;
        // Tables of perception are made once in a process. They would be in the first time only.
        Perception::prepare(&trial.assumed_rig, &trial.program.contact_estimators);
        trial.begin()?;
        trial.world()?;
        Ok(case)
    }

    pub(super) fn trial(&self) -> Result<Trial, ScaleError> {
        let scene = scenario::read_with(&self.scenario, &mut |_| Ok(self.file.clone().into_bytes()));
        let scene = scene.map_err(|faults| ScaleError::Text(format!("{faults:?}")))?;
        Ok(Trial { world: self.world.into(), ..Trial::new(scene, Arc::clone(&self.program)) })
    }

    /// Reads, runs and scores the trial.
    pub(super) fn run(&self) -> Result<TrialResult, ScaleError> {
        Ok(self.trial()?.run()?)
    }
}

/// Measures the processor time of this thread.
pub(super) fn processor(mut work: impl FnMut() -> Result<(), ScaleError> + 'static) -> Case {
    Box::new(move || {
        let start = processor_time();
        work()?;
        Ok(processor_time() - start)
    })
}

/// Measures the wall time.
pub(super) fn wall(mut work: impl FnMut() -> Result<(), ScaleError> + 'static) -> Case {
    Box::new(move || {
        let start = Instant::now();
        work()?;
        Ok(start.elapsed().as_secs_f64())
    })
}

/// One run of a text without files.
fn one(text: String, program: Arc<Program>, world: WorldKind) -> Result<Case, ScaleError> {
    with_file((text, String::new()), program, world)
}

fn with_file(texts: (String, String), program: Arc<Program>, world: WorldKind) -> Result<Case, ScaleError> {
    let case = RunCase::new(texts, program, world)?;
    Ok(processor(move || case.run().map(drop)))
}

/// The run round a disk, which a sweep of a million runs consists of.
pub(super) fn round(world: WorldKind) -> Result<RunCase, ScaleError> {
    RunCase::new((scene::round(), String::new()), policy::program(&policy::tracing())?, world)
}

pub(super) fn run_length(seconds: usize, world: WorldKind, _: &Path) -> Result<Case, ScaleError> {
    one(scene::lasting(seconds), policy::bang()?, world)
}

pub(super) fn far_objects(count: usize, world: WorldKind, _: &Path) -> Result<Case, ScaleError> {
    one(scene::among(count), policy::program(&policy::tracing())?, world)
}

pub(super) fn outline_pieces(count: usize, world: WorldKind, _: &Path) -> Result<Case, ScaleError> {
    with_file(scene::with_outline(count), policy::program(&policy::tracing())?, world)
}

pub(super) fn whiskers(count: usize, world: WorldKind, _: &Path) -> Result<Case, ScaleError> {
    one(scene::with_whiskers(count, RUN_TIME), policy::with_whiskers(count)?, world)
}

pub(super) fn links(count: usize, world: WorldKind, _: &Path) -> Result<Case, ScaleError> {
    one(scene::with_links(count, RUN_TIME), policy::bang()?, world)
}

pub(super) fn runs(count: usize, world: WorldKind, _: &Path) -> Result<Case, ScaleError> {
    let case = RunCase::new((scene::lasting(RUN_TIME), String::new()), policy::bang()?, world)?;
    Ok(processor(move || (0..count).try_for_each(|_| case.run().map(drop))))
}

pub(super) fn cores(count: usize, world: WorldKind, _: &Path) -> Result<Case, ScaleError> {
    let case = RunCase::new((scene::lasting(RUN_TIME), String::new()), policy::bang()?, world)?;
    let threads = NonZeroUsize::new(count).unwrap_or(NonZeroUsize::MIN);
    Ok(wall(move || in_parallel(&[(); RUNS], threads, |()| case.run().map(drop), |_| ()).into_iter().collect()))
}

pub(super) fn states(count: usize, _: WorldKind, _: &Path) -> Result<Case, ScaleError> {
    let source = policy::with_states(count);
    let compile = move || {
        let compiled = compile_with_warnings(&source);
        compiled.map(drop).map_err(|faults| ScaleError::Text(format!("{}: {faults:?}", source.name)))
    };
    compile()?;
    Ok(processor(compile))
}

pub(super) fn result_lines(count: usize, world: WorldKind, folder: &Path) -> Result<Case, ScaleError> {
    let lines = ResultLines::write(folder, count, &round(world)?)?;
    Ok(processor(move || lines.merge()))
}
