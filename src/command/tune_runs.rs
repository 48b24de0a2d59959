//! The runs of `vibrissa tune`.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use sha2::Sha256;
use vibrissa_runtime::machine::Program;

use super::experiment::{Experiment, FinishedRun};
use super::failure::Failure;
use super::options::{Jobs, WorldOptions};
use super::output;
use super::provenance::of_trials;
use super::trials::calibrated;
use vibrissa_lab::load::GivenMismatch;
use vibrissa_lab::results::{Provenance, add_seed};
use vibrissa_lab::sweep::{Header, Results};
use vibrissa_lab::trial::Trial;
use vibrissa_lab::tune::{Axis, Candidate, Objective, TunedRun, TuningLine, TuningScene};

/// All that the runs of a tuning have in common.
#[derive(Clone, Copy)]
pub(super) struct TuningWork<'a> {
    /// The parameters that are tuned.
    pub(super) axes: &'a [Axis],
    /// The policy.
    pub(super) program: &'a Program,
    /// The cost of a run.
    pub(super) objective: &'a Objective,
    /// The speed (m/s) of scenes of families, if it is set.
    pub(super) speed: Option<f64>,
    /// The world.
    pub(super) world: &'a WorldOptions,
    /// The array.
    pub(super) array: &'a GivenMismatch,
    /// The threads.
    pub(super) jobs: Jobs,
}

impl TuningWork<'_> {
    /// The trial of a candidate, with the calibration of its array.
    fn trial(&self, candidate: &Candidate, scene: &TuningScene) -> Result<Trial, Failure> {
        let mut trial = scene.trial(candidate, self.axes, self.program, self.speed, |scene| self.world.of(scene))?;
        let name = Path::new(&scene.name);
        let applied = self.array.apply(&mut trial.scene, &mut Sha256::default(), scene.number());
        applied.map_err(Failure::mismatch(name))?;
        trial.assumed_rig = trial.scene.assumed_rig();
        calibrated(&trial, self.array)
    }

    /// The origin of the results of a tuning.
    pub(super) fn provenance<'s>(
        &self,
        candidate: &Candidate,
        scenes: impl Iterator<Item = &'s TuningScene>,
        seed: u64,
    ) -> Result<Provenance, Failure> {
        let trials = scenes.map(|scene| self.trial(candidate, scene)).collect::<Result<Vec<_>, _>>()?;
        let mut provenance = of_trials(&trials);
        add_seed(&mut provenance.seeds, seed);
        Ok(provenance)
    }

    fn run(&self, candidate: &Candidate, scene: &TuningScene) -> Result<TunedRun, Failure> {
        let trial = self.trial(candidate, scene)?;
        let result = trial.run().map_err(|cause| Failure::Execute { scenario: scene.name.clone().into(), cause })?;
        Ok(TunedRun::new(self.objective, &result))
    }
}

/// The runs of a tuning, with their file.
pub(super) struct TuningRuns<'a> {
    work: TuningWork<'a>,
    experiment: Experiment<RunKey, TunedRun>,
}

/// The settings of a candidate, and its scene.
type RunKey = (BTreeMap<String, String>, String);

impl<'a> TuningRuns<'a> {
    /// Opens the file of results, and reads those that it has of so many `runs`.
    pub(super) fn open(
        path: &Path,
        runs: usize,
        header: &Header,
        provenance: &Provenance,
        work: TuningWork<'a>,
    ) -> Result<Self, Failure> {
        let mut done = BTreeMap::new();
        let results = Results::open(path, header, provenance, |line| {
            let TuningLine { scene, settings, run } = serde_json::from_str(line).map_err(|cause| cause.to_string())?;
            let twice = done.insert((settings, scene), run).is_some();
            if twice { Err("the run occurs a second time".to_owned()) } else { Ok(()) }
        })?;
        Ok(Self { work, experiment: Experiment::new(runs, done, Some((path.to_owned(), results))) })
    }

    /// Number of runs whose results an earlier tuning has written.
    pub(super) fn resumed(&self) -> usize {
        self.experiment.resumed
    }

    /// Runs candidates in scenes, except those whose results are there.
    pub(super) fn run(&mut self, candidates: &[&Candidate], scenes: &[TuningScene]) -> Result<(), Failure> {
        let mut keys = BTreeSet::new();
        let pairs = candidates.iter().flat_map(|&candidate| scenes.iter().map(move |scene| (candidate, scene)));
        let tasks: Vec<(&Candidate, &TuningScene)> = pairs
            .filter(|(candidate, scene)| {
                let key = (candidate.settings(), scene.name.clone());
                // Rounded values may occur twice in a generation.
                !self.experiment.done.contains_key(&key) && keys.insert(key)
            })
            .collect();
        let work = self.work;
        let run = |(): &mut (), (candidate, scene): &(&Candidate, &TuningScene)| work.run(candidate, scene);
        self.experiment.run(
            &tasks,
            work.jobs,
            || (),
            run,
            |(candidate, scene), run| {
                let result = run?;
                let line = output::json_line(None, &TuningLine::new(candidate, scene, result))?;
                let shown = format!("{}: cost {:.3}", scene.name, result.cost);
                Ok(Some(FinishedRun { key: (candidate.settings(), scene.name.clone()), result, line, shown }))
            },
        )
    }

    /// The runs of a candidate in scenes.
    pub(super) fn of(&self, candidate: &Candidate, scenes: &[TuningScene]) -> Vec<TunedRun> {
        let run = |scene: &TuningScene| self.experiment.done.get(&(candidate.settings(), scene.name.clone())).copied();
        scenes.iter().filter_map(run).collect()
    }

    /// Ends the progress.
    pub(super) fn finish(self) {
        self.experiment.finish();
    }
}
