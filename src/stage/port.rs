//! A serial line on which a device sends and receives lines of text.

use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fd::OwnedFd;
use rustix::fs::{Mode, OFlags, open};
use rustix::termios::{ControlModes, OptionalActions, QueueSelector, ioctl_tiocexcl, tcflush, tcgetattr, tcsetattr};

/// Speed of the line (bit/s), the default of 3-D printers.
pub(super) const BAUD: u32 = 115_200;
/// Longest line that is kept (bytes). What has no end of line is noise, for instance at a wrong speed.
const LONGEST: usize = 4096;

/// A serial line.
#[derive(Debug)]
pub(super) struct Port {
    device: OwnedFd,
    /// What has been received after the last complete line.
    received: Vec<u8>,
}

impl Port {
    /// Opens a device for this process alone, with 8 bits and without parity and echo.
    pub(super) fn open(path: &Path) -> io::Result<Self> {
        // Without waiting for a carrier, which a printer does not have.
        let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::NONBLOCK | OFlags::CLOEXEC;
        let device = open(path, flags, Mode::empty())?;
        let mut settings = tcgetattr(&device)?;
        settings.make_raw();
        settings.control_modes |= ControlModes::CLOCAL | ControlModes::CREAD;
        // A hang-up at the end would start many printers again, and they would forget where they are.
        settings.control_modes -= ControlModes::HUPCL;
        settings.set_speed(BAUD)?;
        ioctl_tiocexcl(&device)?;
        tcsetattr(&device, OptionalActions::Now, &settings)?;
        tcflush(&device, QueueSelector::IOFlush)?;
        Ok(Self { device, received: Vec::new() })
    }

    /// Sends a line.
    pub(super) fn send(&mut self, line: &str) -> io::Result<()> {
        let text = format!("{line}\n");
        let mut rest = text.as_bytes();
        while !rest.is_empty() {
            self.wait(PollFlags::OUT, None)?;
            match rustix::io::write(&self.device, rest) {
                Ok(count) => rest = rest.get(count..).unwrap_or_default(),
                Err(error) => passing(error)?,
            }
        }
        Ok(())
    }

    /// The next line, without its end. `None` if there is none until this time.
    pub(super) fn line(&mut self, until: Instant) -> io::Result<Option<String>> {
        loop {
            if let Some(end) = self.received.iter().position(|byte| *byte == b'\n') {
                let line: Vec<u8> = self.received.drain(..=end).collect();
                return Ok(Some(String::from_utf8_lossy(&line).trim().to_owned()));
            }
            if !self.wait(PollFlags::IN, Some(until))? {
                return Ok(None);
            }
            let mut bytes = [0; 256];
            match rustix::io::read(&self.device, &mut bytes) {
                Ok(0) => return Err(io::ErrorKind::UnexpectedEof.into()),
                Ok(count) => self.received.extend(bytes.iter().take(count)),
                Err(error) => passing(error)?,
            }
            if self.received.len() > LONGEST {
                self.received.clear();
            }
        }
    }

    /// Waits for the device. False if it is not ready until this time.
    fn wait(&self, ready: PollFlags, until: Option<Instant>) -> io::Result<bool> {
        loop {
            let left = until.map(|until| until.saturating_duration_since(Instant::now()));
            let left = left.map(|left| Timespec {
                tv_sec: i64::try_from(left.as_secs()).unwrap_or(i64::MAX),
                tv_nsec: left.subsec_nanos().into(),
            });
            match poll(&mut [PollFd::new(&self.device, ready)], left.as_ref()) {
                Ok(count) => return Ok(count > 0),
                Err(error) => passing(error)?,
            }
        }
    }

    /// Waits until the device has been silent for this time, and forgets what it has sent.
    pub(super) fn drain(&mut self, silence: Duration) -> io::Result<()> {
        while self.line(Instant::now() + silence)?.is_some() {}
        self.received.clear();
        Ok(())
    }
}

/// An error after which a call is repeated. Any other is returned.
fn passing(error: rustix::io::Errno) -> io::Result<()> {
    if matches!(error, rustix::io::Errno::INTR | rustix::io::Errno::AGAIN) { Ok(()) } else { Err(error.into()) }
}
