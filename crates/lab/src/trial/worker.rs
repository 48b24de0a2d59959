//! Worker processes. A crash ends only the run of its process.

use std::io::{self, BufRead, BufReader, Write};
use std::process::{Child, ChildStderr, ChildStdin, ChildStdout, Command, Stdio};
use std::thread::JoinHandle;
use vibrissa_text::system::in_words;

/// Number of the last lines on standard error that are reported as the reason of a crash.
const LAST_LINES: usize = 3;

/// Number of attempts at a request whose process ends. A temporary shortage of the machine may be over at the second
/// attempt.
const ATTEMPTS: usize = 2;

/// A process that answers every line on its standard input with a line on its standard output.
#[derive(Debug)]
pub struct Worker {
    child: Child,
    /// `None` when it has been closed.
    requests: Option<ChildStdin>,
    answers: BufReader<ChildStdout>,
    /// Collects the last lines of standard error.
    errors: Option<JoinHandle<Vec<String>>>,
}

/// The error of a worker that cannot begin.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// Its process cannot be started.
    #[error("a worker process cannot be started: {words}", words = in_words(.0))]
    Process(#[from] io::Error),
    /// Its process ended, for this reason.
    #[error("a worker process ended before its first run: {0}")]
    Ended(String),
    /// It would execute other runs.
    #[error(
        "the sweep, or a file that it names, has changed since it began; restore it, or choose another path with --out"
    )]
    Changed,
}

/// The answer of a worker to a request.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Answer {
    /// The line that it wrote.
    Line(String),
    /// Its process ended, and so did the next process, for this reason.
    Crash(String),
}

impl Worker {
    /// Starts `command`, whose first line must be the `greeting`.
    ///
    /// # Errors
    /// [`StartError`] if the process does not start, or writes another first line.
    pub fn start(command: &mut Command, greeting: &str) -> Result<Self, StartError> {
        let piped = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = piped.spawn()?;
        let missing = || io::Error::other("it has no standard streams");
        let requests = child.stdin.take();
        let answers = BufReader::new(child.stdout.take().ok_or_else(missing)?);
        let errors = child.stderr.take().ok_or_else(missing)?;
        let mut worker = Self { child, requests, answers, errors: None };
        worker.errors = Some(std::thread::Builder::new().spawn(move || last_lines(errors))?);
        match worker.line() {
            Ok(line) if line == greeting => Ok(worker),
            Ok(_) => Err(StartError::Changed),
            Err(_) => Err(StartError::Ended(worker.end())),
        }
    }

    fn ask(&mut self, request: &str) -> io::Result<String> {
        let requests = self.requests.as_mut().ok_or(io::ErrorKind::BrokenPipe)?;
        requests.write_all(format!("{request}\n").as_bytes())?;
        self.line()
    }

    fn line(&mut self) -> io::Result<String> {
        let mut line = String::new();
        self.answers.read_line(&mut line)?;
        // A line without an end is the last of a process that crashed while writing.
        line.strip_suffix('\n').map(str::to_owned).ok_or_else(|| io::ErrorKind::UnexpectedEof.into())
    }

    /// Waits for the process after the end of its output, and returns the reason of its end.
    fn end(&mut self) -> String {
        self.requests = None;
        let status = self.child.wait().map_or_else(|error| in_words(&error), |status| status.to_string());
        let errors = self.errors.take().and_then(|errors| errors.join().ok()).unwrap_or_default();
        if errors.is_empty() { status } else { format!("{status}: {}", errors.join(" | ")) }
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        // A worker ends when its input does.
        self.end();
    }
}

fn last_lines(errors: ChildStderr) -> Vec<String> {
    let mut last = Vec::new();
    let mut errors = BufReader::new(errors);
    let mut line = Vec::new();
    while errors.read_until(b'\n', &mut line).is_ok_and(|bytes| bytes > 0) {
        let text = String::from_utf8_lossy(&line).trim().chars().take(400).collect::<String>();
        line.clear();
        if !text.is_empty() {
            last.push(text);
        }
        if last.len() > LAST_LINES {
            last.remove(0);
        }
    }
    last
}

/// The answer of the worker in `slot` to a request. The slot gets a new worker if it has none or if its worker ends. A
/// request at which two workers end is given up.
///
/// # Errors
/// [`StartError`] if no other worker can be started.
pub fn answer(
    slot: &mut Option<Worker>,
    start: impl Fn() -> Result<Worker, StartError>,
    request: &str,
) -> Result<Answer, StartError> {
    let mut reason = String::new();
    for _ in 0..ATTEMPTS {
        let worker = match slot {
            Some(worker) => worker,
            None => slot.insert(start()?),
        };
        match worker.ask(request) {
            Ok(line) => return Ok(Answer::Line(line)),
            Err(_) => reason = slot.take().map_or(reason, |mut worker| worker.end()),
        }
    }
    Ok(Answer::Crash(format!("its process ended {ATTEMPTS} times, the last time with {reason}")))
}

#[cfg(all(test, unix))]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;

    /// A worker that doubles numbers. It ends at 13. It ends at 7 unless the file `mark` shows that it has done so
    /// before.
    fn start(mark: &str) -> Result<Worker, StartError> {
        let script = format!(
            "echo ready; while read n; do
               if [ $n = 13 ]; then echo out of luck >&2; kill -9 $$; fi
               if [ $n = 7 ] && [ ! -e {mark} ]; then touch {mark}; exit 5; fi
               echo $((2 * n))
             done"
        );
        Worker::start(Command::new("sh").args(["-c", &script]), "ready")
    }

    #[test]
    fn a_worker_that_ends_costs_its_request_alone_and_that_only_the_second_time() {
        let mark = std::env::temp_dir().join(format!("vibrissa-worker-{}", std::process::id()));
        let mark_text = mark.display().to_string();
        let mut slot = None;
        let mut ask = |request: &str| answer(&mut slot, || start(&mark_text), request).unwrap();
        let line = |text: &str| Answer::Line(text.to_owned());
        assert_eq!(ask("4"), line("8"));
        assert_eq!(ask("7"), line("14"));
        let Answer::Crash(reason) = ask("13") else { panic!("13 was answered") };
        assert!(reason.contains("SIGKILL") && reason.ends_with("out of luck"), "{reason}");
        assert_eq!(ask("21"), line("42"));
        std::fs::remove_file(mark).unwrap();
    }

    #[test]
    fn a_worker_that_greets_otherwise_or_not_at_all_is_not_used() {
        let start = |script: &str| Worker::start(Command::new("sh").args(["-c", script]), "ready");
        assert!(matches!(start("echo steady; cat"), Err(StartError::Changed)));
        let Err(StartError::Ended(reason)) = start("echo no such sweep >&2; exit 2") else { panic!("it has begun") };
        assert!(reason.contains('2') && reason.ends_with("no such sweep"), "{reason}");
        assert!(matches!(Worker::start(&mut Command::new("/no/such"), "ready"), Err(StartError::Process(_))));
    }
}
