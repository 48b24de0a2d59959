//! A program that takes bytes and gives a short answer, within a limited time.

use std::io::{self, Read};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// Kept bytes of each output stream, counted from its end.
const OUTPUT_LIMIT: usize = 16 << 10;
/// The time that the output has after the program ended. A background process of ssh may keep a stream open for longer.
const GRACE: Duration = Duration::from_secs(1);
const PAUSE: Duration = Duration::from_millis(5);

/// The result of a program that ended.
#[derive(Debug)]
pub(super) struct Ended {
    /// Its exit status.
    pub(super) status: ExitStatus,
    /// The end of its standard output.
    pub(super) output: String,
    /// The end of its standard error.
    pub(super) errors: String,
}

/// Runs a program with `input` on its standard input. Returns `None` if it did not end in time. Then it is killed.
pub(super) fn run(mut command: Command, input: Vec<u8>, timeout: Duration) -> io::Result<Option<Ended>> {
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn()?;
    if let Some(mut stdin) = child.stdin.take() {
        // A program that ends before it has read everything says why. So the error of writing is not needed.
        thread::spawn(move || io::Write::write_all(&mut stdin, &input));
    }
    let output = child.stdout.take().map(Tail::read);
    let errors = child.stderr.take().map(Tail::read);
    let Some(status) = wait(&mut child, timeout)? else { return Ok(None) };
    let text = |tail: Option<Tail>| tail.map(Tail::text).unwrap_or_default();
    Ok(Some(Ended { status, output: text(output), errors: text(errors) }))
}

fn wait(child: &mut Child, timeout: Duration) -> io::Result<Option<ExitStatus>> {
    let start = Instant::now();
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(Some(status));
        }
        if start.elapsed() >= timeout {
            child.kill()?;
            child.wait()?;
            return Ok(None);
        }
        thread::sleep(PAUSE);
    }
}

/// The end of a stream that a thread reads.
struct Tail {
    bytes: Arc<Mutex<Vec<u8>>>,
    /// Disconnected at the end of the stream.
    end: Receiver<()>,
}

impl Tail {
    fn read(mut from: impl Read + Send + 'static) -> Self {
        let bytes = Arc::new(Mutex::new(Vec::new()));
        let (open, end) = channel();
        let tail = Self { bytes: Arc::clone(&bytes), end };
        thread::spawn(move || {
            let _open = open;
            let mut chunk = [0; 4096];
            loop {
                let part = match from.read(&mut chunk) {
                    Ok(0) => break,
                    Ok(length) => chunk.get(..length).unwrap_or_default(),
                    Err(cause) if cause.kind() == io::ErrorKind::Interrupted => continue,
                    Err(_) => break,
                };
                let mut bytes = bytes.lock().unwrap_or_else(PoisonError::into_inner);
                bytes.extend_from_slice(part);
                let excess = bytes.len().saturating_sub(OUTPUT_LIMIT);
                bytes.drain(..excess);
            }
        });
        tail
    }

    fn text(self) -> String {
        match self.end.recv_timeout(GRACE) {
            Ok(()) | Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => {}
        }
        String::from_utf8_lossy(&self.bytes.lock().unwrap_or_else(PoisonError::into_inner)).into_owned()
    }
}
