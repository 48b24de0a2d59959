//! A 3-D printer on a pseudo-terminal. It answers as Marlin does.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fd::OwnedFd;
use rustix::fs::{Mode, OFlags, open};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};

/// What goes wrong, once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Fault {
    None,
    /// The first line comes before the board has started.
    Starting,
    /// The `ok` of the first motion's end is lost.
    LostOk,
    /// The first motion is received wrongly.
    Noise,
    /// The first motion stops the printer.
    Halt,
    /// The first motion makes the board start again.
    Restart,
    /// No position beyond X = 20 mm is reached.
    Clamp,
    /// Nothing is answered.
    Dead,
}

/// A printer, served by a thread until it is dropped.
pub(crate) struct Printer {
    pub(crate) device: String,
    executed: Arc<Mutex<Vec<String>>>,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
    /// Keeps the terminal alive while no program has it open.
    _terminal: OwnedFd,
}

impl Printer {
    /// A printer that is at this position (mm).
    pub(crate) fn start(position: [f64; 3], fault: Fault) -> Self {
        let controller = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
        grantpt(&controller).unwrap();
        unlockpt(&controller).unwrap();
        let device = ptsname(&controller, Vec::new()).unwrap().into_string().unwrap();
        let terminal = open(PathBuf::from(&device), OFlags::RDWR | OFlags::NOCTTY, Mode::empty()).unwrap();
        let (executed, stop) = (Arc::new(Mutex::new(Vec::new())), Arc::new(AtomicBool::new(false)));
        let mut board = Board { controller, executed: Arc::clone(&executed), position, fault, last: 0 };
        let stopped = Arc::clone(&stop);
        let thread = std::thread::spawn(move || board.serve(&stopped));
        Self { device, executed, stop, thread: Some(thread), _terminal: terminal }
    }

    /// The lines that were executed, without their numbers.
    pub(crate) fn executed(&self) -> Vec<String> {
        self.executed.lock().unwrap().clone()
    }
}

impl Drop for Printer {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        self.thread.take().unwrap().join().unwrap();
    }
}

struct Board {
    controller: OwnedFd,
    executed: Arc<Mutex<Vec<String>>>,
    position: [f64; 3],
    fault: Fault,
    /// Number of the last line.
    last: u32,
}

impl Board {
    fn serve(&mut self, stop: &AtomicBool) {
        let mut received = Vec::new();
        while !stop.load(Ordering::Relaxed) {
            let wait = Timespec { tv_sec: 0, tv_nsec: 20_000_000 };
            if poll(&mut [PollFd::new(&self.controller, PollFlags::IN)], Some(&wait)).unwrap() == 0 {
                continue;
            }
            let mut bytes = [0; 256];
            let count = rustix::io::read(&self.controller, &mut bytes).unwrap();
            received.extend(&bytes[..count]);
            while let Some(end) = received.iter().position(|byte| *byte == b'\n') {
                let line = String::from_utf8(received.drain(..=end).collect()).unwrap();
                let answer = self.answer(line.trim());
                assert_eq!(rustix::io::write(&self.controller, answer.as_bytes()).unwrap(), answer.len());
            }
        }
    }

    fn happens(&mut self, fault: Fault) -> bool {
        let happens = self.fault == fault;
        if happens {
            self.fault = Fault::None;
        }
        happens
    }

    fn answer(&mut self, line: &str) -> String {
        if self.fault == Fault::Dead {
            return String::new();
        }
        if self.happens(Fault::Starting) {
            return "start\necho:Marlin 2.1\n".to_owned();
        }
        let (text, sum) = line.split_once('*').unwrap();
        assert_eq!(sum.parse(), Ok(text.bytes().fold(0, |sum, byte| sum ^ byte)), "{line}");
        let (number, code) = text.strip_prefix('N').unwrap().split_once(' ').unwrap();
        let number: u32 = number.parse().unwrap();
        let is_motion = code.starts_with("G1 ");
        let again = |reason: &str, last: u32| format!("Error:{reason}, Last Line: {last}\nResend: {}\nok\n", last + 1);
        if is_motion && self.happens(Fault::Noise) {
            return again("checksum mismatch", self.last);
        }
        if code.starts_with("M110") {
            self.last = number;
            return "ok\n".to_owned();
        }
        if number != self.last + 1 {
            return again("Line Number is not Last Line Number+1", self.last);
        }
        if is_motion && self.happens(Fault::Halt) {
            return "Error:Printer halted. kill() called!\n".to_owned();
        }
        if is_motion && self.happens(Fault::Restart) {
            return "start\necho:Marlin 2.1\n".to_owned();
        }
        self.last = number;
        self.executed.lock().unwrap().push(code.to_owned());
        if is_motion {
            for word in code.split_whitespace() {
                if let Some(axis) = "XYZ".find(&word[..1]) {
                    self.position[axis] = word[1..].parse().unwrap();
                }
            }
            if self.fault == Fault::Clamp {
                self.position[0] = self.position[0].min(20.0);
            }
        }
        match code {
            "M400" if self.happens(Fault::LostOk) => String::new(),
            "M400" => "echo:busy: processing\nok\n".to_owned(),
            "M114" => {
                let [x, y, z] = self.position;
                format!("X:{x:.2} Y:{y:.2} Z:{z:.2} E:0.00 Count X:0 Y:0 Z:0\nok\n")
            }
            _ => "ok\n".to_owned(),
        }
    }
}
