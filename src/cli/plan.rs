//! A sweep with the files that it names: all that its runs depend on.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use crate::diagnostic::{Diagnostic, Source};
use crate::machine::Program;
use crate::run::Control;
use crate::scene::{FileReference, Scene, ScenesOf, Sweep, SweepRun};
use crate::study::sweep::{Header, Shard};
use crate::study::{check_world, engine_version};
use crate::units::Dimension;

use super::exit::Failure;
use super::input::{self, Loaded};
use super::job::{Job, with_settings};
use super::output;

/// A sweep that is ready to run.
pub(super) struct Plan {
    path: PathBuf,
    source: Source,
    pub(super) sweep: Sweep,
    policies: Vec<Loaded<Program>>,
    /// The texts of its scenarios, in the order of the sweep's scenes.
    scenarios: Vec<Option<Source>>,
    inputs: BTreeMap<String, String>,
}

impl Plan {
    /// Reads a sweep and what it names.
    pub(super) fn read(path: &Path) -> Result<Self, Failure> {
        let source = input::read(path)?;
        let sweep = match Sweep::from_yaml(&source) {
            Ok(sweep) => sweep,
            Err(faults) => return Err(Failure::Faults { source_text: Box::new(source), faults }),
        };
        let mut inputs = BTreeMap::from([("the program".to_owned(), engine_version())]);
        let mut hashed = |kind: &str, file: &FileReference, hash: Sha256| {
            inputs.insert(format!("{kind} {}", file.path.display()), input::short(&hash.finalize()));
        };
        let in_sweep = |file: &FileReference, failure| match failure {
            Failure::Read { cause, .. } => at(&source, file.unreadable(&cause.to_string())),
            other => other,
        };
        let mut policies = Vec::new();
        for file in sweep.policies() {
            let policy = input::program(&input::beside(path, &file.path)).map_err(|failure| in_sweep(file, failure))?;
            hashed("policy", file, policy.hash.clone());
            policies.push(policy);
        }
        let mut scenarios = Vec::new();
        for scenes in sweep.scenes() {
            let ScenesOf::Scenario(file) = &scenes.of else {
                scenarios.push(None);
                continue;
            };
            let path = input::beside(path, &file.path);
            let text = input::read(&path).map_err(|failure| in_sweep(file, failure))?;
            hashed("scenario", file, input::scenario(&path)?.hash);
            scenarios.push(Some(text));
        }
        Ok(Self { path: path.to_owned(), source, sweep, policies, scenarios, inputs })
    }

    /// What the results of a part of it depend on.
    pub(super) fn header(&self, shard: Shard) -> Header {
        let (sweep, text) = (self.sweep.name().to_owned(), self.source.text.clone());
        Header { sweep, shard, text, inputs: self.inputs.clone() }
    }

    /// Tells what the compiler warns of.
    pub(super) fn tell_warnings(&self) -> Result<(), Failure> {
        for file in self.sweep.policies() {
            input::policy(&input::beside(&self.path, &file.path))?.value.tell_warnings();
        }
        Ok(())
    }

    /// Prepares one run of every kind, so that what is wrong with the last shows before the first has run.
    pub(super) fn check(&self) -> Result<(), Failure> {
        let mut told = BTreeSet::new();
        for run in self.sweep.samples() {
            let job = self.job(&run)?;
            check_world(job.world).map_err(|cause| Failure::Execute { scenario: job.path.clone(), cause })?;
            let is_same = matches!(run.scenes().of, ScenesOf::Scenario(_)) && job.scene.rig.sensing.angle_noise <= 0.0;
            if is_same && run.scenes().trials > 1 && told.insert(run.scenes) {
                let name = run.scenes().name();
                output::message(format_args!("{name}: without noise all trials are the same run"));
            }
            if let Err(cause) = Control::new(&job.scene.rig, job.program) {
                return Err(at(&self.source, run.unfit(None, &cause.to_string())));
            }
        }
        Ok(())
    }

    /// The run as a job.
    pub(super) fn job(&self, run: &SweepRun<'_>) -> Result<Job, Failure> {
        let policy = &self.policies[run.policy];
        let mut program = policy.value.clone();
        let mut settings = Vec::new();
        for (name, quantity, place) in run.parameters() {
            let set = program.set(name, quantity.value_si, quantity.dimension);
            set.map_err(|cause| at(&self.source, run.unfit(Some(place), &cause.to_string())))?;
            settings.push((name, quantity.value_si));
        }
        let (path, text) = match (&run.scenes().of, &self.scenarios[run.scenes]) {
            (ScenesOf::Family(family), _) => {
                let given = settings.iter().find(|(name, _)| *name == "speed").map(|&(_, speed)| speed);
                let draw = family.draw_at(run.scenes().family_seed(), run.trial, given)?;
                if given.is_none() {
                    self.set_speed(run, &mut program, draw.speed)?;
                    settings.push(("speed", draw.speed));
                }
                (PathBuf::from(&draw.scene.name), Source::new(draw.scene.name, draw.text))
            }
            (ScenesOf::Scenario(_), Some(text)) => (PathBuf::from(&text.name), text.clone()),
            (ScenesOf::Scenario(file), None) => return Err(at(&self.source, file.unreadable("it has not been read"))),
        };
        let scene = self.scene(run, &path, &text)?;
        let changes = run.settings().map(|(name, value)| format!("\0{name}={value}"));
        let scenario_hash = changes.fold(Sha256::new_with_prefix(&text.text), Sha256::chain_update);
        let policy_hash = with_settings(policy.hash.clone(), settings.into_iter());
        let hashes = (scenario_hash.finalize(), policy_hash.finalize());
        let seed = match &run.scenes().of {
            ScenesOf::Family(_) => scene.seed,
            ScenesOf::Scenario(_) => run.scenes().seed.unwrap_or(scene.seed).wrapping_add(run.trial),
        };
        let world = scene.world.unwrap_or_default();
        Ok(Job::with(&path, scene, program, world, seed, hashes))
    }

    /// Sets the speed that a family has drawn.
    fn set_speed(&self, run: &SweepRun<'_>, program: &mut Program, speed: f64) -> Result<(), Failure> {
        let set = program.set("speed", speed, Dimension::SPEED);
        set.map_err(|cause| at(&self.source, run.unfit(None, &cause.to_string())))
    }

    fn scene(&self, run: &SweepRun<'_>, path: &Path, text: &Source) -> Result<Scene, Failure> {
        let scene = run.scene(text, &self.source, &mut |name| input::outline_file(path, name).1);
        scene.map_err(|(source_text, faults)| Failure::Faults { source_text, faults })
    }
}

/// The failure that a fault of a text is.
fn at(source: &Source, fault: Diagnostic) -> Failure {
    Failure::Faults { source_text: Box::new(source.clone()), faults: vec![fault] }
}
