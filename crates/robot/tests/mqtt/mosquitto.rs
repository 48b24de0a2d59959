//! A broker for one test.

use std::io::Write;
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use crate::PATIENCE;

/// A running Mosquitto on the loopback interface. It ends with the test.
pub(crate) struct Mosquitto {
    program: PathBuf,
    directory: tempfile::TempDir,
    lines: String,
    child: Option<Child>,
    pub(crate) address: SocketAddr,
}

impl Mosquitto {
    /// Starts a broker. `None` if there is none on this machine, which CI does not accept.
    pub(crate) fn start() -> Option<Self> {
        Self::with(
            "persistence false\nmax_queued_messages 0\nmax_inflight_messages 0\nlog_dest stderr\nlog_type error\n",
        )
    }

    /// Starts a broker for everybody, with further lines of its configuration.
    pub(crate) fn with(lines: &str) -> Option<Self> {
        Self::closed(&format!("allow_anonymous true\n{lines}"))
    }

    /// Starts a broker only for those whom these lines of its configuration name.
    pub(crate) fn closed(lines: &str) -> Option<Self> {
        let program = find("mosquitto", "mosquitto")?;
        let directory = tempfile::tempdir().unwrap();
        let mut broker = Self { program, directory, lines: lines.to_owned(), child: None, address: free_port() };
        // Another program may have taken the port meanwhile.
        while !broker.run() {
            broker.address = free_port();
        }
        Some(broker)
    }

    /// Ends the broker without a farewell, as a loss of power does.
    pub(crate) fn kill(&mut self) {
        let mut child = self.child.take().unwrap();
        child.kill().unwrap();
        child.wait().unwrap();
    }

    /// Makes the broker hang. The system still accepts its packets.
    pub(crate) fn hang(&self) {
        let process = self.child.as_ref().unwrap().id().to_string();
        assert!(Command::new("kill").args(["-STOP", &process]).status().unwrap().success());
    }

    /// Starts the broker again, with the same port.
    pub(crate) fn restart(&mut self) {
        assert!(self.run(), "the port {} is taken", self.address);
    }

    /// True if the broker accepts connections, false if it has ended.
    fn run(&mut self) -> bool {
        let config = self.directory.path().join("mosquitto.conf");
        let text = format!("listener {} 127.0.0.1\n{}", self.address.port(), self.lines);
        std::fs::write(&config, text).unwrap();
        let mut command = Command::new(&self.program);
        let mut child = command.arg("-c").arg(config).stdin(Stdio::null()).stdout(Stdio::null()).spawn().unwrap();
        let before = std::time::Instant::now();
        while TcpStream::connect(self.address).is_err() {
            if child.try_wait().unwrap().is_some() {
                return false;
            }
            assert!(before.elapsed() < PATIENCE, "Mosquitto accepts no connection");
            std::thread::sleep(Duration::from_millis(10));
        }
        self.child = Some(child);
        true
    }
}

impl Drop for Mosquitto {
    fn drop(&mut self) {
        if self.child.is_some() {
            self.kill();
        }
    }
}

/// A program of a Debian package, which may be in a folder that is not on every user's path. `None` if there is none on this
/// machine, which CI does not accept.
pub(crate) fn find(program: &str, package: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folders = std::env::split_paths(&path).chain([PathBuf::from("/usr/sbin"), PathBuf::from("/usr/local/sbin")]);
    let found = folders.map(|folder| folder.join(program)).find(|file| file.is_file());
    if found.is_none() {
        let needed = format!("the program `{program}` (Debian: `apt-get install {package}`)");
        assert!(std::env::var_os("CI").is_none_or(|ci| ci.is_empty()), "CI needs {needed}");
        // Past the capture of the output, so that the message is seen.
        std::io::stderr().write_all(format!("skipped: there is not {needed}\n").as_bytes()).unwrap();
    }
    found
}

/// A port that is free now.
pub(crate) fn free_port() -> SocketAddr {
    TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap().local_addr().unwrap()
}
