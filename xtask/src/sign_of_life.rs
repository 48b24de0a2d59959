//! Lines that tell from time to time that something is still being done.

use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// Time between two lines.
const INTERVAL: Duration = Duration::from_secs(15);

/// Tells until it is dropped.
pub(crate) struct SignOfLife {
    done: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl SignOfLife {
    /// Prints to standard error how long `what` has taken, four times a minute.
    pub(crate) fn of(what: &'static str) -> Self {
        Self::every(INTERVAL, move |elapsed| eprintln!("{}", line(what, elapsed)))
    }

    fn every(interval: Duration, tell: impl Fn(Duration) + Send + 'static) -> Self {
        let (done, is_done) = channel();
        let start = Instant::now();
        let thread = thread::spawn(move || {
            while is_done.recv_timeout(interval) == Err(RecvTimeoutError::Timeout) {
                tell(start.elapsed());
            }
        });
        Self { done: Some(done), thread: Some(thread) }
    }
}

impl Drop for SignOfLife {
    fn drop(&mut self) {
        drop(self.done.take());
        // A thread that panicked has told so.
        let _ = self.thread.take().map(JoinHandle::join);
    }
}

fn line(what: &str, elapsed: Duration) -> String {
    let seconds = elapsed.as_secs();
    format!("      {what}: {} min {:02} s so far", seconds / 60, seconds % 60)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc::channel;

    #[test]
    fn it_tells_again_and_again_and_no_more_when_it_is_dropped() {
        let (told, hear) = channel();
        let sign = SignOfLife::every(Duration::from_millis(1), move |elapsed| {
            let _ = told.send(elapsed);
        });
        assert!(hear.recv().is_ok() && hear.recv().is_ok());
        drop(sign);
        // The sender went with the thread.
        let _before = hear.try_iter().count();
        assert!(hear.recv().is_err());
    }

    #[test]
    fn a_line_has_minutes_and_seconds() {
        assert_eq!(line("building", Duration::from_secs(125)), "      building: 2 min 05 s so far");
    }
}
