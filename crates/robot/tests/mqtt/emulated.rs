//! An emulated robot with telemetry.

use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use vibrissa_robot::config::{Config, MqttConfig};
use vibrissa_robot::drive::RecordSink;
use vibrissa_robot::emulation::{Emulation, Settings, SwayingPlant};
use vibrissa_robot::telemetry::{Publisher, Source, TelemetrySink};
use vibrissa_runtime::control::Control;
use vibrissa_runtime::machine::{Artifact, Program};
use vibrissa_runtime::rig::Rig;

/// Milliseconds in nanoseconds.
pub(crate) const MS: u64 = 1_000_000;

/// The reference rig under the policy `bang`, in emulated time.
pub(crate) struct EmulatedRobot {
    emulation: Emulation<SwayingPlant>,
    telemetry: Option<TelemetrySink>,
    /// The commands of the machine, by their bits.
    pub(crate) commands: Vec<[u64; 3]>,
}

impl EmulatedRobot {
    /// A robot without telemetry.
    pub(crate) fn new(settings: &Settings) -> Self {
        let (config, program) = parts();
        let control = Control::new(&config.rig, program).unwrap();
        let plant = SwayingPlant::new(config.rig.sensing.sample_rate.recip());
        let emulation = Emulation::new(&config, control, plant, settings).unwrap();
        Self { emulation, telemetry: None, commands: Vec::new() }
    }

    /// A robot whose telemetry has this broker, and a buffer for so many messages.
    pub(crate) fn with_telemetry(settings: &Settings, broker: SocketAddr, buffer: usize) -> Self {
        let (config, program) = parts();
        let mqtt = MqttConfig::open(broker.ip().to_string(), broker.port(), buffer);
        let publisher = Publisher::start(&config.name, &mqtt, |_| {}).unwrap();
        let telemetry = Some(TelemetrySink::new(&config, Source::Loop(&program), publisher, 0));
        Self { telemetry, ..Self::new(settings) }
    }

    /// Runs for so many milliseconds of emulated time.
    pub(crate) fn run(&mut self, duration_ms: u64) {
        let end_ns = self.emulation.now_ns() + duration_ms * MS;
        while self.emulation.now_ns() < end_ns {
            let until_ns = self.emulation.now_ns() + 10 * MS;
            let commands = &mut self.commands;
            let observe = |_: &_, command: vibrissa_runtime::signal::Command, _: &_, _: &mut _| {
                let velocity = command.velocity_world;
                commands.push([velocity.x, velocity.y, command.yaw_rate].map(f64::to_bits));
                true
            };
            self.emulation.run(until_ns, observe).unwrap();
            while let Some(record) = self.emulation.next_record() {
                if let Some(telemetry) = &mut self.telemetry {
                    telemetry.take(&record);
                }
            }
            if let Some(telemetry) = &mut self.telemetry {
                telemetry.pause(self.emulation.now_ns(), self.emulation.vitals());
            }
        }
    }

    /// Runs until the telemetry has noticed that the broker is there or gone.
    pub(crate) fn run_until_broker_is(&mut self, is_gone: bool) {
        crate::wait_until("the change of the broker", || {
            self.run(10);
            // Emulated time does not wait for the broker.
            std::thread::sleep(Duration::from_millis(10));
            self.emulation.vitals().is_broker_gone.load(std::sync::atomic::Ordering::Acquire) == is_gone
        });
    }

    /// The number of messages in the buffer, and of those that have been dropped.
    pub(crate) fn counts(&self) -> (usize, u64) {
        self.telemetry.as_ref().unwrap().publisher().counts()
    }

    /// Ends the telemetry.
    pub(crate) fn finish(&mut self) {
        self.telemetry.as_mut().unwrap().finish();
    }
}

pub(crate) fn parts() -> (Config, Arc<Program>) {
    let config = Config::emulated(Rig::default(), Settings::default().noise_microtesla);
    let artifact = Artifact::from_bytes(include_bytes!("../../../runtime/fixtures/bang.machine")).unwrap();
    (config, Arc::new(artifact.program))
}
