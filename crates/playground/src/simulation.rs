//! A run that the page steps.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::Arc;

use serde::Serialize;
use serde_json::{Value, json};
use vibrissa_lab::inspect::Breakpoints;
use vibrissa_lab::report::picture;
use vibrissa_lab::request::{Input, PolicyInput, TrialRequest};
use vibrissa_lab::results::{Document, tick_lines};
use vibrissa_lab::run::{Ending, Step, SteppedRun, Trace, Watcher};
use vibrissa_lab::stream::message::{BreakpointInfo, Frame, Metrics, Piece, ServerMessage};
use vibrissa_lab::stream::{
    Counterfactual, Frames, PastRun, Question, RunFacts, RunSetup, SampleStore, Shadow, TickResult, breakpoints,
    breakpoints_with, hello,
};
use vibrissa_lab::trial::Trial;
use vibrissa_runtime::machine::Observer;
use vibrissa_runtime::signal::Sample;
use vibrissa_text::diagnostic::Source;
use vibrissa_world::scene::WorldKind;
use vibrissa_world::world::World;

/// The longest run (s of simulated time). A longer one ends then, because its ticks would fill the memory of a page.
const LONGEST: f64 = 3600.0;

/// A run and its world.
pub(crate) struct Simulation {
    trial: Trial,
    world: Box<dyn World>,
    /// `None` after the end.
    run: Option<SteppedRun>,
    ending: Option<Ending>,
    /// The text of the policy.
    source: Option<Source>,
    watch: Watch,
    counterfactual: Option<Counterfactual>,
}

/// Makes the frames of a run.
struct Watch {
    facts: RunFacts,
    shadow: Shadow,
    /// The control loop that explains guards, before the first tick.
    start: Shadow,
    frames: Frames,
    samples: Vec<Sample>,
    /// The samples and the results of all ticks, from which breakpoints and counterfactuals begin.
    past: SampleStore,
    results: Vec<TickResult>,
    /// The breakpoint that the newest tick has hit.
    hit: Option<String>,
    /// False if nobody watches. Then no frames are made.
    is_watched: bool,
    /// The frames that nobody has taken yet.
    made: Vec<Frame>,
}

