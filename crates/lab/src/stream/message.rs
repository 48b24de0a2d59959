//! The messages of the protocol `vibrissa.live.v1` between the program and its page. All values are in SI units and radians.
//!
//! Each message is one JSON text with the key `type`. States, whiskers and guards are named by their indices in [`Hello`].

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

pub use super::map::MapFrame;

/// The name of the protocol.
pub const PROTOCOL: &str = "vibrissa.live.v1";

/// A message to the page.
#[derive(Debug, Clone, Serialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum ServerMessage {
    /// The first message of a connection and of each run.
    Hello(Arc<Hello>),
    /// New ticks.
    Ticks(Ticks),
    /// What the run does. It follows every change.
    Status(Status),
    /// The answer to [`PageMessage::Range`].
    History(History),
    /// A piece of the answer to [`PageMessage::Counterfactual`].
    Counterfactual(Piece),
    /// A request that cannot be carried out.
    Error {
        /// What is wrong and what to do.
        message: String,
        /// The counterfactual to which it belongs.
        id: Option<u64>,
    },
}

/// Everything that stays the same during a run.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Hello {
    /// The protocol.
    pub protocol: &'static str,
    /// Version of the program.
    pub version: &'static str,
    /// Number of the run since the program was started, from 1. A page forgets the ticks of earlier runs.
    pub run: u64,
    /// The command: `run`, `replay` or `drive`.
    pub command: &'static str,
    /// Name of the scenario.
    pub scenario: String,
    /// Name of the policy.
    pub policy: String,
    /// Simulator. `None` if it is not known.
    pub world: Option<String>,
    /// Longest duration of the run (s). `None` if it is not known.
    pub duration: Option<f64>,
    /// Number of ticks, if all are known from the beginning.
    pub known_ticks: Option<usize>,
    /// Control period (s).
    pub control_period: f64,
    /// Sample period (s).
    pub dt: f64,
    /// What the page may ask for.
    pub capabilities: Capabilities,
    /// The whiskers that the policy binds, in its order.
    pub whiskers: Vec<String>,
    /// The guards.
    pub guards: Vec<GuardInfo>,
    /// Why there are no guards, if there are none.
    pub no_guards: Option<String>,
    /// The statechart.
    pub chart: ChartInfo,
    /// The values that a counterfactual may change: parameters of the policy, then thresholds of guards.
    pub parameters: Vec<ParameterInfo>,
    /// The outlines of the objects in the world frame (m). `None` if the scene is not known.
    pub scene: Option<Vec<Outline>>,
    /// The rig.
    pub rig: RigInfo,
    /// Position (m) and heading (rad) of the platform before the first tick. `None` if they are not known.
    pub start: Option<[f64; 3]>,
    /// The plots of the policy.
    pub plots: Vec<PlotInfo>,
    /// The breakpoints.
    pub breakpoints: Vec<BreakpointInfo>,
}

/// What the page may ask for.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
#[expect(clippy::struct_excessive_bools, reason = "a page may ask for each of them alone")]
pub struct Capabilities {
    /// `pause`, `run` and `step`.
    pub step: bool,
    /// `break`.
    pub breakpoints: bool,
    /// `counterfactual` over recorded perception.
    pub counterfactual: bool,
    /// `counterfactual` in closed loop.
    pub closed_loop: bool,
}

/// A guard. Its index is its place in [`Hello::guards`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GuardInfo {
    /// The same index.
    pub index: usize,
    /// The state to which it belongs. `None` for a global transition.
    pub state: Option<usize>,
    /// Name of the target: a state, `exit` and a name, `Success` or `Failure`.
    pub target: String,
    /// The guard, as in the policy.
    pub text: String,
    /// The file that contains it. `None` for the policy itself.
    pub file: Option<String>,
    /// Its line in that file, from 1.
    pub line: usize,
    /// The parts of its condition in the order of the text. None for `after`.
    pub parts: Vec<PartInfo>,
}

/// A part of a condition.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PartInfo {
    /// The part, as in the policy. It says what has to hold.
    pub text: String,
    /// Unit of its margin. `None` for a bool.
    pub unit: Option<String>,
}

/// The statechart.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct ChartInfo {
    /// The states. An outer state comes before its inner states.
    pub states: Vec<StateInfo>,
    /// The transitions.
    pub transitions: Vec<TransitionInfo>,
}

impl ChartInfo {
    /// The active states from the outermost to the innermost. None without one.
    #[must_use]
    pub fn path(&self, innermost: Option<usize>) -> Vec<usize> {
        let parent = |state: &usize| self.states.get(*state)?.parent;
        let mut path: Vec<usize> = std::iter::successors(innermost, parent).collect();
        path.reverse();
        path
    }
}

/// A state. Its index is its place in [`ChartInfo::states`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StateInfo {
    /// Its name.
    pub name: String,
    /// The state that contains it.
    pub parent: Option<usize>,
    /// True if it is the initial state of the machine or of the state that contains it.
    pub initial: bool,
    /// The behaviour that is its content, with its arguments.
    pub behaviour: Option<String>,
}

