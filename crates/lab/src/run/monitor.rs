//! The monitor of a run: it records the trace and decides when the run ends.

use std::time::Duration;

use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::{Fallback, LoggedMessage, Machine, Senses, Status, Tick, WhiskerScalar, WhiskerVector};
use vibrissa_runtime::map::Map;
use vibrissa_runtime::percept::{LoopWatch, Perception};
use vibrissa_runtime::signal::{Command, MAX_WHISKERS};
use vibrissa_world::geometry::{Point2, Vector2};
use vibrissa_world::scene::{Goal, Outcome, Reached, Stop};
use vibrissa_world::world::{Fault, World};

use super::contract::ContractRecord;
use super::drive::Run;
use super::passage_watch::PassageWatch;
use super::run_map::GrowthRecord;
use super::stall_watch::StallWatch;
use super::stopwatch::Stopwatch;
use super::trace::{Contact, MESSAGES_KEPT, MarkRecord, MessageRecord, PlotRecord, TickRecord, Trace, WhiskerRecord};

/// Initial capacity in ticks, an hour at 30 Hz. A longer run allocates more.
const INITIAL_CAPACITY: usize = 108_000;

/// Records the ticks of a control loop, and decides when the run ends.
#[derive(Debug)]
pub struct Monitor {
    trace: Trace,
    tick_times: Vec<Duration>,
    loops: [LoopWatch; MAX_WHISKERS],
    passages: Vec<PassageWatch>,
    stall: Option<StallWatch>,
    /// `None` without a map.
    growth: Option<GrowthRecord>,
    stop: Stop,
    most_ticks: usize,
    start: Stopwatch,
    first_tick: Option<Duration>,
}

/// The end of a run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Ending {
    /// The outcome.
    pub outcome: Outcome,
    /// Its reason. `None` if a stop condition completed the run.
    pub reason: Option<String>,
}

impl Ending {
    const COMPLETED: Self = Self { outcome: Outcome::Completed, reason: None };

    fn failed(reason: Option<String>) -> Self {
        Self { outcome: Outcome::Failed, reason }
    }

    fn timeout(reason: String) -> Self {
        Self { outcome: Outcome::Timeout, reason: Some(reason) }
    }
}

impl Monitor {
    /// A monitor of `control` until `goal`, with this control period (s). The run begins now.
    #[must_use]
    pub fn new(control: &Control, Goal { stop, tunnels }: Goal<'_>, period: f64) -> Self {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the number of ticks of a run")]
        let most_ticks = (stop.time / period).ceil() as usize;
        let program = control.machine().program();
        let trace = Trace {
            whiskers: control.perception().fitted().map(|(whisker, _)| program.whiskers[whisker].clone()).collect(),
            states: program.states.iter().map(|state| state.name.to_string()).collect(),
            parents: program.states.iter().map(|state| state.parent).collect(),
            period,
            ticks: Vec::with_capacity(most_ticks.min(INITIAL_CAPACITY)),
            marks: Vec::new(),
            plots: (program.outputs.plots.iter())
                .map(|plot| PlotRecord { name: plot.name.clone(), kind: plot.kind.clone(), values: Vec::new() })
                .collect(),
            messages: Vec::new(),
            further_messages: 0,
            crashed: false,
        };
        Self {
            trace,
            tick_times: Vec::with_capacity(most_ticks.min(INITIAL_CAPACITY)),
            loops: Default::default(),
            passages: if stop.passed.is_some() { tunnels.iter().map(PassageWatch::new).collect() } else { Vec::new() },
            stall: stop.stalled.map(StallWatch::new),
            growth: control.map().map(|_| GrowthRecord::new()),
            stop: *stop,
            most_ticks,
            start: Stopwatch::start(),
            first_tick: None,
        }
    }

    /// The trace so far.
    #[must_use]
    pub fn trace(&self) -> &Trace {
        &self.trace
    }

    /// Notes the wall time of the tick that [`observe`](Self::observe) receives next.
    pub fn tick_took(&mut self, duration: Duration) {
        self.tick_times.push(duration);
        self.first_tick.get_or_insert_with(|| self.start.elapsed());
    }

    /// The ending after a fault of the world.
    pub fn crashed(&mut self, fault: &Fault) -> Ending {
        self.trace.crashed = matches!(fault, Fault::Crash { .. });
        let outcome = if self.trace.crashed { Outcome::Failed } else { Outcome::Diverged };
        Ending { outcome, reason: Some(fault.to_string()) }
    }

    /// Records a tick. The result is the ending if the run ends with it.
    pub fn observe(&mut self, control: &Control, command: Command, ticked: &Tick, world: &dyn World) -> Option<Ending> {
        let tick = record(control, command, ticked.fallback, world);
        self.trace.marks.extend(marks(control, self.trace.ticks.len()));
        self.record_outputs(control.machine());
        if let (Some(growth), Some(map)) = (&mut self.growth, control.map()) {
            growth.add(self.trace.ticks.len(), map);
        }
        let ending = self.ending(control, ticked.status, &tick);
        self.trace.ticks.push(tick);
        ending
    }

