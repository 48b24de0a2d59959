//! The threads of the two services.

use std::sync::Arc;
use std::sync::mpsc::sync_channel;

use rtrb::RingBuffer;
use vibrissa_runtime::control::Control;

use super::system_clock::SystemClock;
use super::thread_bodies::{control_by_inputs, pass_on, publish_inputs, receive_poses, supervise};
use super::threads::{Common, OpenBus, PoseReceiver, ThreadError, Threads};
use crate::array::{Assembler, Bus};
use crate::config::{Config, MqttConfig};
use crate::drive::{ControlTask, Inputs, Outputs, QUEUE, RecordSink, Supervisor, record_queues};
use crate::link::{Actuator, MqttActuator, MqttLink, PACKET_BYTES, PoseGate};
use crate::services::{InputReader, InputTask, RemoteCommands};
use crate::telemetry::{Source, Topic};

/// Steps that wait for the control task. More mean that it hangs.
const STEPS: usize = 16;

/// Everything that the threads of the sensor IO need.
pub(super) struct SensorIo<B> {
    pub(super) config: Config,
    pub(super) broker: MqttConfig,
    pub(super) buses: Vec<OpenBus<B>>,
    pub(super) actuator: Box<dyn Actuator>,
    pub(super) poses: PoseReceiver,
    pub(super) sinks: Vec<Box<dyn RecordSink>>,
    pub(super) clock: SystemClock,
}

impl<B: Bus + 'static> SensorIo<B> {
    /// Starts all threads. The platform stands still until commands of a controller arrive.
    pub(super) fn start(self) -> Result<Threads, ThreadError> {
        let Self { config, broker, buses, actuator, poses, sinks, clock } = self;
        let (common, errors) = Common::new(&config, clock);
        let (mut handles, rounds) = common.acquisitions(&config, buses)?;
        let (pose_sender, pose_receiver) = RingBuffer::new(QUEUE);
        let ([input_records, supervision_records], records) = record_queues();
        let vitals = || Arc::clone(&common.vitals);
        let task = InputTask::new(&config, &broker, rounds, pose_receiver, input_records, vitals())?;
        let tick_periods = config.rounds_per_tick();
        handles.push(common.spawn("inputs", move |common| publish_inputs(common, task, tick_periods))?);
        let (supervisor, commands) = (Supervisor::new(&config), RemoteCommands::new(&config, &broker, vitals())?);
        handles.push(common.spawn("supervision", move |common| {
            supervise(common, supervisor, actuator, commands, supervision_records);
        })?);
        let (gate, latency) = (PoseGate::new(&config), config.pose.latency);
        handles.push(common.spawn("pose", move |common| receive_poses(common, poses, gate, latency, pose_sender))?);
        handles.push(common.spawn("telemetry", move |common| pass_on(common, records, sinks))?);
        Ok(common.running(errors, handles, config.buses.len(), false))
    }
}

/// Everything that the threads of the controller need.
pub(super) struct Controller {
    pub(super) config: Config,
    pub(super) broker: MqttConfig,
    pub(super) control: Control,
    pub(super) sinks: Vec<Box<dyn RecordSink>>,
    pub(super) clock: SystemClock,
}

impl Controller {
    /// Starts all threads. The machine begins once every whisker has its neutral value.
    pub(super) fn start(self) -> Result<Threads, ThreadError> {
        let Self { config, broker, control, sinks, clock } = self;
        let sensor = config.sensor()?;
        let (common, errors) = Common::new(&config, clock);
        let (rounds, round_receivers) = config.buses.iter().map(|_| RingBuffer::new(QUEUE)).unzip();
        let (poses, pose_receiver) = RingBuffer::new(QUEUE);
        let (steps, step_receiver) = sync_channel(STEPS);
        let (command_sender, commands) = RingBuffer::new(QUEUE);
        let ([control_records, supervision_records], records) = record_queues();
        let task = ControlTask::new(
            &config,
            control,
            Assembler::new(&config, &sensor),
            Inputs { rounds: round_receivers, poses: pose_receiver },
            Outputs { commands: command_sender, records: control_records },
            Arc::clone(&common.vitals),
        );
        let name = Source::SensorIo.name(&config.name);
        let (supervisor, actuator) = (Supervisor::new(&config), MqttActuator::new(&name, &broker, true)?);
        let mut handles = Vec::new();
        handles.push(common.spawn("supervision", move |common| {
            supervise(common, supervisor, Box::new(actuator), commands, supervision_records);
        })?);
        handles.push(common.spawn("telemetry", move |common| pass_on(common, records, sinks))?);
        let mut reader = InputReader::new(&config, rounds, poses, steps, Arc::clone(&common.vitals))?;
        let own = common.clone();
        let receive = move |message: &[u8]| {
            if let Err(error) = reader.take(message, own.clock.now_ns()) {
                // The receiver is gone only if the program ends anyway.
                let _ = own.errors.send(error.into());
            }
        };
        let subscription = Some(Topic::Inputs.of(&name));
        // It sends nothing, so its buffer does not matter.
        let link = MqttLink::start(&name, "control", &broker, PACKET_BYTES, subscription, || None, receive)?;
        let body = move |common: &Common| {
            control_by_inputs(common, task, &step_receiver);
            drop(link);
        };
        handles.push(common.spawn("control", body)?);
        Ok(common.running(errors, handles, 0, false))
    }
}