/// The answer to a request for ticks.
#[derive(Debug, Serialize)]
pub(crate) struct Advanced {
    /// The number of ticks until now.
    ticks: usize,
    /// The simulated time (s).
    time: f64,
    has_ended: bool,
    /// The breakpoint at which the run has stopped.
    breakpoint: Option<String>,
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
        breakpoints: &[String],
    ) -> Result<(Self, ServerMessage), String> {
        let mut request = TrialRequest::new(Input::Text(Source::new("scenario.yaml", scenario)));
        request.policy = Some(PolicyInput::Text(Source::new("policy.fsm", policy)));
        request.world = Some(WorldKind::QuasiStatic);
        let prepared = request.prepare().map_err(|error| error.to_string())?;
        let (mut trial, text) = (prepared.trial, prepared.policy.text);
        trial.scene.stop.time = trial.scene.stop.time.min(LONGEST);
        let policy = text.as_ref().map(|text| Breakpoints::possible(text, breakpoints)).transpose();
        let policy = policy.map_err(|_| "the policy cannot be explained".to_owned())?;
        let policy = policy.map(|(policy, _)| Arc::new(policy));
        let setup = RunSetup::simulated(&trial, text.clone());
        let bound = |trial: &Trial| -> Result<Vec<usize>, String> {
            let control = trial.control().map_err(|error| error.to_string())?;
            Ok(control.perception().fitted().map(|(_, in_rig)| in_rig).collect())
        };
        let (mut hello, numbers, changeable) = hello(&setup, &trial.program, policy.as_deref(), &bound(&trial)?);
        trial.program = changeable.apply(&trial.program, None, set)?;
        for parameter in &mut hello.parameters {
            parameter.value = set.get(&parameter.name).copied().unwrap_or(parameter.value);
        }
        let frames = Frames::new(trial.assumed_rig.clone(), bound(&trial)?, Some(trial.scene.truth.clone()));
        let world = trial.world().map_err(|error| error.to_string())?;
        let run = trial.begin().map_err(|error| error.to_string())?;
        let hello = Arc::new(hello);
        let facts = RunFacts {
            hello: Arc::clone(&hello),
            numbers,
            changeable,
            rig: trial.assumed_rig.clone(),
            trial: Some(trial.clone()),
        };
        let shadow = shadow(&trial, policy)?;
        let past = SampleStore::new(trial.assumed_rig.whiskers.len());
        let watch = Watch {
            facts,
            start: shadow.clone(),
            shadow,
            frames,
            samples: Vec::new(),
            past,
            results: Vec::new(),
            hit: None,
            is_watched: true,
            made: Vec::new(),
        };
        let simulation = Self { trial, world, run: Some(run), ending: None, source: text, watch, counterfactual: None };
        Ok((simulation, ServerMessage::Hello(hello)))
    }

    /// Replaces the breakpoints by those of these texts, as far as the policy can have them. It must have the `new` one. The result
    /// has those that it can have.
    ///
    /// # Errors
    /// What is wrong with the new one, for people.
    pub(crate) fn set_breakpoints(
        &mut self,
        texts: &[String],
        new: Option<&String>,
    ) -> Result<Vec<BreakpointInfo>, String> {
        let source = self.source.as_ref().ok_or("this run has no breakpoints, because its policy has no text")?;
        let policy = breakpoints_with(source, texts, new).map_err(|fault| format!("this is no breakpoint: {fault}"))?;
        let infos = breakpoints(&policy);
        // The control loop that explains guards is made again, and executes all ticks until now.
        let mut shadow = shadow(&self.trial, Some(Arc::new(policy)))?;
        self.watch.start = shadow.clone();
        for tick in 0..self.watch.past.ticks() {
            let _ = shadow.tick(&self.watch.past.get(tick));
        }
        self.watch.shadow = shadow;
        Ok(infos)
    }

    /// Begins the answer to a question. An earlier one is forgotten.
    ///
    /// # Errors
    /// What cannot be done, for people.
    pub(crate) fn ask(&mut self, question: Question) -> Result<(), String> {
        self.counterfactual = None;
        self.counterfactual = Some(Counterfactual::begin(&self.watch, question)?);
        Ok(())
    }

    /// Executes ticks of the answer. The result is its next piece, as soon as it is full or the last one.
    ///
    /// # Errors
    /// What cannot be done, for people, or that there is no question.
    pub(crate) fn answer(&mut self, ticks: usize) -> Result<Option<Piece>, String> {
        let answer = self.counterfactual.as_mut().ok_or("there is no question")?;
        let piece = answer.advance(&self.watch, ticks)?;
        if piece.as_ref().is_some_and(|piece| piece.done) {
            self.counterfactual = None;
        }
        Ok(piece)
    }

    /// Simulates at most this number of ticks, and makes their frames if somebody watches.
    ///
    /// # Errors
    /// If the run has been scored.
    pub(crate) fn advance(&mut self, ticks: usize, is_watched: bool) -> Result<Advanced, String> {
        let run = self.run.as_mut().ok_or_else(scored)?;
        self.watch.is_watched = is_watched;
        self.watch.hit = None;
        for _ in 0..ticks {
            if self.ending.is_some() || self.watch.hit.is_some() {
                break;
            }
            match run.step(self.world.as_mut(), &mut self.watch) {
                Step::Running | Step::Interrupted => {}
                Step::Ended(ending) => self.ending = Some(ending),
            }
        }
        let trace = run.trace();
        Ok(Advanced {
            ticks: trace.ticks.len(),
            time: trace.ticks.last().map_or(0.0, |tick| tick.time),
            has_ended: self.ending.is_some(),
            breakpoint: self.watch.hit.clone(),
        })
    }

    /// Takes the frames that have been made since they were taken last.
    pub(crate) fn take_frames(&mut self) -> Vec<Frame> {
        std::mem::take(&mut self.watch.made)
    }

    /// The ticks until now, as lines of JSON.
    ///
    /// # Errors
    /// If the run has been scored.
    pub(crate) fn ticks(&self) -> Result<Vec<String>, String> {
        let run = self.run.as_ref().ok_or_else(scored)?;
        let friction = self.trial.assumed_rig.sensing.friction;
        let lines = tick_lines(&self.trial.scene.name, run.trace(), friction);
        Ok(lines.map(|line| json!(line.versioned(None)).to_string()).collect())
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

/// The control loop that explains the guards of a policy, before the first tick. Its registers are those of the explanation.
fn shadow(trial: &Trial, policy: Option<Arc<Breakpoints>>) -> Result<Shadow, String> {
    let explained = policy.as_ref().map(|policy| Arc::new(policy.explained.with_parameters_of(&trial.program)));
    let program = explained.unwrap_or_else(|| Arc::clone(&trial.program));
    let control = Trial { program, ..trial.clone() }.control().map_err(|error| error.to_string())?;
    Ok(Shadow::new(control, policy))
}

impl PastRun for Watch {
    fn facts(&self) -> &RunFacts {
        &self.facts
    }

    fn sampled(&self) -> usize {
        self.past.ticks()
    }

    fn samples(&self, tick: usize) -> Vec<Sample> {
        self.past.get(tick)
    }

    fn result(&self, tick: usize) -> Option<TickResult> {
        self.results.get(tick).copied()
    }

    fn checkpoint(&self, _: usize) -> Option<(usize, Box<Shadow>)> {
        Some((0, Box::new(self.start.clone())))
    }
}

impl Observer for Watch {}

impl Watcher for Watch {
    fn before_tick(&mut self, samples: &[Sample]) {
        self.samples.clear();
        self.samples.extend_from_slice(samples);
    }

    fn after_tick(&mut self, trace: &Trace) -> ControlFlow<()> {
        if self.is_watched {
            let facts = &self.facts;
            (_, self.hit) = self.shadow.tick(&self.samples);
            let frame = self.frames.frame(trace, (&self.shadow, &facts.numbers, &facts.hello.chart), None);
            if let (Some(frame), Some(tick)) = (frame, trace.ticks.last()) {
                let state = tick.state.filter(|_| !self.shadow.has_ended());
                let taken = frame.taken.last().copied();
                self.results.push(TickResult { time: tick.time, state, taken, command: tick.command });
                self.past.push(&self.samples);
                self.made.push(frame);
            }
        }
        ControlFlow::Continue(())
    }
}
