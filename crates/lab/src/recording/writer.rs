//! Encoding of a recording.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Cursor;

use foxglove::{Context, McapAttachment, McapCompression, McapWriteOptions, McapWriterHandle};
use vibrissa_robot::recording::Attachment;

use super::channels::Channels;
use super::error::RecordError;
use super::frame::RecordedFrame;
use super::setup::{IDENTITY, OUTCOME, Setup};
use crate::inspect::ExplainedControl;
use crate::run::Trace;
use vibrissa_world::geometry::ContourSet;

/// Writes the ticks of a run.
pub(super) struct Writer {
    file: McapWriterHandle<Cursor<Vec<u8>>>,
    channels: Channels,
}

impl Writer {
    /// Begins a recording. `surfaces` are the outlines of the objects, if they are known. `trace` is a trace of the run without
    /// ticks.
    pub(super) fn new(setup: &Setup, surfaces: Option<&ContourSet>, trace: Trace) -> Result<Self, RecordError> {
        let context = Context::new();
        let options = McapWriteOptions::new().compression(Some(McapCompression::Zstd)).profile("");
        let file = context.mcap_writer_with_options(options).create(Cursor::new(Vec::new()))?;
        file.write_metadata(IDENTITY, setup.identity.clone())?;
        for Attachment { name, data } in setup.attachments()? {
            let (media_type, data) = ("application/octet-stream".to_owned(), Cow::Owned(data));
            file.attach(&McapAttachment { log_time: 0, create_time: 0, name, media_type, data })?;
        }
        let scenario = setup.identity.get("scenario").map_or("", String::as_str);
        let channels = Channels::new(context, (&setup.rig, scenario), surfaces, trace)?;
        Ok(Self { file, channels })
    }

    /// Writes a tick. `explained` is a second control loop with the same samples, if the policy has a text.
    pub(super) fn frame(
        &mut self,
        frame: RecordedFrame,
        explained: Option<&mut ExplainedControl<'_>>,
    ) -> Result<(), RecordError> {
        let Some(explained) = explained else { return self.channels.frame(frame, None) };
        let before = explained.transitions().len();
        explained.tick(&frame.samples);
        let transitions = explained.transitions().get(before..).unwrap_or_default();
        self.channels.frame(frame, Some((transitions, explained.guards())))
    }

    /// Ends the recording. The result is the content of the file. `outcome` has the ending of the run.
    pub(super) fn finish(mut self, outcome: BTreeMap<String, String>) -> Result<Vec<u8>, RecordError> {
        self.channels.finish();
        self.file.write_metadata(OUTCOME, outcome)?;
        Ok(self.file.close()?.into_inner())
    }
}
