//! What happened in a run, tick by tick.

use crate::geometry::{Point2, Pose, Vector2};
use vibrissa_runtime::machine::{Fallback, Mark};
use vibrissa_runtime::signal::{Command, MAX_WHISKERS};

/// What happened in a run, tick by tick.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// The whiskers that the policy binds, in its order.
    pub whiskers: Vec<String>,
    /// The machine's states; ticks name them by index.
    pub states: Vec<String>,
    /// The state that each of them lies in, by its index; an outer state comes before those in it.
    pub parents: Vec<Option<usize>>,
    /// Time between ticks (s).
    pub period: f64,
    /// The ticks.
    pub ticks: Vec<TickRecord>,
    /// What the policy marked, in the order of time; of one tick, whisker by whisker.
    pub marks: Vec<MarkRecord>,
    /// Whether the run ended because the platform's body was driven into something, after the last tick.
    pub crashed: bool,
}

/// One mark.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MarkRecord {
    /// What was marked.
    pub mark: Mark,
    /// Index of the whisker.
    pub whisker: usize,
    /// Index of the tick, which has the time and the pose of the platform.
    pub tick: usize,
    /// The estimate of the whisker's tip (m, world frame).
    pub tip_world: Point2,
}

/// One tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TickRecord {
    /// Time since the start of the run (s).
    pub time: f64,
    /// Pose of the platform's centre of mass, as sampled.
    pub body: Pose,
    /// Index of the active state after the tick; `None` after a failure.
    pub state: Option<usize>,
    /// Filtered base angles (rad).
    pub deflections: [f64; MAX_WHISKERS],
    /// Tip estimates that the policy recorded (m, world frame).
    pub tips: [Option<Point2>; MAX_WHISKERS],
    /// What the whiskers' tips touch, recorded or not.
    pub touches: [Touch; MAX_WHISKERS],
    /// How far off each tip may be (m), as standard deviations, by what the tip model tells.
    pub tip_spreads: [f64; MAX_WHISKERS],
    /// The command that the tick gave.
    pub command: Command,
    /// The state that the machine left by its failsafe, if it left one.
    pub failsafe: Option<Fallback>,
    /// Where the axis of each whisker ends (m, world frame), as the world knows it; no policy sees this. `None` of a whisker that the
    /// trace does not have.
    pub tip_ends: [Option<Point2>; MAX_WHISKERS],
    /// Whether the platform's body touched something since the last tick, as the world knows it; no policy sees this.
    pub body_touches: bool,
    /// Whether each whisker sprang since the last tick, as one does that slips off a corner; no policy sees this either.
    pub springs: [bool; MAX_WHISKERS],
}

/// What a whisker's tip touches, as perceived.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Touch {
    /// Whether the base angle is beyond the rig's contact threshold.
    pub is_touching: bool,
    /// Where the tip is, or would be if it touched (m, world frame); `None` in a tick that brought no reading.
    pub tip_world: Option<Point2>,
    /// Direction of travel (unit vector, world frame) at the end of the contour that the policy last recorded, once it is ready.
    pub tangent_world: Option<Vector2>,
}

impl Trace {
    /// The ticks in which the machine left a state by its failsafe, with what it did so for.
    pub fn failsafes(&self) -> impl Iterator<Item = (&TickRecord, Fallback)> {
        self.ticks.iter().filter_map(|tick| Some((tick, tick.failsafe?)))
    }

    /// The recorded tips of one whisker with the ticks' indices.
    pub fn tips(&self, whisker: usize) -> impl Iterator<Item = (usize, Point2)> {
        self.ticks.iter().enumerate().filter_map(move |(index, tick)| Some((index, tick.tips[whisker]?)))
    }
}