/// A transition.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TransitionInfo {
    /// The state to which it belongs. `None` for every state.
    pub state: Option<usize>,
    /// The state that it enters. `None` for an end of the run.
    pub target: Option<usize>,
    /// `success` or `failure` for an end of the run.
    pub end: Option<&'static str>,
    /// Index of its guard. `None` for a fallback transition, and if there are no guards.
    pub guard: Option<usize>,
    /// The guard for people.
    pub text: String,
}

/// A value that a counterfactual may change.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ParameterInfo {
    /// The key in [`PageMessage::Counterfactual`].
    pub name: String,
    /// Its value in the run (SI). For a choice, its number.
    pub value: f64,
    /// Its SI unit. Empty for a number.
    pub unit: String,
    /// The least value allowed.
    pub low: Option<f64>,
    /// The greatest value allowed.
    pub high: Option<f64>,
    /// The names of the values 0, 1, 2 and so on. Empty for a number.
    pub choices: Vec<String>,
    /// What it means.
    pub meaning: String,
    /// The guard whose threshold it is. `None` for a parameter of the policy.
    pub guard: Option<usize>,
}

/// A plot of the policy.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct PlotInfo {
    /// Its name.
    pub name: String,
    /// The SI unit of its values. Empty for a number, and if there are choices.
    pub unit: String,
    /// The names of the values 0, 1, 2 and so on. Empty for a quantity.
    pub choices: Vec<String>,
}

/// An outline.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Outline {
    /// Its points (m).
    pub points: Vec<[f64; 2]>,
    /// True if the last point is joined to the first one.
    pub closed: bool,
}

/// The rig, in the frame of the body: the origin is the centre of mass, the first axis points forward, the second one to the left.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct RigInfo {
    /// The corners of the platform (m).
    pub platform: Vec<[f64; 2]>,
    /// The whiskers in the order of [`Hello::whiskers`].
    pub whiskers: Vec<WhiskerInfo>,
}

/// A whisker of the rig.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WhiskerInfo {
    /// Its base (m).
    pub base: [f64; 2],
    /// Direction of the undeflected shaft (rad).
    pub direction: f64,
    /// Length (m).
    pub length: f64,
    /// Base angle (rad) above which perception regards it as touching.
    pub threshold: f64,
}

/// A breakpoint.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct BreakpointInfo {
    /// The name of a state, or a condition.
    pub text: String,
    /// The state, if it is one.
    pub state: Option<usize>,
}

/// New ticks.
#[derive(Debug, Clone, Serialize)]
pub struct Ticks {
    /// Number of ticks that this connection has missed since its last `ticks`. `range` gets them.
    pub lost: usize,
    /// The ticks, oldest first.
    pub frames: Vec<Arc<Frame>>,
}

/// A tick.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Frame {
    /// Its index.
    pub tick: usize,
    /// Time since the start of the run (s).
    pub time: f64,
    /// The active states from the outermost to the innermost. Empty after the end of the machine.
    pub states: Vec<usize>,
    /// Position of the platform's centre of mass (m) and its heading (rad).
    pub pose: [f64; 3],
    /// The whiskers in the order of [`Hello::whiskers`].
    pub whiskers: Vec<WhiskerFrame>,
    /// The guards that were tried last in this tick. Others were not evaluated.
    pub guards: Vec<GuardFrame>,
    /// The guards of the transitions that were taken, in their order.
    pub taken: Vec<usize>,
    /// Commanded velocity of the centre of mass (m/s, world frame) and yaw rate (rad/s).
    pub command: [f64; 3],
    /// The recorded tips since the tick before.
    pub contour: Vec<ContourFrame>,
    /// The contour reconstruction until now.
    pub metrics: Metrics,
    /// The control loop. `None` if its times are not known.
    #[serde(rename = "loop")]
    pub timing: Option<Timing>,
    /// The messages that the policy has logged.
    pub messages: Vec<String>,
    /// The values (SI) of [`Hello::plots`]. `None` for a plot that this tick has not set, or not to a finite number.
    pub plots: Vec<Option<f64>>,
    /// What the map by touch has gained. `None` in most ticks, and without a map.
    pub map: Option<Box<MapFrame>>,
}

/// A whisker in a tick.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WhiskerFrame {
    /// Filtered base angle (rad), counter-clockwise positive.
    pub base_angle: f64,
    /// True if it is regarded as touching.
    pub touching: bool,
    /// The bent shaft from the base to the tip (m, world frame).
    pub shaft: Vec<[f64; 2]>,
    /// Estimated tip (m, world frame).
    pub tip: Option<[f64; 2]>,
}

/// A guard in a tick.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GuardFrame {
    /// Its index.
    pub guard: usize,
    /// True if its condition holds. True for `after`.
    pub met: bool,
    /// For each part the distance from the value where it changes, in the unit of the part. It is positive if the part holds, and
    /// negative by the amount that is missing. `None` for a bool.
    pub margins: Vec<Option<f64>>,
    /// The parts that have to change, so that the condition holds.
    pub missing: Vec<usize>,
    /// For a guard with a time, the time (s) since its condition holds or its state was entered.
    pub elapsed: Option<f64>,
    /// The time (s) that is needed.
    pub needed: Option<f64>,
}

