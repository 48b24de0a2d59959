//! Viewers that speak Foxglove's protocol. They get the channels of a recording.

use std::collections::BTreeMap;
use std::net::TcpStream;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use data_encoding::BASE64;
use foxglove::{Context, FoxgloveError, Metadata, RawChannel, Sink, SinkId};
use serde::Deserialize;
use serde_json::json;
use tungstenite::protocol::WebSocket;
use tungstenite::{Error, Message};

use super::hub::Hub;
use super::log::RunLog;
use super::socket::Socket;
use vibrissa_lab::inspect::{GuardRecord, LeafRecord, Margin};
use vibrissa_lab::recording::Channels;
use vibrissa_lab::stream::message::{Frame, GuardFrame, PartInfo};
use vibrissa_world::geometry::Point2;

/// The names of the protocol.
pub(super) const PROTOCOLS: [&str; 2] = ["foxglove.sdk.v1", "foxglove.websocket.v1"];
/// The first byte of a binary message with data.
const MESSAGE_DATA: u8 = 1;

/// Serves a viewer until its connection ends.
pub(super) fn serve_viewer(socket: WebSocket<TcpStream>, hub: &Arc<Hub>) -> Result<(), Error> {
    let mut viewer = Viewer { socket: Socket::new(socket)?, hub, subscriptions: BTreeMap::new(), run: None };
    hub.foxglove_viewer(true);
    let served = viewer.serve();
    hub.foxglove_viewer(false);
    served
}

/// A connection to a viewer.
struct Viewer<'h> {
    socket: Socket,
    hub: &'h Hub,
    /// For each subscription, the channel.
    subscriptions: BTreeMap<u32, u64>,
    run: Option<Run>,
}

/// The channels of the run that the viewer shows.
struct Run {
    number: u64,
    log: Arc<RunLog>,
    outlet: Arc<Outlet>,
    /// The channels, as soon as the run has had a tick.
    channels: Option<Channels>,
    /// The next tick to send.
    next: usize,
    /// Number of channels that the viewer knows.
    advertised: usize,
}

/// Receives the messages of the channels.
struct Outlet {
    id: SinkId,
    inner: Mutex<Inner>,
}

#[derive(Default)]
struct Inner {
    channels: Vec<Arc<RawChannel>>,
    /// Messages that wait to be sent: channel, time (ns) and content.
    messages: Vec<(u64, u64, Vec<u8>)>,
    /// The last message of each channel, for a later subscription.
    last: BTreeMap<u64, (u64, Vec<u8>)>,
}

impl Outlet {
    fn inner(&self) -> MutexGuard<'_, Inner> {
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Sink for Outlet {
    fn id(&self) -> SinkId {
        self.id
    }

    fn log(&self, channel: &RawChannel, message: &[u8], metadata: &Metadata) -> Result<(), FoxgloveError> {
        let (id, time) = (u64::from(channel.id()), metadata.log_time);
        let mut inner = self.inner();
        inner.messages.push((id, time, message.to_vec()));
        inner.last.insert(id, (time, message.to_vec()));
        Ok(())
    }

    fn add_channel(&self, channel: &Arc<RawChannel>) -> bool {
        self.inner().channels.push(Arc::clone(channel));
        false
    }
}

/// A request of a viewer. Others have no effect.
#[derive(Debug, Deserialize)]
#[serde(tag = "op", rename_all = "camelCase")]
enum Asked {
    Subscribe {
        subscriptions: Vec<Subscription>,
    },
    #[serde(rename_all = "camelCase")]
    Unsubscribe {
        subscription_ids: Vec<u32>,
    },
    #[serde(other)]
    Other,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
struct Subscription {
    id: u32,
    channel_id: u64,
}

impl Viewer<'_> {
    fn serve(&mut self) -> Result<(), Error> {
        loop {
            if let Some(message) = self.socket.receive()? {
                self.receive(&message)?;
            }
            self.update_run()?;
            if self.socket.is_ready() {
                self.send_ticks()?;
            }
        }
    }

    /// Takes a new run over, and tells the viewer its channels.
    fn update_run(&mut self) -> Result<(), Error> {
        let Some((number, log)) = self.hub.run() else { return Ok(()) };
        if self.run.as_ref().is_none_or(|run| run.number != number) {
            let outlet = Arc::new(Outlet { id: SinkId::next(), inner: Mutex::default() });
            let info = json!({
                "op": "serverInfo", "name": format!("vibrissa {}", log.facts.hello.command), "capabilities": [],
                "sessionId": number.to_string(),
            });
            self.socket.send(Message::text(info.to_string()))?;
            self.subscriptions.clear();
            self.run = Some(Run { number, log, outlet, channels: None, next: 0, advertised: 0 });
        }
        let Some(run) = &mut self.run else { return Ok(()) };
        run.open();
        let channels = run.outlet.inner().channels.clone();
        let new = channels.get(run.advertised..).unwrap_or_default();
        if new.is_empty() {
            return Ok(());
        }
        let channel = |channel: &Arc<RawChannel>| {
            let schema = channel.schema();
            let encoding = schema.map_or("", |schema| schema.encoding.as_str());
            let text = schema.map_or_else(String::new, |schema| match encoding {
                "jsonschema" => String::from_utf8_lossy(&schema.data).into_owned(),
                _ => BASE64.encode(&schema.data),
            });
            json!({
                "id": u64::from(channel.id()), "topic": channel.topic(), "encoding": channel.message_encoding(),
                "schemaName": schema.map_or("", |schema| schema.name.as_str()), "schemaEncoding": encoding, "schema": text,
            })
        };
        let advertise = json!({ "op": "advertise", "channels": new.iter().map(channel).collect::<Vec<_>>() });
        run.advertised = channels.len();
        self.socket.send(Message::text(advertise.to_string()))
    }