    /// The ending if the run ends with this tick, which is recorded next.
    fn ending(&mut self, control: &Control, status: Status, tick: &TickRecord) -> Option<Ending> {
        if status == Status::Failed {
            return Some(Ending::failed(control.machine().failure().map(ToString::to_string)));
        }
        if status == Status::Succeeded {
            return Some(Ending { reason: control.machine().success().map(str::to_owned), ..Ending::COMPLETED });
        }
        if let Some(aim) = &self.stop.loop_closed {
            for (watch, whisker) in self.loops.iter_mut().zip(&tick.whiskers) {
                watch.update(tick.time, whisker.tip, tick.body.position);
            }
            if self.loops.iter().any(|watch| watch.is_closed(aim.within, aim.after)) {
                return Some(Ending::COMPLETED);
            }
        }
        if self.stop.reached.is_some_and(|aim| is_reached(tick, &aim)) {
            return Some(Ending::COMPLETED);
        }
        if let Some(share) = self.stop.passed {
            for passage in &mut self.passages {
                passage.add(&tick.body);
            }
            if self.passages.iter().any(|passage| passage.share() >= share) {
                return Some(Ending::COMPLETED);
            }
        }
        if self.stop.mapped && control.map().is_some_and(Map::is_complete) {
            return Some(Ending::COMPLETED);
        }
        if let Some(reason) = self.stall.as_mut().and_then(|watch| watch.stalls(tick)) {
            return Some(Ending::failed(Some(reason)));
        }
        if self.trace.ticks.len() + 1 < self.most_ticks {
            return None;
        }
        let time = self.stop.time;
        let missing = match self.stop {
            Stop { loop_closed: Some(_), .. } => "the loop did not close",
            Stop { reached: Some(_), .. } => "the position was not reached",
            Stop { passed: Some(_), .. } => "the tunnel was not passed",
            Stop { mapped: true, .. } => "the map was not complete",
            Stop { succeeded: true, .. } => "the policy did not end in `Success`",
            Stop { .. } => return Some(Ending::COMPLETED),
        };
        Some(Ending::timeout(format!("{missing} within {time} s")))
    }

    /// Replaces the command of the newest tick.
    pub fn replace_command(&mut self, command: Command) {
        if let Some(newest) = self.trace.ticks.last_mut() {
            newest.command = command;
        }
    }

    /// Records the plots and messages of the tick that is recorded next.
    fn record_outputs(&mut self, machine: &Machine) {
        let tick = self.trace.ticks.len();
        for (plot, value) in machine.plotted() {
            self.trace.plots[plot].values.push((tick, value));
        }
        let program = machine.program();
        for LoggedMessage { message, numbers } in machine.logged() {
            if self.trace.messages.len() == MESSAGES_KEPT {
                self.trace.further_messages += 1;
                continue;
            }
            let message = &program.outputs.messages[message];
            let (state, message) = (message.state, message.shown(&numbers, &program.whiskers));
            self.trace.messages.push(MessageRecord { tick, state, message });
        }
    }

    /// The finished run.
    #[must_use]
    pub fn finish(self, control: &Control, ending: Ending) -> Run {
        let machine = control.machine();
        Run {
            outcome: ending.outcome,
            reason: ending.reason,
            final_state: machine.state_name().to_owned(),
            trace: self.trace,
            map: self.growth.and_then(|growth| growth.finish(control)),
            contracts: machine.contracts().map(|observed| ContractRecord::new(machine.program(), &observed)).collect(),
            wall: self.start.elapsed(),
            start: self.first_tick.unwrap_or_default(),
            tick_times: self.tick_times,
        }
    }
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
    let whiskers = perception.fitted().map(|(bound, in_rig)| WhiskerRecord {
        deflection: perception.base_angle(bound),
        tip: perception.recorded_tip(bound),
        contact: contact(perception, bound),
        tip_deviation: perception.recorded_deviation(bound),
        tip_end: Some(world.tip(in_rig)),
        out_of_plane: world.out_of_plane(in_rig),
        snap_off: world.snapped_off(in_rig),
    });
    TickRecord {
        time: perception.time(),
        body: perception.pose(),
        state: machine.failure().is_none().then(|| machine.state()),
        whiskers: whiskers.collect(),
        command,
        fallback,
        body_touches: world.body_touches(),
    }
}

fn contact(perception: &Perception, whisker: usize) -> Contact {
    let known = |vector: Vector2| vector.iter().all(|part| part.is_finite()).then_some(vector);
    let vector = |quantity| known(perception.whisker_vector(whisker, quantity));
    Contact {
        is_touching: perception.whisker(whisker, WhiskerScalar::Touching) > 0.0,
        tip_world: vector(WhiskerVector::Tip).map(Point2::from),
        tangent_world: vector(WhiskerVector::ContourTangent),
        inclination: perception.inclination(whisker),
    }
}
