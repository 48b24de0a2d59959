//! The control task on the other side of a broker.

use std::sync::mpsc::sync_channel;
use std::sync::{Arc, Mutex};

use rtrb::{Producer, RingBuffer};
use vibrissa_robot::array::{Assembler, Round, StampedPose};
use vibrissa_robot::config::{Config, MqttConfig};
use vibrissa_robot::drive::{ControlTask, Inputs, LoopRecord, Outputs, StepTime, record_queues};
use vibrissa_robot::emulation::{Emulation, Settings, SwayingPlant};
use vibrissa_robot::services::{InputReader, InputTask, InputsError};
use vibrissa_robot::telemetry::{Source, Topic};
use vibrissa_robot::vitals::Vitals;
use vibrissa_runtime::control::Control;

use crate::PATIENCE;
use crate::emulated::{MS, parts};
use crate::listener::Listener;
use crate::mosquitto::Mosquitto;

/// Entries of a queue: more than one step takes.
const QUEUE: usize = 256;

/// The sensor IO of an emulated robot.
struct SensorIo {
    task: InputTask,
    rounds: Vec<Producer<Round>>,
    poses: Producer<StampedPose>,
}

impl SensorIo {
    fn new(config: &Config, broker: &Mosquitto) -> Self {
        let mqtt = MqttConfig::open("127.0.0.1".to_owned(), broker.address.port(), 1);
        let (rounds, receivers) = config.buses.iter().map(|_| RingBuffer::new(QUEUE)).unzip();
        let (poses, pose_receiver) = RingBuffer::new(QUEUE);
        let ([records, _], _) = record_queues();
        let task =
            InputTask::new(config, &mqtt, receivers, pose_receiver, records, Arc::new(Vitals::default())).unwrap();
        Self { task, rounds, poses }
    }

    /// Takes a record of the loop. True if it has published a step.
    fn take(&mut self, record: &LoopRecord) -> bool {
        match record {
            LoopRecord::Round(round) => self.rounds[usize::from(round.bus)].push(*round).unwrap(),
            LoopRecord::Pose(pose) => self.poses.push(*pose).unwrap(),
            LoopRecord::Step(step) => {
                let (due_ns, last_slot, origin_ns, newest_ns) =
                    (step.due_ns, step.last_slot, step.origin_ns, step.newest_ns);
                self.task.step(StepTime { due_ns, last_slot, origin_ns, newest_ns }, step.started_ns);
                return true;
            }
            _ => {}
        }
        false
    }
}

fn bits(command: vibrissa_runtime::signal::Command) -> [u64; 3] {
    let velocity = command.velocity_world;
    [velocity.x, velocity.y, command.yaw_rate].map(f64::to_bits)
}

#[test]
fn a_controller_behind_the_broker_gives_the_commands_of_the_whole_loop_bit_for_bit() {
    let Some(broker) = Mosquitto::start() else { return };
    let (config, program) = parts();
    let plant = SwayingPlant::new(config.rig.sensing.sample_rate.recip());
    let control = || Control::new(&config.rig, Arc::clone(&program)).unwrap();
    let mut emulation = Emulation::new(&config, control(), plant, &Settings::default()).unwrap();

    let vitals = Arc::new(Vitals::default());
    let (rounds, round_receivers) = config.buses.iter().map(|_| RingBuffer::new(QUEUE)).unzip();
    let (poses, pose_receiver) = RingBuffer::new(QUEUE);
    let (steps, due) = sync_channel(4);
    let (commands, mut sent) = RingBuffer::new(QUEUE);
    let ([records, _], _) = record_queues();
    let assembler = Assembler::new(&config, &config.sensor().unwrap());
    let inputs = Inputs { rounds: round_receivers, poses: pose_receiver };
    let outputs = Outputs { commands, records };
    let mut remote = ControlTask::new(&config, control(), assembler, inputs, outputs, Arc::clone(&vitals));
    let mut reader = InputReader::new(&config, rounds, poses, steps, vitals).unwrap();
    let topic = Topic::Inputs.of(&Source::SensorIo.name(&config.name));
    // The controller's clock is another one.
    let _listener = Listener::new(broker.address, &topic, move |_, arrival| {
        reader.take(&arrival.payload, 77_000_000_000).unwrap();
    });
    let mut sensor_io = SensorIo::new(&config, &broker);
    // A first message shows that the link is there.
    crate::wait_until("the connection of the sensor IO", || {
        let time = StepTime { due_ns: 0, last_slot: 0, origin_ns: 0, newest_ns: 0 };
        sensor_io.task.step(time, 0);
        due.recv_timeout(std::time::Duration::from_millis(100)).is_ok()
    });
    while due.try_recv().is_ok() {}

    let (mut whole, mut remotely) = (Vec::new(), Vec::new());
    while emulation.now_ns() < 8000 * MS {
        let until_ns = emulation.now_ns() + 10 * MS;
        emulation
            .run(until_ns, |_, command, _, _| {
                whole.push(bits(command));
                true
            })
            .unwrap();
        while let Some(record) = emulation.next_record() {
            if sensor_io.take(&record) {
                let step = due.recv_timeout(PATIENCE).unwrap();
                remote.step(step, || 77_000_000_000, |_, command, _| remotely.push(bits(command))).unwrap();
                while sent.pop().is_ok() {}
            }
        }
    }
    assert!(whole.len() > 190 && whole.iter().any(|command| *command != whole[0]), "{}", whole.len());
    assert!(whole == remotely, "{} and {} commands", whole.len(), remotely.len());
}

