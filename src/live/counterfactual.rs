//! What a changed policy would have done.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::{Observer, Program, TransitionId};
use vibrissa_runtime::signal::{Command, Sample};

use super::log::{RunLog, TickResult};
use vibrissa_lab::run::{Ending, Step, Trace, Watcher};
use vibrissa_lab::stream::message::{CounterfactualFrame, CounterfactualKind, FirstDifference, Piece};
use vibrissa_lab::trial::Trial;

/// The number of ticks in a piece. The first one is shorter, so that an answer appears at once.
const PIECE: usize = 300;
const FIRST_PIECE: usize = 60;

/// A question of a page.
#[derive(Debug, Clone)]
pub(super) struct Question {
    /// Its number.
    pub(super) id: u64,
    /// The first tick with the change.
    pub(super) tick: usize,
    /// The kind.
    pub(super) kind: CounterfactualKind,
    /// The changed values.
    pub(super) values: BTreeMap<String, f64>,
}

/// Answers a question in pieces, which `send` receives. It returns false if nobody waits for them. `is_canceled` ends the answer.
///
/// # Errors
/// What cannot be done, for people.
pub(super) fn answer(
    log: &Arc<RunLog>,
    question: &Question,
    is_canceled: &AtomicBool,
    send: impl FnMut(Piece) -> bool,
) -> Result<(), String> {
    let ticks = log.past().sampled();
    if question.tick >= ticks {
        return Err(format!("the run has {ticks} ticks until now; choose an earlier tick"));
    }
    let answer = Answer {
        log,
        id: question.id,
        kind: question.kind,
        frames: Vec::new(),
        pieces: 0,
        first: None,
        send,
        is_canceled,
    };
    match question.kind {
        CounterfactualKind::Recorded => recorded(question, answer),
        CounterfactualKind::ClosedLoop => closed_loop(question, answer),
    }
}

/// An answer that grows.
struct Answer<'l, S> {
    log: &'l Arc<RunLog>,
    id: u64,
    kind: CounterfactualKind,
    frames: Vec<CounterfactualFrame>,
    pieces: usize,
    first: Option<FirstDifference>,
    send: S,
    is_canceled: &'l AtomicBool,
}

