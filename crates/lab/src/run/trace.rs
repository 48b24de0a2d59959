//! Trace of a run, tick by tick.

use vibrissa_runtime::machine::{Fallback, Mark, OutputKind, ShownMessage};
use vibrissa_runtime::signal::Command;
use vibrissa_world::geometry::{Point2, Pose, Vector2};
use vibrissa_world::world::OutOfPlane;

/// Trace of a run, tick by tick.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// The whiskers that the policy binds, in its order.
    pub whiskers: Vec<String>,
    /// The machine's states. Ticks refer to them by index.
    pub states: Vec<String>,
    /// The parent of each state, by its index. An outer state comes before its inner states.
    pub parents: Vec<Option<usize>>,
    /// Time between ticks (s).
    pub period: f64,
    /// The ticks.
    pub ticks: Vec<TickRecord>,
    /// The marks of the policy in the order of time. Within a tick they are in the order of whiskers.
    pub marks: Vec<MarkRecord>,
    /// The plots of the policy, in its order.
    pub plots: Vec<PlotRecord>,
    /// The messages of the policy in their order, the first [`MESSAGES_KEPT`] of them.
    pub messages: Vec<MessageRecord>,
    /// Number of further messages.
    pub further_messages: usize,
    /// True if the run ended after the last tick because the platform's body was driven into something.
    pub crashed: bool,
}

/// Number of messages that a trace keeps. It bounds the memory of a run that logs in every tick.
pub const MESSAGES_KEPT: usize = 10_000;

/// A plot of the policy over a run.
#[derive(Debug, Clone, PartialEq)]
pub struct PlotRecord {
    /// Its name.
    pub name: String,
    /// The kind of its values.
    pub kind: OutputKind,
    /// The values (SI, a truth as 1 or 0, a choice as its index), each with the index of its tick.
    pub values: Vec<(usize, f64)>,
}

/// A message of the policy.
#[derive(Debug, Clone, PartialEq)]
pub struct MessageRecord {
    /// Index of the tick.
    pub tick: usize,
    /// Index of the state that contains the statement. `None` outside of states.
    pub state: Option<usize>,
    /// The message with its values.
    pub message: ShownMessage,
}

/// One mark.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MarkRecord {
    /// The kind of mark.
    pub mark: Mark,
    /// Index of the whisker.
    pub whisker: usize,
    /// Index of the tick, which has the time and the pose of the platform.
    pub tick: usize,
    /// The estimate of the whisker's tip (m, world frame).
    pub tip_world: Point2,
}

/// One tick.
#[derive(Debug, Clone, PartialEq)]
pub struct TickRecord {
    /// Time since the start of the run (s).
    pub time: f64,
    /// Pose of the platform's centre of mass, as sampled.
    pub body: Pose,
    /// Index of the active state after the tick. `None` after a failure.
    pub state: Option<usize>,
    /// The whiskers of the trace, in its order. A run has many ticks and few whiskers, so there is no place for more.
    pub whiskers: Box<[WhiskerRecord]>,
    /// The command of the tick.
    pub command: Command,
    /// The fallback transition of the tick, if there was one.
    pub fallback: Option<Fallback>,
    /// True if the platform's body touched something since the last tick. Policies cannot read it.
    pub body_touches: bool,
}

/// A whisker in a tick.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WhiskerRecord {
    /// Filtered base angle (rad), counter-clockwise positive.
    pub deflection: f64,
    /// Tip estimate that the policy recorded (m, world frame).
    pub tip: Option<Point2>,
    /// The perceived contact, recorded or not.
    pub contact: Contact,
    /// Standard deviation of the tip position (m), as reported by the contact estimator.
    pub tip_deviation: f64,
    /// True position of the end of the axis (m, world frame). `None` if it is not known. Policies cannot read it.
    pub tip_end: Option<Point2>,
    /// Motion of the tip out of the plane since the last tick. `None` in a planar world. Policies cannot read it.
    pub out_of_plane: Option<OutOfPlane>,
    /// True if there was a snap-off since the last tick, for instance at a corner. Policies cannot read it.
    pub snap_off: bool,
}

/// The perceived contact of a whisker.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Contact {
    /// True if the magnitude of the base angle exceeds the rig's contact threshold.
    pub is_touching: bool,
    /// Estimated position of the tip (m, world frame), also without contact. `None` in a tick without a reading.
    pub tip_world: Option<Point2>,
    /// Direction of travel (unit vector, world frame) at the end of the last recorded contour. `None` before the local
    /// contour is ready.
    pub tangent_world: Option<Vector2>,
    /// Angle (rad) between the shaft at its base and the surface: π/2 if they are perpendicular, less if the shaft is
    /// swept back. `None` unless the whisker touches and records a contour.
    pub inclination: Option<f64>,
}

impl TickRecord {
    /// The tip estimates that the policy recorded (m, world frame), in the order of whiskers.
    pub fn tips(&self) -> impl Iterator<Item = Point2> {
        self.whiskers.iter().filter_map(|whisker| whisker.tip)
    }
}

impl Trace {
    /// The ticks with a fallback transition, and its cause.
    pub fn fallbacks(&self) -> impl Iterator<Item = (&TickRecord, Fallback)> {
        self.ticks.iter().filter_map(|tick| Some((tick, tick.fallback?)))
    }

    /// The recorded tips of one whisker with the ticks' indices.
    pub fn tips(&self, whisker: usize) -> impl Iterator<Item = (usize, Point2)> {
        self.ticks.iter().enumerate().filter_map(move |(index, tick)| Some((index, tick.whiskers[whisker].tip?)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A run of 6000 s has 180 000 ticks.
    #[test]
    fn a_tick_takes_little_memory() {
        assert!(size_of::<TickRecord>() <= 128 && size_of::<WhiskerRecord>() <= 160);
    }
}
