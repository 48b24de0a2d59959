//! The channels of a run and their messages, whoever receives them.

use std::sync::Arc;

use foxglove::messages::{FrameTransform, PointCloud, PoseInFrame, SceneUpdate};
use foxglove::{Channel, Context, PartialMetadata, RawChannel};
use serde::Serialize;
use vibrissa_runtime::rig::Rig;

use super::channel::JsonChannel;
use super::error::RecordError;
use super::frame::RecordedFrame;
use super::sample_message::SamplesMessage;
use super::view::{View, nanoseconds};
use crate::inspect::{GuardRecord, TransitionLine};
use crate::results::{Document, tick_lines};
use crate::run::Trace;
use vibrissa_world::geometry::ContourSet;
use vibrissa_world::geometry::Point2;

/// Whiskers are drawn in every tick with an index that is a multiple of this.
const TICKS_PER_DRAWING: u64 = 2;

/// The channels of a run.
pub struct Channels {
    /// Keeps the channels open.
    _context: Arc<Context>,
    /// The channels whose messages are logged once.
    _fixed: Vec<Channel<SceneUpdate>>,
    _points: Option<Channel<PointCloud>>,
    samples: Arc<RawChannel>,
    ticks: Arc<RawChannel>,
    state: Arc<RawChannel>,
    guards: Arc<RawChannel>,
    transitions: Arc<RawChannel>,
    transform: Channel<FrameTransform>,
    pose: Channel<PoseInFrame>,
    whiskers: Channel<SceneUpdate>,
    tips: Channel<PointCloud>,
    contour: Channel<PointCloud>,
    view: View,
    /// Number of whiskers of the rig.
    rig_whiskers: usize,
    scenario: String,
    friction: f64,
    /// A trace with the names of the run and one tick.
    trace: Trace,
    count: u64,
    end: f64,
}

/// The state after a tick.
#[derive(Serialize)]
struct StateMessage<'a> {
    state: &'a str,
    outer: &'a str,
}

/// The guards that were tried in a tick.
#[derive(Serialize)]
struct GuardsMessage {
    guards: Vec<GuardRecord>,
}

impl Channels {
    /// Opens the channels of a run of `rig` and logs what does not change. `surfaces` are the outlines of the objects, if they are
    /// known. `trace` is a trace of the run without ticks.
    ///
    /// # Errors
    /// [`RecordError`] if the file cannot be written.
    pub fn new(
        context: Arc<Context>,
        (rig, scenario): (&Rig, &str),
        surfaces: Option<&ContourSet>,
        trace: Trace,
    ) -> Result<Self, RecordError> {
        let view = View::new(rig.clone(), &trace.whiskers);
        let (mut fixed, mut points) = (Vec::new(), None);
        if let Some(surfaces) = surfaces {
            let scene = context.channel_builder("scene").build();
            scene.log_with_time(&View::scene(surfaces), 0);
            let objects = context.channel_builder("objects").build();
            objects.log_with_time(&View::objects(surfaces), 0);
            fixed.push(scene);
            points = Some(objects);
        }
        let platform = context.channel_builder("platform").build();
        platform.log_with_time(&view.platform(), 0);
        fixed.push(platform);
        Ok(Self {
            samples: JsonChannel::Samples.open(&context, &trace.states)?,
            ticks: JsonChannel::Ticks.open(&context, &trace.states)?,
            state: JsonChannel::State.open(&context, &trace.states)?,
            guards: JsonChannel::Guards.open(&context, &trace.states)?,
            transitions: JsonChannel::Transitions.open(&context, &trace.states)?,
            transform: context.channel_builder("transform").build(),
            pose: context.channel_builder("pose").build(),
            whiskers: context.channel_builder("whiskers").build(),
            tips: context.channel_builder("tips").build(),
            contour: context.channel_builder("contour").build(),
            _context: context,
            _fixed: fixed,
            _points: points,
            view,
            rig_whiskers: rig.whiskers.len(),
            scenario: scenario.to_owned(),
            friction: rig.sensing.friction,
            trace,
            count: 0,
            end: 0.0,
        })
    }

    /// Logs a tick, with the transitions that it has taken and the guards that it has tried last, if the policy has a text.
    ///
    /// # Errors
    /// [`RecordError`] if the file cannot be written.
    pub fn frame(
        &mut self,
        frame: RecordedFrame,
        explained: Option<(&[TransitionLine], Vec<GuardRecord>)>,
    ) -> Result<(), RecordError> {
        let time = frame.tick.time;
        let at = PartialMetadata::with_log_time(nanoseconds(time));
        log_json(&self.samples, &SamplesMessage::new(&frame.samples, self.rig_whiskers), at)?;
        if let Some((transitions, guards)) = explained {
            for line in transitions {
                log_json(&self.transitions, &line.versioned(None), at)?;
            }
            log_json(&self.guards, &GuardsMessage { guards }, at)?;
        }
        let name =
            |state: Option<usize>| state.and_then(|state| self.trace.states.get(state)).map_or("", String::as_str);
        let outer = |state: usize| self.trace.parents.get(state).copied().flatten();
        let outermost =
            frame.tick.state.and_then(|state| std::iter::successors(Some(state), |&state| outer(state)).last());
        log_json(&self.state, &StateMessage { state: name(frame.tick.state), outer: name(outermost) }, at)?;
        let (transform, pose) = View::pose(&frame.tick);
        self.transform.log_with_meta(&transform, at);
        self.pose.log_with_meta(&pose, at);
        self.tips.log_with_meta(&self.view.tips(&frame.tick), at);
        if self.count.is_multiple_of(TICKS_PER_DRAWING) {
            self.whiskers.log_with_meta(&self.view.whiskers(&frame.tick), at);
        }
        if let Some(contour) = self.view.grown(&frame.tick) {
            self.contour.log_with_meta(&contour, at);
        }
        self.fill_trace(frame);
        for line in tick_lines(&self.scenario, &self.trace, self.friction) {
            log_json(&self.ticks, &line.versioned(None), at)?;
        }
        (self.count, self.end) = (self.count + 1, time);
        Ok(())
    }

    /// Makes a tick the only one of the trace.
    fn fill_trace(&mut self, frame: RecordedFrame) {
        let RecordedFrame { tick, mut marks, plots, mut messages, samples: _ } = frame;
        for mark in &mut marks {
            mark.tick = 0;
        }
        for message in &mut messages {
            message.tick = 0;
        }
        for plot in &mut self.trace.plots {
            plot.values.clear();
        }
        for (plot, value) in plots {
            if let Some(plot) = self.trace.plots.get_mut(plot) {
                plot.values.push((0, value));
            }
        }
        (self.trace.marks, self.trace.messages) = (marks, messages);
        self.trace.ticks.clear();
        self.trace.ticks.push(tick);
    }

    /// Adds recorded tips of earlier ticks, whose messages were not logged.
    pub fn add_contour(&mut self, tips: impl IntoIterator<Item = Point2>) {
        self.view.add(tips);
    }

    /// Logs what belongs to the last tick.
    pub(super) fn finish(&mut self) {
        if let Some(contour) = self.view.rest(self.end) {
            self.contour.log_with_time(&contour, nanoseconds(self.end));
        }
    }
}

fn log_json(channel: &RawChannel, message: &impl Serialize, at: PartialMetadata) -> Result<(), RecordError> {
    channel.log_with_meta(&serde_json::to_vec(message)?, at);
    Ok(())
}
