//! What a changed policy would have done.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::Arc;

use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::{Observer, Program, TransitionId};
use vibrissa_runtime::rig::Rig;
use vibrissa_runtime::signal::{Command, Sample};

use super::change::Changeable;
use super::guards::GuardNumbers;
use super::message::{CounterfactualFrame, CounterfactualKind, FirstDifference, Hello, Piece};
use super::shadow::Shadow;
use crate::run::{Step, SteppedRun, Trace, Watcher};
use crate::trial::Trial;
use vibrissa_world::world::World;

/// The number of ticks in a piece. The first one is shorter, so that an answer appears at once.
const PIECE: usize = 300;
const FIRST_PIECE: usize = 60;

/// A question of a page.
#[derive(Debug, Clone)]
pub struct Question {
    /// Its number.
    pub id: u64,
    /// The first tick with the change.
    pub tick: usize,
    /// The kind.
    pub kind: CounterfactualKind,
    /// The changed values (SI).
    pub values: BTreeMap<String, f64>,
}

/// The result of a tick, with which a counterfactual is compared.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TickResult {
    /// Time since the start of the run (s).
    pub time: f64,
    /// The innermost active state. `None` after the end of the machine.
    pub state: Option<usize>,
    /// The last transition that was taken, by the number of its guard.
    pub taken: Option<usize>,
    /// The command.
    pub command: Command,
}

/// What does not change during a run, as far as a counterfactual needs it.
#[derive(Debug, Clone)]
pub struct RunFacts {
    /// The first message.
    pub hello: Arc<Hello>,
    /// The numbers of the guards.
    pub numbers: GuardNumbers,
    /// The values that may be changed.
    pub changeable: Changeable,
    /// The rig that control assumes.
    pub rig: Rig,
    /// The trial, if its world can be simulated again.
    pub trial: Option<Trial>,
}

impl RunFacts {
    /// What a transition or a state is called.
    fn phrase(&self, result: &TickResult) -> String {
        if let Some(guard) = result.taken.and_then(|guard| self.hello.guards.get(guard)) {
            return format!("{} -> {}", guard.text, guard.target);
        }
        let state = result.state.and_then(|state| self.hello.chart.states.get(state));
        state.map_or_else(|| "has ended".to_owned(), |state| format!("stays in {}", state.name))
    }
}

/// What a run has done until now.
pub trait PastRun {
    /// What does not change.
    fn facts(&self) -> &RunFacts;
    /// The number of ticks whose samples are known.
    fn sampled(&self) -> usize;
    /// The samples of a tick.
    fn samples(&self, tick: usize) -> Vec<Sample>;
    /// The result of a tick, if the run has one.
    fn result(&self, tick: usize) -> Option<TickResult>;
    /// A copy of the control loop that has executed at most this number of ticks, with their number.
    fn checkpoint(&self, ticks: usize) -> Option<(usize, Box<Shadow>)>;
}

/// A counterfactual that is being computed.
pub struct Counterfactual {
    question: Question,
    course: Course,
    frames: Vec<CounterfactualFrame>,
    pieces: usize,
    first: Option<FirstDifference>,
}

/// How the changed policy gets its samples.
enum Course {
    Recorded(Box<Recorded>),
    ClosedLoop(Box<ClosedLoop>),
}

/// The changed policy has the recorded samples. Its commands move nothing, so perception is given the recorded ones.
struct Recorded {
    control: Control,
    changed: Arc<Program>,
    tick: usize,
}

/// The changed policy steers the platform in a simulation, which repeats the run until the tick of the change.
struct ClosedLoop {
    world: Box<dyn World>,
    run: SteppedRun,
    changed: Arc<Program>,
    tick: usize,
}

