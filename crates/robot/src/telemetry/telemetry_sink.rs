//! The sink that publishes the loop's records.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::{SystemTime, UNIX_EPOCH};

use serde::Serialize;

use super::payload::{Durations, Health, Latency, MissedPeriods, Numbered, VERSION};
use super::publisher::Publisher;
use super::source::Source;
use super::topic::Topic;
use super::translator::{Note, Translator};
use crate::config::Config;
use crate::drive::{LoopRecord, RecordSink};
use crate::histogram::Histogram;
use crate::mqtt::Message;
use crate::vitals::{Phase, Vitals};

/// Period (ns) of the health and of the state.
const HEALTH_NS: u64 = 1_000_000_000;
/// Period (ns) of the histograms.
const LATENCY_NS: u64 = 5_000_000_000;

/// Publishes the loop's records over MQTT.
#[derive(Debug)]
pub struct TelemetrySink {
    outlet: Outlet,
    translator: Translator,
    buses: usize,
    next_health_ns: u64,
    next_latency_ns: u64,
    /// Time of the last record or look (ns).
    now_ns: u64,
}

/// Numbers messages and passes them to the publisher.
#[derive(Debug)]
struct Outlet {
    publisher: Publisher,
    /// The published topics and their names.
    topics: Vec<(Topic, Arc<str>)>,
    sequence: u64,
    /// Start of the program by the system's clock (s since 1970).
    started_unix_s: f64,
}

impl Outlet {
    fn send<T: Serialize>(&mut self, topic: Topic, time_ns: u64, content: T) {
        let Some((_, name)) = self.topics.iter().find(|(own, _)| *own == topic) else { return };
        self.sequence += 1;
        let time_s = seconds(time_ns);
        let message = Numbered { sequence: self.sequence, time_s, unix_s: self.started_unix_s + time_s, content };
        // Payloads have only keys that are text, and JSON has all of their values.
        if let Ok(payload) = serde_json::to_vec(&message) {
            self.publisher.push(Message { topic: Arc::clone(name), payload, is_retained: topic.is_retained() });
        }
    }
}

impl TelemetrySink {
    /// A sink for a robot with this configuration, whose records are those of `source`. `now_ns` is the time since the start
    /// of the program.
    #[must_use]
    pub fn new(config: &Config, source: Source<'_>, publisher: Publisher, now_ns: u64) -> Self {
        let name = source.name(&config.name);
        let published = Topic::ALL.into_iter().filter(|topic| source.publishes(*topic));
        let topics = published.map(|topic| (topic, topic.of(&name).into())).collect();
        Self {
            outlet: Outlet { publisher, topics, sequence: 0, started_unix_s: started_unix_s(now_ns) },
            translator: Translator::new(config, source.program()),
            buses: config.buses.len(),
            next_health_ns: 0,
            next_latency_ns: 0,
            now_ns,
        }
    }

    /// The publisher of the messages.
    #[must_use]
    pub fn publisher(&self) -> &Publisher {
        &self.outlet.publisher
    }

    fn send(&mut self, time_ns: u64, note: Note) {
        match note {
            Note::State(state) => self.outlet.send(Topic::State, time_ns, state),
            Note::Samples(samples) => self.outlet.send(Topic::Samples, time_ns, samples),
            Note::Perception(perception) => self.outlet.send(Topic::Perception, time_ns, perception),
            Note::CommandLog(commands) => self.outlet.send(Topic::CommandLog, time_ns, commands),
            Note::Fault(note) => self.outlet.send(Topic::Events, time_ns, note),
        }
    }

    fn health(&self, vitals: &Vitals) -> Health {
        let (buffered_messages, dropped_messages) = self.outlet.publisher.counts();
        let missed = |phase| vitals.missed(phase);
        Health {
            version: VERSION,
            is_running: vitals.is_running.load(Ordering::Acquire),
            faults: self.translator.faults().to_vec(),
            missed_periods: MissedPeriods {
                acquisition: missed(Phase::Acquisition),
                control: missed(Phase::Control),
                supervision: missed(Phase::Supervision),
            },
            lost_records: self.translator.lost_records(),
            buffered_messages,
            dropped_messages,
        }
    }

    fn latency(&self, vitals: &Vitals) -> Latency {
        Latency {
            rounds: vitals.round_time.iter().take(self.buses).map(durations).collect(),
            tick: durations(&vitals.tick_time),
            tick_lateness: durations(&vitals.tick_lateness),
            sample_age: durations(&vitals.sample_age),
        }
    }
}

impl RecordSink for TelemetrySink {
    fn take(&mut self, record: &LoopRecord) {
        let mut notes = Vec::new();
        self.translator.take(record, &mut |time_ns, note| notes.push((time_ns, note)));
        for (time_ns, note) in notes {
            self.send(time_ns, note);
        }
    }

    fn pause(&mut self, now_ns: u64, vitals: &Vitals) {
        self.now_ns = now_ns;
        // The system's clock may be set during the run, such as by the network after a start without a battery.
        self.outlet.started_unix_s = started_unix_s(now_ns);
        vitals.is_broker_gone.store(self.outlet.publisher.is_broker_gone(), Ordering::Release);
        if now_ns >= self.next_health_ns {
            self.next_health_ns = now_ns + HEALTH_NS;
            let health = self.health(vitals);
            self.outlet.send(Topic::Health, now_ns, health);
            self.outlet.send(Topic::State, now_ns, self.translator.state());
        }
        if now_ns >= self.next_latency_ns {
            self.next_latency_ns = now_ns + LATENCY_NS;
            let latency = self.latency(vitals);
            self.outlet.send(Topic::Latency, now_ns, latency);
        }
    }

    fn finish(&mut self) {
        if let Some(commands) = self.translator.rest() {
            self.send(self.now_ns, commands);
        }
        self.outlet.send(Topic::State, self.now_ns, self.translator.state());
        self.outlet.publisher.end();
    }
}

/// The start of the program by the system's clock (s since 1970), when `now_ns` have passed since then.
fn started_unix_s(now_ns: u64) -> f64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0.0, |time| time.as_secs_f64()) - seconds(now_ns)
}

fn durations(histogram: &Histogram) -> Durations {
    let (ends_ns, counts): (Vec<_>, Vec<_>) = histogram.buckets().unzip();
    Durations {
        count: counts.iter().sum(),
        largest_s: seconds(histogram.largest_ns()),
        upper_end_s: ends_ns.into_iter().map(seconds).collect(),
        counts,
    }
}

pub(super) fn seconds(ns: u64) -> f64 {
    ns as f64 * 1e-9
}