#[test]
fn inputs_of_another_run_another_array_or_other_rates_end_the_controller() {
    let Some(broker) = Mosquitto::start() else { return };
    let (config, program) = parts();
    let plant = SwayingPlant::new(config.rig.sensing.sample_rate.recip());
    let control = Control::new(&config.rig, program).unwrap();
    let mut emulation = Emulation::new(&config, control, plant, &Settings::default()).unwrap();
    emulation.run(100 * MS, |_, _, _, _| true).unwrap();
    let messages = Arc::<Mutex<Vec<Vec<u8>>>>::default();
    let own = Arc::clone(&messages);
    let _listener = Listener::new(broker.address, "vibrissa/#", move |_, arrival| {
        own.lock().unwrap().push(arrival.payload.clone());
    });
    let mut sensor_io = SensorIo::new(&config, &broker);
    let records: Vec<LoopRecord> = std::iter::from_fn(|| emulation.next_record()).collect();
    crate::wait_until("inputs with rounds", || {
        for record in records
            .iter()
            .take_while(|record| !matches!(record, LoopRecord::Step(_)))
            .chain(records.iter().find(|record| matches!(record, LoopRecord::Step(_))))
        {
            sensor_io.take(record);
        }
        !messages.lock().unwrap().is_empty()
    });
    let message: serde_json::Value = serde_json::from_slice(&messages.lock().unwrap()[0]).unwrap();
    let changed = |key: &str, value: serde_json::Value| {
        let mut changed = message.clone();
        *changed.pointer_mut(key).unwrap() = value;
        serde_json::to_vec(&changed).unwrap()
    };
    let taken = |messages: &[Vec<u8>]| {
        let (rounds, _receivers): (_, Vec<_>) = config.buses.iter().map(|_| RingBuffer::new(QUEUE)).unzip();
        let ((poses, _taken), (steps, _due)) = (RingBuffer::new(QUEUE), sync_channel(4));
        let mut reader = InputReader::new(&config, rounds, poses, steps, Arc::default()).unwrap();
        messages.iter().map(|message| reader.take(message, 0)).collect::<Result<Vec<_>, _>>().map(drop)
    };
    let same = serde_json::to_vec(&message).unwrap();
    assert_eq!(taken(&[same.clone(), same.clone()]), Ok(()));
    assert_eq!(taken(&[same.clone(), changed("/session", 1.into())]), Err(InputsError::Session));
    assert!(matches!(taken(&[changed("/sample_rate_hz", 100.0.into())]), Err(InputsError::Rates { .. })));
    assert_eq!(taken(&[changed("/rounds/0/bus", 7.into())]), Err(InputsError::Array));
    assert_eq!(taken(&[changed("/rounds/0/boards", serde_json::json!([]))]), Err(InputsError::Array));
    assert!(matches!(taken(&[b"{}".to_vec()]), Err(InputsError::Unreadable(_))));
}