impl Counterfactual {
    /// Begins an answer.
    ///
    /// # Errors
    /// What cannot be done, for people.
    pub fn begin(past: &impl PastRun, question: Question) -> Result<Self, String> {
        let ticks = past.sampled();
        if question.tick >= ticks {
            return Err(format!("the run has {ticks} ticks until now; choose an earlier tick"));
        }
        let course = match question.kind {
            CounterfactualKind::Recorded => Course::Recorded(Box::new(Recorded::begin(past, &question)?)),
            CounterfactualKind::ClosedLoop => Course::ClosedLoop(Box::new(ClosedLoop::begin(past, &question)?)),
        };
        Ok(Self { question, course, frames: Vec::new(), pieces: 0, first: None })
    }

    /// Its question.
    #[must_use]
    pub fn question(&self) -> &Question {
        &self.question
    }

    /// Executes at most this number of ticks. The result is the next piece, as soon as it is full or the last one.
    ///
    /// # Errors
    /// What cannot be done, for people.
    pub fn advance(&mut self, past: &impl PastRun, ticks: usize) -> Result<Option<Piece>, String> {
        for _ in 0..ticks {
            let (frame, before, after, end) = match &mut self.course {
                Course::Recorded(recorded) => match recorded.step(past, self.question.tick)? {
                    Some((frame, after)) => (frame, past.result(recorded.tick - 1), after, None),
                    None if recorded.tick >= past.sampled() => {
                        return Ok(Some(self.piece(Some("end of the run".to_owned()))));
                    }
                    None => continue,
                },
                Course::ClosedLoop(closed) => {
                    let (made, end) = closed.step(past, self.question.tick);
                    match made {
                        Some((frame, after)) => {
                            let before = past.result(frame.tick);
                            (frame, before, after, end)
                        }
                        None if end.is_some() => return Ok(Some(self.piece(end))),
                        None => continue,
                    }
                }
            };
            self.compare(past.facts(), (frame.tick, frame.time), before.as_ref(), &after);
            self.frames.push(frame);
            let full = if self.pieces == 0 { FIRST_PIECE } else { PIECE };
            if end.is_some() || self.frames.len() >= full {
                return Ok(Some(self.piece(end)));
            }
        }
        Ok(None)
    }

    /// Ends the answer before its time. The result is its last piece.
    #[must_use]
    pub fn cancel(&mut self) -> Piece {
        self.piece(Some("canceled".to_owned()))
    }

    /// Compares a tick with that of the run, if it has one. Where the states differ is of more interest, so it replaces the first
    /// difference of the commands.
    fn compare(&mut self, facts: &RunFacts, place: (usize, f64), before: Option<&TickResult>, after: &TickResult) {
        if self.first.as_ref().is_none_or(|first| !first.states_differ)
            && let Some(before) = before
        {
            let states_differ = before.state != after.state;
            if states_differ || (self.first.is_none() && bits(before.command) != bits(after.command)) {
                let [was, is] = [before, after].map(|result| facts.phrase(result));
                let (tick, time) = place;
                self.first = Some(FirstDifference { tick, time, states_differ, before: was, after: is });
            }
        }
    }

    fn piece(&mut self, end: Option<String>) -> Piece {
        self.pieces += 1;
        Piece {
            id: self.question.id,
            kind: self.question.kind,
            frames: std::mem::take(&mut self.frames),
            first_difference: self.first.clone(),
            done: end.is_some(),
            end,
        }
    }
}

/// The guards of the transitions that are taken in a tick.
#[derive(Default)]
struct Taken(Vec<TransitionId>);

impl Observer for Taken {
    fn taken(&mut self, transition: TransitionId) {
        self.0.push(transition);
    }
}

impl Watcher for Taken {
    fn after_tick(&mut self, _: &Trace) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

impl Taken {
    /// The result of a tick of a control loop.
    fn result(&self, facts: &RunFacts, control: &Control, command: Command) -> TickResult {
        let machine = control.machine();
        let has_ended = machine.failure().is_some() || machine.success().is_some();
        let taken = self.0.last().and_then(|&id| facts.numbers.number(id));
        let state = (!has_ended).then(|| machine.state());
        TickResult { time: control.perception().time(), state, taken, command }
    }
}

impl Recorded {
    fn begin(past: &impl PastRun, question: &Question) -> Result<Self, String> {
        let (tick, shadow) = past.checkpoint(question.tick).ok_or("the beginning of the run is not known")?;
        let program = shadow.control().machine().program();
        let changed = past.facts().changeable.apply(program, shadow.policy(), &question.values)?;
        Ok(Self { control: shadow.control().clone(), changed, tick })
    }

