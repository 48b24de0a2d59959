//! Perception and command of every tick as JSON documents.

use super::Document;
use super::shown_value::ShownValue;
use serde::Serialize;

use crate::run::{TickRecord, Trace, WhiskerRecord};
use vibrissa_runtime::mechanics::out_of_plane_margin;

/// One control tick, in the units of its keys. Its serialised form is a line that `run --ticks` writes.
///
/// Positions and directions are in the world frame. Every key is always present. It is `null` for a value that the tick
/// does not have.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TickLine<'a> {
    /// Name of the scenario.
    pub scenario: &'a str,
    /// Time since the start of the run.
    pub time_s: f64,
    /// Name of the active state after the tick. `None` after a failure.
    pub state: Option<&'a str>,
    /// Position of the platform's centre of mass.
    pub position_m: [f64; 2],
    /// Heading of the platform.
    pub heading_rad: f64,
    /// Commanded velocity of the centre of mass.
    pub velocity_m_s: [f64; 2],
    /// Commanded yaw rate, counter-clockwise positive.
    pub yaw_rate_rad_s: f64,
    /// True if the platform's body touched something since the last tick. Policies cannot read this.
    pub body_touches: bool,
    /// The whiskers that the policy binds, in its order.
    pub whiskers: Vec<WhiskerLine<'a>>,
    /// The plots that the policy has set in this tick.
    pub plots: Vec<PlotLine<'a>>,
    /// The messages that the policy has logged in this tick.
    pub messages: Vec<MessageLine<'a>>,
}

impl Document for TickLine<'_> {
    const FORMAT: &'static str = "tick";
}

/// One whisker in a tick.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WhiskerLine<'a> {
    /// Its name.
    pub whisker: &'a str,
    /// Filtered base angle, counter-clockwise positive.
    pub deflection_rad: f64,
    /// True if its magnitude exceeds the contact threshold.
    pub touching: bool,
    /// True if the whisker had a snap-off since the last tick, for instance at a corner. Policies cannot read this.
    pub springs: bool,
    /// Angle between the shaft at its base and the surface that it follows: π/2 if they are perpendicular, less if the
    /// shaft is swept back.
    pub inclination_rad: Option<f64>,
    /// Margin by which a round whisker with this inclination stays in the plane. A negative one means that it leaves it.
    pub inclination_margin_rad: Option<f64>,
    /// Motion of the tip out of the plane since the last tick. `None` for planar whiskers. Policies cannot read this.
    pub out_of_plane: Option<OutOfPlaneLine>,
    /// Estimated position of the tip.
    pub tip_m: Option<[f64; 2]>,
    /// Standard deviation of that position.
    pub tip_spread_m: f64,
    /// Direction of travel at the end of the last recorded contour.
    pub tangent: Option<[f64; 2]>,
    /// True if the tip was recorded.
    pub recorded: bool,
    /// The marks of the policy: `lost`, `found`.
    pub marks: Vec<&'static str>,
}

/// The motion of a tip out of the plane in a tick.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct OutOfPlaneLine {
    /// Largest distance of the tip from the plane.
    pub distance_m: f64,
    /// True if the tip was above the top or below the bottom of the objects.
    pub slips: bool,
}

/// A plot of the policy in a tick.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PlotLine<'a> {
    /// Its name.
    pub plot: &'a str,
    /// Its value.
    #[serde(flatten)]
    pub value: ShownValue,
}

/// A message of the policy in a tick.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MessageLine<'a> {
    /// Its text.
    pub text: &'a str,
    /// Name of the state that contains the statement. `None` outside of states.
    pub state: Option<&'a str>,
    /// The values that it shows.
    pub values: Vec<MessageValueLine<'a>>,
}

/// A value of a message.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MessageValueLine<'a> {
    /// The expression, as in the policy.
    pub expression: &'a str,
    /// Its value.
    #[serde(flatten)]
    pub value: ShownValue,
}

/// The lines of a run's ticks. `friction` is the coefficient that perception assumes.
pub fn tick_lines<'a>(scenario: &'a str, trace: &'a Trace, friction: f64) -> impl Iterator<Item = TickLine<'a>> {
    trace.ticks.iter().enumerate().map(move |(index, tick)| TickLine {
        scenario,
        time_s: tick.time,
        state: tick.state.and_then(|state| trace.states.get(state)).map(String::as_str),
        position_m: tick.body.position.coords.into(),
        heading_rad: tick.body.heading,
        velocity_m_s: tick.command.velocity_world.into(),
        yaw_rate_rad_s: tick.command.yaw_rate,
        body_touches: tick.body_touches,
        whiskers: whisker_lines(trace, index, tick, friction),
        plots: plot_lines(trace, index),
        messages: message_lines(trace, index),
    })
}

fn plot_lines(trace: &Trace, tick: usize) -> Vec<PlotLine<'_>> {
    let lines = trace.plots.iter().filter_map(|plot| {
        let at = plot.values.binary_search_by_key(&tick, |(tick, _)| *tick).ok()?;
        let shown = plot.kind.read(&[plot.values.get(at)?.1], &[])?;
        Some(PlotLine { plot: &plot.name, value: ShownValue::new(&shown) })
    });
    lines.collect()
}

fn message_lines(trace: &Trace, tick: usize) -> Vec<MessageLine<'_>> {
    let first = trace.messages.partition_point(|message| message.tick < tick);
    let messages = trace.messages[first..].iter().take_while(|message| message.tick == tick);
    messages
        .map(|message| MessageLine {
            text: &message.message.text,
            state: message.state.and_then(|state| trace.states.get(state)).map(String::as_str),
            values: (message.message.values.iter())
                .map(|(name, value)| MessageValueLine { expression: name, value: ShownValue::new(value) })
                .collect(),
        })
        .collect()
}

fn whisker_lines<'a>(trace: &'a Trace, index: usize, tick: &TickRecord, friction: f64) -> Vec<WhiskerLine<'a>> {
    let first_mark = trace.marks.partition_point(|mark| mark.tick < index);
    let marks = || trace.marks[first_mark..].iter().take_while(|mark| mark.tick == index);
    let line = |(whisker, (name, record)): (usize, (&'a String, &WhiskerRecord))| WhiskerLine {
        whisker: name,
        deflection_rad: record.deflection,
        touching: record.contact.is_touching,
        springs: record.snap_off,
        inclination_rad: record.contact.inclination,
        inclination_margin_rad: record
            .contact
            .inclination
            .map(|inclination| out_of_plane_margin(inclination, friction)),
        out_of_plane: record
            .out_of_plane
            .map(|motion| OutOfPlaneLine { distance_m: motion.distance, slips: motion.slips }),
        tip_m: record.contact.tip_world.map(|tip| tip.coords.into()),
        tip_spread_m: record.tip_deviation,
        tangent: record.contact.tangent_world.map(Into::into),
        recorded: record.tip.is_some(),
        marks: marks().filter(|mark| mark.whisker == whisker).map(|mark| mark.mark.name()).collect(),
    };
    trace.whiskers.iter().zip(&tick.whiskers).enumerate().map(line).collect()
}
