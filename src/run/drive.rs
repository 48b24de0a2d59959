//! A whole run.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use crate::geometry::{Point2, Vector2};
use crate::scene::{Outcome, Reached, Stop};
use crate::world::{Fault, World};
use vibrissa_runtime::machine::{Fallback, Senses, Status, WhiskerScalar, WhiskerVector};
use vibrissa_runtime::percept::Perception;
use vibrissa_runtime::signal::{Command, MAX_WHISKERS};

use super::loop_watch::LoopWatch;
use super::stall_watch::StallWatch;
use super::trace::{Contact, MarkRecord, TickRecord, Trace};
use vibrissa_runtime::control::Control;

/// The result of the control loop.
#[derive(Debug, Clone)]
pub struct Run {
    /// The outcome.
    pub outcome: Outcome,
    /// Reason of the outcome. `None` for a completed run.
    pub reason: Option<String>,
    /// Name of the last state.
    pub final_state: String,
    /// The trace.
    pub trace: Trace,
    /// Wall time of the loop alone.
    pub wall: Duration,
    /// Wall time from the request of the run to the end of its first tick. The control loop sets it to the time of the
    /// first samples and their tick. Its caller adds the time of reading, compiling and building.
    pub start: Duration,
    /// Wall time of each control tick: perception, machine and motion.
    pub tick_times: Vec<Duration>,
}

/// Initial capacity in ticks, an hour at 30 Hz. A longer run allocates more.
const INITIAL_CAPACITY: usize = 108_000;

/// Runs `control` in `world` until `stop`. `progress` receives the trace at every tick, and may stop the run. Then the
/// result is `None`.
pub fn drive(
    world: &mut dyn World,
    mut control: Control,
    stop: &Stop,
    period: f64,
    mut progress: impl FnMut(&Trace) -> ControlFlow<()>,
) -> Option<Run> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the number of ticks of a run")]
    let most_ticks = (stop.time / period).ceil() as usize;
    let program = control.machine().program();
    let mut trace = Trace {
        whiskers: control.perception().fitted().map(|(whisker, _)| program.whiskers[whisker].clone()).collect(),
        states: program.states.iter().map(|state| state.name.to_string()).collect(),
        parents: program.states.iter().map(|state| state.parent).collect(),
        period,
        ticks: Vec::with_capacity(most_ticks.min(INITIAL_CAPACITY)),
        marks: Vec::new(),
        crashed: false,
    };
    let mut tick_times = Vec::with_capacity(most_ticks.min(INITIAL_CAPACITY));
    let mut watches: [LoopWatch; MAX_WHISKERS] = Default::default();
    let mut stall_watch = stop.stalled.map(StallWatch::new);
    let mut command = Command::STOP;
    let (start, mut first_tick) = (Instant::now(), Duration::ZERO);
    let (outcome, reason) = loop {
        let samples = match world.advance(&command) {
            Ok(samples) => samples,
            Err(fault) => {
                trace.crashed = matches!(fault, Fault::Crash { .. });
                let outcome = if trace.crashed { Outcome::Failed } else { Outcome::Diverged };
                break (outcome, Some(fault.to_string()));
            }
        };
        let before_tick = Instant::now();
        let (next, ticked) = control.tick(samples);
        tick_times.push(before_tick.elapsed());
        if trace.ticks.is_empty() {
            first_tick = start.elapsed();
        }
        command = next;

        let tick = record(&control, command, ticked.fallback, world);
        trace.marks.extend(marks(&control, trace.ticks.len()));
        trace.ticks.push(tick);
        if progress(&trace).is_break() {
            return None;
        }
        if ticked.status == Status::Failed {
            break (Outcome::Failed, control.machine().failure().map(ToString::to_string));
        }
        if let Some(aim) = &stop.loop_closed
            && watches
                .iter_mut()
                .zip(tick.tips)
                .any(|(watch, tip)| watch.closes(tick.time, tip, tick.body.position, aim))
        {
            break (Outcome::Completed, None);
        }
        if stop.reached.is_some_and(|aim| is_reached(&tick, &aim)) {
            break (Outcome::Completed, None);
        }
        if let Some(reason) = stall_watch.as_mut().and_then(|watch| watch.stalls(&tick)) {
            break (Outcome::Failed, Some(reason));
        }
        if trace.ticks.len() >= most_ticks {
            break match stop {
                Stop { loop_closed: None, reached: None, .. } => (Outcome::Completed, None),
                Stop { loop_closed: None, .. } => {
                    (Outcome::Timeout, Some(format!("the place was not reached within {} s", stop.time)))
                }
                Stop { .. } => (Outcome::Timeout, Some(format!("the loop did not close within {} s", stop.time))),
            };
        }
    };
    let final_state = control.machine().state_name().to_owned();
    Some(Run { outcome, reason, final_state, trace, wall: start.elapsed(), start: first_tick, tick_times })
}

/// True if the platform has reached the position of `aim`.
fn is_reached(tick: &TickRecord, aim: &Reached) -> bool {
    tick.time >= aim.after && (tick.body.position - aim.place).norm() <= aim.within
}

/// The marks of the tick with this index.
fn marks(control: &Control, tick: usize) -> impl Iterator<Item = MarkRecord> {
    control.perception().fitted().enumerate().flat_map(move |(whisker, (bound, _))| {
        let marks = control.perception().marks(bound);
        marks.map(move |(mark, tip_world)| MarkRecord { mark, whisker, tick, tip_world })
    })
}

fn record(control: &Control, command: Command, fallback: Option<Fallback>, world: &dyn World) -> TickRecord {
    let (perception, machine) = (control.perception(), control.machine());
    let mut tick = TickRecord {
        time: perception.time(),
        body: perception.pose(),
        state: machine.failure().is_none().then(|| machine.state()),
        deflections: [0.0; MAX_WHISKERS],
        tips: [None; MAX_WHISKERS],
        contacts: Default::default(),
        tip_deviations: [0.0; MAX_WHISKERS],
        command,
        fallback,
        tip_ends: [None; MAX_WHISKERS],
        body_touches: world.body_touches(),
        snap_offs: [false; MAX_WHISKERS],
    };
    for (whisker, (bound, in_rig)) in perception.fitted().enumerate() {
        tick.snap_offs[whisker] = world.snapped_off(in_rig);
        tick.tip_ends[whisker] = Some(world.tip(in_rig));
        tick.deflections[whisker] = perception.base_angle(bound);
        tick.tips[whisker] = perception.recorded_tip(bound);
        tick.contacts[whisker] = contact(perception, bound);
        tick.tip_deviations[whisker] = perception.recorded_deviation(bound);
    }
    tick
}

fn contact(perception: &Perception, whisker: usize) -> Contact {
    let known = |vector: Vector2| vector.iter().all(|part| part.is_finite()).then_some(vector);
    let vector = |quantity| known(perception.whisker_vector(whisker, quantity));
    Contact {
        is_touching: perception.whisker(whisker, WhiskerScalar::Touching) > 0.0,
        tip_world: vector(WhiskerVector::Tip).map(Point2::from),
        tangent_world: vector(WhiskerVector::ContourTangent),
    }
}
