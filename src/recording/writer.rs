//! Encoding of a recording.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Cursor;
use std::sync::Arc;

use foxglove::messages::{FrameTransform, PointCloud, PoseInFrame, SceneUpdate};
use foxglove::{
    Channel, Context, McapAttachment, McapCompression, McapWriteOptions, McapWriterHandle, PartialMetadata, RawChannel,
};
use serde::Serialize;
use vibrissa_robot::recording::Attachment;

use super::channel::JsonChannel;
use super::error::RecordError;
use super::frame::Frame;
use super::sample_message::SamplesMessage;
use super::setup::{IDENTITY, OUTCOME, Setup};
use super::view::{View, nanoseconds};
use crate::geometry::ContourSet;
use crate::inspect::{ExplainedControl, GuardRecord};
use crate::results::{Document, tick_lines};
use crate::run::Trace;

/// Whiskers are drawn in every tick with an index that is a multiple of this.
const TICKS_PER_DRAWING: u64 = 2;

/// Writes the ticks of a run.
pub(super) struct Writer {
    /// Keeps the channels open.
    _context: Arc<Context>,
    file: McapWriterHandle<Cursor<Vec<u8>>>,
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

impl Writer {
    /// Begins a recording. `trace` is a trace of the run without ticks.
    pub(super) fn new(setup: &Setup, surfaces: &ContourSet, trace: Trace) -> Result<Self, RecordError> {
        let context = Context::new();
        let options = McapWriteOptions::new().compression(Some(McapCompression::Zstd)).profile("");
        let file = context.mcap_writer_with_options(options).create(Cursor::new(Vec::new()))?;
        file.write_metadata(IDENTITY, setup.identity.clone())?;
        for Attachment { name, data } in setup.attachments()? {
            let (media_type, data) = ("application/octet-stream".to_owned(), Cow::Owned(data));
            file.attach(&McapAttachment { log_time: 0, create_time: 0, name, media_type, data })?;
        }
        let view = View::new(setup.rig.clone(), &trace.whiskers);
        let scene = context.channel_builder("scene").build();
        scene.log_with_time(&View::scene(surfaces), 0);
        let objects = context.channel_builder("objects").build();
        objects.log_with_time(&View::objects(surfaces), 0);
        let platform = context.channel_builder("platform").build();
        platform.log_with_time(&view.platform(), 0);
        Ok(Self {
            file,
            samples: JsonChannel::Samples.open(&context)?,
            ticks: JsonChannel::Ticks.open(&context)?,
            state: JsonChannel::State.open(&context)?,
            guards: JsonChannel::Guards.open(&context)?,
            transitions: JsonChannel::Transitions.open(&context)?,
            transform: context.channel_builder("transform").build(),
            pose: context.channel_builder("pose").build(),
            whiskers: context.channel_builder("whiskers").build(),
            tips: context.channel_builder("tips").build(),
            contour: context.channel_builder("contour").build(),
            _context: context,
            view,
            rig_whiskers: setup.rig.whiskers.len(),
            scenario: setup.identity.get("scenario").cloned().unwrap_or_default(),
            friction: setup.rig.sensing.friction,
            trace,
            count: 0,
            end: 0.0,
        })
    }

    /// Writes a tick. `explained` is a second control loop with the same samples, if the policy has a text.
    pub(super) fn frame(
        &mut self,
        frame: Frame,
        explained: Option<&mut ExplainedControl<'_>>,
    ) -> Result<(), RecordError> {
        let time = frame.tick.time;
        let at = PartialMetadata::with_log_time(nanoseconds(time));
        log_json(&self.samples, &SamplesMessage::new(&frame.samples, self.rig_whiskers), at)?;
        if let Some(explained) = explained {
            let before = explained.transitions().len();
            explained.tick(&frame.samples);
            for line in explained.transitions().get(before..).unwrap_or_default() {
                log_json(&self.transitions, &line.versioned(), at)?;
            }
            log_json(&self.guards, &GuardsMessage { guards: explained.guards() }, at)?;
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
            log_json(&self.ticks, &line.versioned(), at)?;
        }
        (self.count, self.end) = (self.count + 1, time);
        Ok(())
    }

    /// Makes a tick the only one of the trace.
    fn fill_trace(&mut self, frame: Frame) {
        let Frame { tick, mut marks, plots, mut messages, samples: _ } = frame;
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

    /// Ends the recording. The result is the content of the file. `outcome` has the ending of the run.
    pub(super) fn finish(mut self, outcome: BTreeMap<String, String>) -> Result<Vec<u8>, RecordError> {
        if let Some(contour) = self.view.rest(self.end) {
            self.contour.log_with_time(&contour, nanoseconds(self.end));
        }
        self.file.write_metadata(OUTCOME, outcome)?;
        Ok(self.file.close()?.into_inner())
    }
}

fn log_json(channel: &RawChannel, message: &impl Serialize, at: PartialMetadata) -> Result<(), RecordError> {
    channel.log_with_meta(&serde_json::to_vec(message)?, at);
    Ok(())
}