impl<S: FnMut(Piece) -> bool> Answer<'_, S> {
    /// Adds a tick. `before` is that of the run, if it has one. The result is false if nobody waits for the answer.
    fn push(&mut self, frame: CounterfactualFrame, before: Option<&TickResult>, after: &TickResult) -> bool {
        // Where the states differ is of more interest, so it replaces the first difference of the commands.
        if self.first.as_ref().is_none_or(|first| !first.states_differ)
            && let Some(before) = before
        {
            let states_differ = before.state != after.state;
            if states_differ || (self.first.is_none() && bits(before.command) != bits(after.command)) {
                let [was, is] = [before, after].map(|result| self.log.phrase(result));
                let (tick, time) = (frame.tick, frame.time);
                self.first = Some(FirstDifference { tick, time, states_differ, before: was, after: is });
            }
        }
        self.frames.push(frame);
        let full = if self.pieces == 0 { FIRST_PIECE } else { PIECE };
        self.frames.len() < full || self.send_piece(None)
    }

    fn send_piece(&mut self, end: Option<String>) -> bool {
        self.pieces += 1;
        let frames = std::mem::take(&mut self.frames);
        let (id, kind, first_difference) = (self.id, self.kind, self.first.clone());
        let is_wanted = (self.send)(Piece { id, kind, frames, first_difference, done: end.is_some(), end });
        is_wanted && !self.is_canceled.load(Ordering::Relaxed)
    }

    /// Ends the answer.
    fn finish(mut self, end: &str) {
        let end = if self.is_canceled.load(Ordering::Relaxed) { "canceled" } else { end };
        self.send_piece(Some(end.to_owned()));
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

impl Taken {
    /// The result of a tick of a control loop.
    fn result(&self, log: &RunLog, control: &Control, command: Command) -> TickResult {
        let machine = control.machine();
        let has_ended = machine.failure().is_some() || machine.success().is_some();
        let taken = self.0.last().and_then(|&id| log.numbers.number(id));
        let state = (!has_ended).then(|| machine.state());
        TickResult { time: control.perception().time(), state, taken, command }
    }
}

/// The changed policy has the recorded samples. Its commands move nothing, so perception is given the recorded ones.
fn recorded<S: FnMut(Piece) -> bool>(question: &Question, mut answer: Answer<'_, S>) -> Result<(), String> {
    let log = answer.log;
    let checkpoint = log.past().checkpoint(question.tick);
    let (mut tick, shadow) = checkpoint.ok_or("the beginning of the run is not known")?;
    let program = log.changeable.apply(shadow.control().machine().program(), shadow.policy(), &question.values)?;
    let mut control = shadow.control().clone();
    while tick < question.tick {
        control.tick(&log.past().samples(tick));
        tick += 1;
    }
    let mut control = changed(control, tick, program, log)?;
    loop {
        // The samples of a piece at once, so that a run that goes on does not wait for the answer.
        let piece: Vec<(Vec<Sample>, Option<TickResult>)> = {
            let past = log.past();
            let end = past.sampled().min(tick + FIRST_PIECE);
            (tick..end).map(|tick| (past.samples(tick), past.ticks.get(tick).copied())).collect()
        };
        if piece.is_empty() {
            answer.finish("end of the run");
            return Ok(());
        }
        for (samples, before) in piece {
            let mut taken = Taken::default();
            let (command, _) = control.tick_observed(&samples, &mut taken);
            if let Some(before) = &before {
                control.replace_command(before.command);
            }
            let after = taken.result(log, &control, command);
            let states = log.hello.chart.path(after.state);
            let frame = CounterfactualFrame { tick, time: after.time, states, pose: None, contour: Vec::new() };
            if !answer.push(frame, before.as_ref(), &after) {
                answer.finish("canceled");
                return Ok(());
            }
            tick += 1;
        }
    }
}

/// The control loop with the changed program. Before the first tick it is a new one, because values at the start may depend on
/// parameters.
fn changed(mut control: Control, tick: usize, program: Arc<Program>, log: &RunLog) -> Result<Control, String> {
    if tick > 0 {
        control.continue_with(program);
        return Ok(control);
    }
    Control::simulated(&log.rig, program).map_err(|error| error.to_string())
}

/// The changed policy steers the platform in a simulation, which repeats the run until the tick of the change.
fn closed_loop<S: FnMut(Piece) -> bool>(question: &Question, mut answer: Answer<'_, S>) -> Result<(), String> {
    let log = answer.log;
    let unknown = "the world of this run cannot be simulated again; ask over its recorded perception instead";
    let trial = log.trial.as_ref().ok_or(unknown)?;
    let start = log.past().checkpoint(0).ok_or("the beginning of the run is not known")?.1;
    let own = Arc::new(start.control().machine().program().clone());
    let changed = log.changeable.apply(&own, start.policy(), &question.values)?;
    let first = if question.tick == 0 { Arc::clone(&changed) } else { own };
    let trial = Trial { program: first, ..trial.clone() };
    let mut world = trial.world().map_err(|error| error.to_string())?;
    let mut run = trial.begin().map_err(|error| error.to_string())?;
    let mut tick = 0;
    let ending = loop {
        if tick == question.tick && tick > 0 {
            run.continue_with(Arc::clone(&changed));
        }
        let mut taken = Taken::default();
        let step = run.step(world.as_mut(), &mut taken);
        if tick >= question.tick
            && let Some(record) = run.trace().ticks.get(tick)
        {
            let after = taken.result(log, run.control(), run.command());
            let before = log.past().ticks.get(tick).copied();
            let body = record.body;
            let frame = CounterfactualFrame {
                tick,
                time: after.time,
                states: log.hello.chart.path(after.state),
                pose: Some([body.position.x, body.position.y, body.heading]),
                contour: record.tips.iter().flatten().map(|tip| [tip.x, tip.y]).collect(),
            };
            if !answer.push(frame, before.as_ref(), &after) {
                answer.finish("canceled");
                return Ok(());
            }
        } else if answer.is_canceled.load(Ordering::Relaxed) {
            answer.finish("canceled");
            return Ok(());
        }
        match step {
            Step::Running => {}
            Step::Ended(ending) => break ending,
            Step::Interrupted => break Ending { outcome: vibrissa_world::scene::Outcome::Failed, reason: None },
        }
        tick += 1;
    };
    answer.finish(ending.outcome.name());
    Ok(())
}

impl Watcher for Taken {
    fn after_tick(&mut self, _: &Trace) -> std::ops::ControlFlow<()> {
        std::ops::ControlFlow::Continue(())
    }
}

/// The bits of a command.
fn bits(command: Command) -> [u64; 3] {
    [command.velocity_world.x, command.velocity_world.y, command.yaw_rate].map(f64::to_bits)
}