    /// Sends the messages of new ticks.
    fn send_ticks(&mut self) -> Result<(), Error> {
        let Some(run) = &mut self.run else { return Ok(()) };
        run.log_ticks();
        let messages = std::mem::take(&mut run.outlet.inner().messages);
        let mut has_sent = false;
        for (channel, time, data) in messages {
            for (&id, _) in self.subscriptions.iter().filter(|(_, subscribed)| **subscribed == channel) {
                self.socket.send(Message::binary(message_data(id, time, &data)))?;
                has_sent = true;
            }
        }
        if has_sent { self.socket.end_batch() } else { Ok(()) }
    }

    fn receive(&mut self, message: &Message) -> Result<(), Error> {
        let asked = message.to_text().ok().and_then(|text| serde_json::from_str(text).ok());
        match asked {
            Some(Asked::Subscribe { subscriptions }) => {
                for Subscription { id, channel_id } in subscriptions {
                    self.subscriptions.insert(id, channel_id);
                    let last = self.run.as_ref().and_then(|run| run.outlet.inner().last.get(&channel_id).cloned());
                    if let Some((time, data)) = last {
                        self.socket.send(Message::binary(message_data(id, time, &data)))?;
                    }
                }
            }
            Some(Asked::Unsubscribe { subscription_ids }) => {
                self.subscriptions.retain(|id, _| !subscription_ids.contains(id));
            }
            Some(Asked::Other) | None => {}
        }
        Ok(())
    }
}

impl Run {
    /// Opens the channels as soon as the names of the run are known.
    fn open(&mut self) {
        if self.channels.is_some() {
            return;
        }
        let Some(names) = self.log.names.get() else { return };
        let context = Context::new();
        context.add_sink(Arc::clone(&self.outlet) as Arc<dyn Sink>);
        let surfaces = self.log.scene.as_ref().map(|scene| &scene.truth.surfaces);
        let channels =
            Channels::new(context, (&self.log.facts.rig, &self.log.facts.hello.scenario), surfaces, names.clone());
        // Its errors are those of encoding, which no value of a run has.
        let Ok(mut channels) = channels else { return };
        let frames = self.log.past().newest(0, usize::MAX);
        channels.add_contour(frames.iter().flat_map(|frame| &frame.contour).map(|tip| Point2::from(tip.point)));
        self.next = frames.last().map_or(0, |frame| frame.tick + 1);
        self.channels = Some(channels);
    }

    /// Logs the ticks that are new. A slow viewer loses the oldest of them.
    fn log_ticks(&mut self) {
        let Some(channels) = &mut self.channels else { return };
        let ticks = self.log.past().raw(self.next);
        for (tick, raw, frame) in ticks {
            let guards =
                frame.filter(|_| !self.log.facts.hello.guards.is_empty()).map(|frame| guards(&self.log, &frame));
            // Values that are not finite are written as null, so nothing fails.
            let _ = channels.frame(raw.as_ref().clone(), guards.map(|guards| (&[][..], guards)));
            self.next = tick + 1;
        }
    }
}

/// A binary message with data of a channel.
fn message_data(subscription: u32, time: u64, data: &[u8]) -> Vec<u8> {
    let mut message = Vec::with_capacity(13 + data.len());
    message.push(MESSAGE_DATA);
    message.extend(subscription.to_le_bytes());
    message.extend(time.to_le_bytes());
    message.extend(data);
    message
}

/// The guards of a tick, as a recording has them.
fn guards(log: &RunLog, frame: &Frame) -> Vec<GuardRecord> {
    let record = |guard: &GuardFrame| {
        let info = log.facts.hello.guards.get(guard.guard)?;
        let part = |(index, part): (usize, &PartInfo)| {
            let is_missing = guard.missing.contains(&index);
            if !guard.met && !is_missing {
                return None;
            }
            let margin = guard.margins.get(index).copied().flatten().zip(part.unit.clone());
            let margin = margin.map(|(value, unit)| Margin { value, text: format!("{} {unit}", value.abs()), unit });
            Some(LeafRecord { text: part.text.clone(), holds: !is_missing, margin })
        };
        let state = info.state.and_then(|state| log.facts.hello.chart.states.get(state));
        Some(GuardRecord {
            state: state.map(|state| state.name.clone()),
            guard: info.text.clone(),
            file: info.file.clone(),
            line: info.line,
            target: info.target.clone(),
            is_met: guard.met,
            elapsed_s: guard.elapsed,
            needed_s: guard.needed,
            parts: info.parts.iter().enumerate().filter_map(part).collect(),
        })
    };
    frame.guards.iter().filter_map(record).collect()
}