/// A recorded tip.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ContourFrame {
    /// Index of the whisker.
    pub whisker: usize,
    /// Its position (m, world frame).
    pub point: [f64; 2],
    /// Its standard deviation (m).
    pub spread: Option<f64>,
    /// Its distance from the nearest outline (m). `None` if the scene is not known.
    pub error: Option<f64>,
}

/// Figures of the contour until a tick. Each is `None` if it is not known.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Metrics {
    /// Mean distance of the recorded tips from the nearest outline (m).
    pub error: Option<f64>,
    /// Share of the reference that was traced, 0 to 1.
    pub coverage: Option<f64>,
    /// Mean standard deviation of the recorded tips (m).
    pub spread: Option<f64>,
}

/// Times of the control loop in a tick.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Timing {
    /// Wall time since the tick before (s). `None` in the first tick and after a pause, which is no control period.
    pub period: Option<f64>,
    /// Wall time of perception, machine and motion (s).
    pub used: f64,
    /// True if they took longer than the control period.
    pub overload: bool,
}

/// What the run does.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Status {
    /// `running`, `paused` or `finished`.
    pub state: &'static str,
    /// Why it is paused: `page`, `start` or `breakpoint`. Or the reason of the outcome.
    pub reason: Option<String>,
    /// The breakpoint at which it is paused.
    pub breakpoint: Option<String>,
    /// The outcome: `completed`, `timeout`, `failed` or `diverged`.
    pub verdict: Option<String>,
    /// The figures of the whole contour, after the end of the run.
    pub metrics: Option<Metrics>,
    /// Number of ticks until now.
    pub ticks: usize,
    /// The program keeps every tick whose index is a multiple of this, and the newest ones.
    pub kept_every: usize,
    /// The breakpoints.
    pub breakpoints: Vec<BreakpointInfo>,
}

/// Ticks of the past.
#[derive(Debug, Clone, Serialize)]
pub struct History {
    /// The first tick that was asked for.
    pub from: usize,
    /// The tick after the last one.
    pub to: usize,
    /// The kept ticks among them, at most as many as were asked for. Recorded tips of other ticks are in the next kept tick, and so
    /// are plots that it has not set itself.
    pub frames: Vec<Arc<Frame>>,
}

/// A piece of a counterfactual.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Piece {
    /// The number that the page has given it.
    pub id: u64,
    /// The kind.
    pub kind: CounterfactualKind,
    /// The ticks, oldest first.
    pub frames: Vec<CounterfactualFrame>,
    /// The first tick in which the states differ from those of the run. Until there is one, the first tick in which the commands do.
    pub first_difference: Option<FirstDifference>,
    /// True for the last piece.
    pub done: bool,
    /// Why it ended: `end of the run`, `canceled`, or the outcome in closed loop. Only in the last piece.
    pub end: Option<String>,
}

/// A tick of a counterfactual.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CounterfactualFrame {
    /// Its index.
    pub tick: usize,
    /// Time since the start of the run (s).
    pub time: f64,
    /// The active states. Empty after the end of the machine.
    pub states: Vec<usize>,
    /// The pose, in closed loop.
    pub pose: Option<[f64; 3]>,
    /// The recorded tips, in closed loop.
    pub contour: Vec<[f64; 2]>,
}

/// The first tick in which a counterfactual differs from the run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FirstDifference {
    /// Its index.
    pub tick: usize,
    /// Its time (s).
    pub time: f64,
    /// True if the active states differ. False if only the commands do.
    pub states_differ: bool,
    /// What the run did: the guard of the transition that it took, or `stays in` and its state.
    pub before: String,
    /// What the changed policy does.
    pub after: String,
}

/// The kind of a counterfactual.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CounterfactualKind {
    /// The changed policy has the recorded samples, and its commands move nothing.
    Recorded,
    /// The changed policy steers the platform in a simulation.
    ClosedLoop,
}

/// A message from the page.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub enum PageMessage {
    /// Pauses the run.
    Pause,
    /// Continues the run.
    Run,
    /// Executes ticks of a paused run.
    Step {
        /// Their number.
        ticks: u32,
    },
    /// Asks for ticks of the past.
    Range {
        /// The first tick.
        from: usize,
        /// The tick after the last one.
        to: usize,
        /// The largest number of ticks in the answer.
        most: Option<usize>,
    },
    /// Changes the breakpoints. The answer is a `status`, or an `error`.
    Break {
        /// The name of a state, or a condition.
        add: Option<String>,
        /// The text of a breakpoint.
        remove: Option<String>,
    },
    /// Asks what a changed policy would have done.
    Counterfactual {
        /// A number for the answer.
        id: u64,
        /// The first tick with the change.
        tick: usize,
        /// The kind.
        kind: CounterfactualKind,
        /// The changed values (SI), by the names of [`ParameterInfo`].
        set: BTreeMap<String, f64>,
    },
    /// Stops a counterfactual.
    Cancel {
        /// Its number.
        id: u64,
    },
}
