//! The program under test, and the actuator and localisation around it.

use std::fs::File;
use std::net::{SocketAddr, UdpSocket};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use vibrissa_robot::link::{CommandPacket, PosePacket};
use vibrissa_robot::recording::{Part, Recording, Replayed, replay};
use vibrissa_runtime::geometry::{Point2, Pose};

use crate::server::{Server, scratch, shim};

/// The longest wait for a packet. It is only reached when the test fails.
pub(crate) const PATIENCE: Duration = Duration::from_secs(20);

/// The program on the emulated buses.
pub(crate) fn program(server: &Server, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_vibrissa-robot"));
    command.args(arguments).env("LD_PRELOAD", shim()).env("VIBRISSA_I2C", &server.socket);
    command
}

/// The files of a run.
pub(crate) struct Files {
    pub(crate) config: String,
    pub(crate) machine: String,
    recordings: PathBuf,
}

impl Files {
    /// A configuration with these links, and a machine.
    pub(crate) fn new(name: &str, links: &str) -> Self {
        let config = scratch().join(format!("{name}.yaml"));
        let recordings = scratch().join(format!("{name}-recordings"));
        let _ = std::fs::remove_dir_all(&recordings);
        let text = format!(
            "name: test\n\
             buses:\n\
             - {{device: /dev/i2c-1, clock: 1 kHz, boards: [{{whisker: r0, address: 12}}]}}\n\
             - {{device: /dev/i2c-3, clock: 1 kHz, boards: [{{whisker: l0, address: 12}}]}}\n\
             limits: {{speed: 0.2 m/s, yaw_rate: 1 rad/s}}\n\
             timeouts: {{bus: 80 ms, sensor: 80 ms, pose: 120 ms, control: 120 ms, link: 160 ms}}\n\
             record: {{directory: '{}'}}\n\
             {links}",
            recordings.display()
        );
        std::fs::write(&config, text).unwrap();
        let machine = scratch().join(format!("{name}.machine"));
        std::fs::write(&machine, include_bytes!("../../../runtime/fixtures/bang.machine")).unwrap();
        Self { config: config.display().to_string(), machine: machine.display().to_string(), recordings }
    }

    pub(crate) fn drive(&self, server: &Server) -> Running {
        self.drive_by(server, &[&self.machine])
    }

    /// Drives the machine of a store.
    pub(crate) fn drive_store(&self, server: &Server, store: &Path, good_after: &str) -> Running {
        self.drive_by(server, &["--store", store.to_str().unwrap(), "--good-after", good_after])
    }

    fn drive_by(&self, server: &Server, machine: &[&str]) -> Running {
        // The emulated bus is slower than a real one, so its clock is not measured.
        let arguments = [&["drive", "--config", &self.config, "--skip-admission"], machine].concat();
        Running(program(server, &arguments).stderr(Stdio::inherit()).spawn().unwrap())
    }
}

/// An actuator that acknowledges every command, and a localisation that sends poses.
pub(crate) struct Outside {
    pub(crate) files: Files,
    actuator: UdpSocket,
    /// Address to which the poses go.
    pub(crate) poses: SocketAddr,
    are_poses_paused: Arc<AtomicBool>,
    /// Sequence number of the last pose.
    pose_number: Arc<AtomicU64>,
    has_ended: Arc<AtomicBool>,
}

impl Outside {
    pub(crate) fn new(name: &str) -> Self {
        Self::with(name, "")
    }

    /// The same, with further links of the configuration.
    pub(crate) fn with(name: &str, links: &str) -> Self {
        let actuator = UdpSocket::bind("127.0.0.1:0").unwrap();
        actuator.set_read_timeout(Some(PATIENCE)).unwrap();
        // The program binds this port after it has been released here.
        let poses = UdpSocket::bind("127.0.0.1:0").unwrap().local_addr().unwrap();
        let links = format!(
            "actuator: {{udp: {{address: '{}'}}}}\n\
             pose: {{udp: {{listen: '{poses}', from: 127.0.0.1}}}}\n\
             {links}",
            actuator.local_addr().unwrap()
        );
        let outside = Self {
            files: Files::new(name, &links),
            actuator,
            poses,
            are_poses_paused: Arc::default(),
            pose_number: Arc::default(),
            has_ended: Arc::default(),
        };
        outside.send_poses();
        outside
    }

    /// The replay of the recording of the run.
    pub(crate) fn replay(&self) -> Replayed {
        let files = std::fs::read_dir(&self.files.recordings).unwrap();
        let parts = files.map(|entry| Part::open(File::open(entry.unwrap().path()).unwrap()).unwrap()).collect();
        replay(Recording::join(parts).unwrap()).unwrap()
    }

    pub(crate) fn pause_poses(&self, is_paused: bool) {
        self.are_poses_paused.store(is_paused, Ordering::Relaxed);
    }

    /// The localisation starts again, and numbers its poses from 1.
    pub(crate) fn restart_poses(&self) {
        self.pose_number.store(0, Ordering::Relaxed);
    }

    /// Acknowledges commands until one of them is as `wanted`.
    pub(crate) fn wait_for(&self, wanted: impl Fn(&CommandPacket) -> bool) -> CommandPacket {
        let before = Instant::now();
        let mut bytes = [0; 64];
        loop {
            let (length, sender) = self.actuator.recv_from(&mut bytes).unwrap();
            let packet = CommandPacket::from_bytes(&bytes[..length]).unwrap();
            self.actuator.send_to(&packet.acknowledgement(), sender).unwrap();
            assert!(!packet.is_stop || packet.command.velocity_world.norm() == 0.0);
            if wanted(&packet) {
                return packet;
            }
            assert!(before.elapsed() < PATIENCE, "no such command, the last was {packet:?}");
        }
    }

    fn send_poses(&self) {
        let (is_paused, has_ended) = (Arc::clone(&self.are_poses_paused), Arc::clone(&self.has_ended));
        let (to, number) = (self.poses, Arc::clone(&self.pose_number));
        std::thread::spawn(move || {
            let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
            let pose = Pose { position: Point2::origin(), heading: 0.0 };
            while !has_ended.load(Ordering::Relaxed) {
                let sequence = number.fetch_add(1, Ordering::Relaxed) + 1;
                if !is_paused.load(Ordering::Relaxed) {
                    let _ = socket.send_to(&PosePacket { sequence, pose }.to_bytes(), to);
                }
                std::thread::sleep(Duration::from_millis(5));
            }
        });
    }
}

impl Drop for Outside {
    fn drop(&mut self) {
        self.has_ended.store(true, Ordering::Relaxed);
    }
}

/// The running program. It ends with the test.
pub(crate) struct Running(pub(crate) Child);

impl Running {
    /// Sends SIGTERM.
    pub(crate) fn terminate(&self) {
        let status = Command::new("kill").args(["-TERM", &self.0.id().to_string()]).status().unwrap();
        assert!(status.success());
    }

    /// Sends SIGKILL.
    pub(crate) fn kill(&mut self) {
        self.0.kill().unwrap();
        self.0.wait().unwrap();
    }

    pub(crate) fn wait(&mut self) -> std::process::ExitStatus {
        self.0.wait().unwrap()
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // It fails for a program that has ended.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}
