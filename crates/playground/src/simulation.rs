//! A run that the page steps.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::Arc;

use serde::Serialize;
use serde_json::{Value, json};
use vibrissa_lab::inspect::Breakpoints;
use vibrissa_lab::report::picture;
use vibrissa_lab::request::{Input, PolicyInput, TrialRequest};
use vibrissa_lab::results::Document;
use vibrissa_lab::run::{Ending, Step, SteppedRun, Trace, Watcher};
use vibrissa_lab::stream::message::{Frame, Hello, Metrics, ServerMessage};
use vibrissa_lab::stream::{Frames, GuardNumbers, RunSetup, Shadow, hello};
use vibrissa_lab::trial::Trial;
use vibrissa_runtime::machine::Observer;
use vibrissa_runtime::signal::Sample;
use vibrissa_text::diagnostic::Source;
use vibrissa_world::scene::WorldKind;
use vibrissa_world::world::World;

/// The longest run (s of simulated time). The frames of a longer one would fill the memory of a page.
const LONGEST: f64 = 3600.0;

/// A run and its world.
pub(crate) struct Simulation {
    trial: Trial,
    world: Box<dyn World>,
    /// `None` after the end.
    run: Option<SteppedRun>,
    ending: Option<Ending>,
    watch: Watch,
}

/// Makes the frames of a run.
struct Watch {
    hello: Arc<Hello>,
    numbers: GuardNumbers,
    shadow: Shadow,
    frames: Frames,
    samples: Vec<Sample>,
    /// The frames since the last answer. `None` if nobody watches.
    made: Option<Vec<Arc<Frame>>>,
}

/// The answer to a request for ticks.
#[derive(Debug, Serialize)]
pub(crate) struct Advanced {
    frames: Vec<Arc<Frame>>,
    /// The number of ticks until now.
    ticks: usize,
    /// The simulated time (s).
    time: f64,
    has_ended: bool,
}

/// The answer to a request for the score.
#[derive(Debug, Serialize)]
pub(crate) struct Scored {
    /// The document of `run --json`.
    result: Value,
    /// The picture of `run --svg`.
    picture: String,
    /// The outcome, its reason and the figures of the contour for the panels of the live page.
    verdict: String,
    reason: Option<String>,
    metrics: Metrics,
}

impl Simulation {
    /// A run at its start, in the quasi-static simulator, and its first message.
    ///
    /// # Errors
    /// What is wrong with a text or a value, as the program prints it.
    pub(crate) fn start(
        scenario: String,
        policy: String,
        set: &BTreeMap<String, f64>,
    ) -> Result<(Self, ServerMessage), String> {
        let mut request = TrialRequest::new(Input::Text(Source::new("scenario.yaml", scenario)));
        request.policy = Some(PolicyInput::Text(Source::new("policy.fsm", policy)));
        request.world = Some(WorldKind::QuasiStatic);
        let prepared = request.prepare().map_err(|error| error.to_string())?;
        let (mut trial, text) = (prepared.trial, prepared.policy.text);
        if trial.scene.stop.time > LONGEST {
            return Err(format!(
                "the run may take {} s; the playground simulates at most {LONGEST} s",
                trial.scene.stop.time
            ));
        }
        let policy = text.as_ref().map(|text| Breakpoints::new(text, &[])).transpose();
        let policy = policy.map_err(|_| "the policy cannot be explained".to_owned())?.map(Arc::new);
        let setup = RunSetup::simulated(&trial, text);
        let bound = |trial: &Trial| -> Result<Vec<usize>, String> {
            let control = trial.control().map_err(|error| error.to_string())?;
            Ok(control.perception().fitted().map(|(_, in_rig)| in_rig).collect())
        };
        let (mut hello, numbers, changeable) = hello(&setup, &trial.program, policy.as_deref(), &bound(&trial)?);
        trial.program = changeable.apply(&trial.program, None, set)?;
        // The guards are explained by a program whose registers are those of the explanation.
        let explained = policy.as_ref().map(|policy| Arc::new(policy.explained.with_parameters_of(&trial.program)));
        let explained = explained.unwrap_or_else(|| Arc::clone(&trial.program));
        let control = Trial { program: explained, ..trial.clone() }.control().map_err(|error| error.to_string())?;
        hello.parameters.retain(|parameter| parameter.guard.is_none());
        for parameter in &mut hello.parameters {
            parameter.value = set.get(&parameter.name).copied().unwrap_or(parameter.value);
        }
        hello.capabilities.breakpoints = false;
        hello.capabilities.counterfactual = false;
        hello.capabilities.closed_loop = false;
        let frames = Frames::new(trial.assumed_rig.clone(), bound(&trial)?, Some(trial.scene.truth.clone()));
        let world = trial.world().map_err(|error| error.to_string())?;
        let run = trial.begin().map_err(|error| error.to_string())?;
        let hello = Arc::new(hello);
        let watch = Watch {
            hello: Arc::clone(&hello),
            numbers,
            shadow: Shadow::new(control, policy),
            frames,
            samples: Vec::new(),
            made: None,
        };
        Ok((Self { trial, world, run: Some(run), ending: None, watch }, ServerMessage::Hello(hello)))
    }

    /// Simulates at most this number of ticks.
    ///
    /// # Errors
    /// If the run has been scored.
    pub(crate) fn advance(&mut self, ticks: usize, frames: bool) -> Result<Advanced, String> {
        let run = self.run.as_mut().ok_or_else(scored)?;
        self.watch.made = frames.then(Vec::new);
        for _ in 0..ticks {
            if self.ending.is_some() {
                break;
            }
            match run.step(self.world.as_mut(), &mut self.watch) {
                Step::Running | Step::Interrupted => {}
                Step::Ended(ending) => self.ending = Some(ending),
            }
        }
        let trace = run.trace();
        Ok(Advanced {
            frames: self.watch.made.take().unwrap_or_default(),
            ticks: trace.ticks.len(),
            time: trace.ticks.last().map_or(0.0, |tick| tick.time),
            has_ended: self.ending.is_some(),
        })
    }

    /// Scores the run.
    ///
    /// # Errors
    /// If the run has not ended, or if it has been scored.
    pub(crate) fn score(&mut self) -> Result<Scored, String> {
        let ending = self.ending.take().ok_or_else(|| "the run has not ended".to_owned())?;
        let run = self.run.take().ok_or_else(scored)?;
        let result = self.trial.scored(run.finish(ending));
        let document = self.trial.document(&result);
        let missing = result.violations.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ");
        Ok(Scored {
            result: json!(document.versioned(None)),
            picture: picture(&self.trial.scene, &self.trial.policy_label(), &result.run, &result.score),
            verdict: result.ending().name().to_owned(),
            reason: if missing.is_empty() { result.run.reason.clone() } else { Some(missing) },
            metrics: self.watch.frames.metrics(),
        })
    }
}

fn scored() -> String {
    "the run has been scored; start another one".to_owned()
}

impl Observer for Watch {}

impl Watcher for Watch {
    fn before_tick(&mut self, samples: &[Sample]) {
        self.samples.clear();
        self.samples.extend_from_slice(samples);
    }

    fn after_tick(&mut self, trace: &Trace) -> ControlFlow<()> {
        if let Some(made) = &mut self.made {
            self.shadow.tick(&self.samples);
            let frame = self.frames.frame(trace, (&self.shadow, &self.numbers, &self.hello.chart), None);
            made.extend(frame.map(Arc::new));
        }
        ControlFlow::Continue(())
    }
}