    /// Executes a tick. The result is empty before the tick of the change, and at the end.
    fn step(&mut self, past: &impl PastRun, first: usize) -> Result<Option<(CounterfactualFrame, TickResult)>, String> {
        if self.tick >= past.sampled() {
            return Ok(None);
        }
        if self.tick == first {
            let program = Arc::clone(&self.changed);
            if first > 0 {
                self.control.continue_with(program);
            } else {
                // A new one, because values at the start may depend on parameters.
                self.control = Control::simulated(&past.facts().rig, program).map_err(|error| error.to_string())?;
            }
        }
        let samples = past.samples(self.tick);
        if self.tick < first {
            self.control.tick(&samples);
            self.tick += 1;
            return Ok(None);
        }
        let mut taken = Taken::default();
        let (command, _) = self.control.tick_observed(&samples, &mut taken);
        if let Some(before) = past.result(self.tick) {
            self.control.replace_command(before.command);
        }
        let after = taken.result(past.facts(), &self.control, command);
        let states = past.facts().hello.chart.path(after.state);
        let frame = CounterfactualFrame { tick: self.tick, time: after.time, states, pose: None, contour: Vec::new() };
        self.tick += 1;
        Ok(Some((frame, after)))
    }
}

impl ClosedLoop {
    fn begin(past: &impl PastRun, question: &Question) -> Result<Self, String> {
        let facts = past.facts();
        let unknown = "the simulator of this run cannot be simulated again; ask over its recorded perception instead";
        let trial = facts.trial.as_ref().ok_or(unknown)?;
        let start = past.checkpoint(0).ok_or("the beginning of the run is not known")?.1;
        let own = Arc::new(start.control().machine().program().clone());
        let changed = facts.changeable.apply(&own, start.policy(), &question.values)?;
        let first = if question.tick == 0 { Arc::clone(&changed) } else { own };
        let trial = Trial { program: first, ..trial.clone() };
        let world = trial.world().map_err(|error| error.to_string())?;
        let run = trial.begin().map_err(|error| error.to_string())?;
        Ok(Self { world, run, changed, tick: 0 })
    }

    /// Executes a tick. It has a frame from the tick of the change on, and at the end the outcome.
    fn step(
        &mut self,
        past: &impl PastRun,
        first: usize,
    ) -> (Option<(CounterfactualFrame, TickResult)>, Option<String>) {
        if self.tick == first && first > 0 {
            self.run.continue_with(Arc::clone(&self.changed));
        }
        let mut taken = Taken::default();
        let step = self.run.step(self.world.as_mut(), &mut taken);
        let record = self.run.trace().ticks.get(self.tick).filter(|_| self.tick >= first);
        let made = record.map(|record| {
            let after = taken.result(past.facts(), self.run.control(), self.run.command());
            let body = record.body;
            let frame = CounterfactualFrame {
                tick: self.tick,
                time: after.time,
                states: past.facts().hello.chart.path(after.state),
                pose: Some([body.position.x, body.position.y, body.heading]),
                contour: record.tips().map(|tip| [tip.x, tip.y]).collect(),
            };
            (frame, after)
        });
        self.tick += 1;
        let end = match step {
            Step::Running => None,
            Step::Ended(ending) => Some(ending.outcome.name().to_owned()),
            Step::Interrupted => Some(vibrissa_world::scene::Outcome::Failed.name().to_owned()),
        };
        (made, end)
    }
}

/// The bits of a command.
fn bits(command: Command) -> [u64; 3] {
    [command.velocity_world.x, command.velocity_world.y, command.yaw_rate].map(f64::to_bits)
}
