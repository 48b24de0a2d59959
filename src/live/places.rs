//! The connections that are open.

use std::collections::VecDeque;
use std::io;
use std::net::{Shutdown, TcpStream};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The largest number of connections whose request has not arrived.
const WAITING: usize = 64;
/// The largest number of connections with a permitted request.
const VIEWERS: usize = 64;

/// The connections that are open. Those whose request has not arrived, which may come from anybody, do not count as permitted ones.
#[derive(Debug, Default)]
pub(super) struct Places {
    waiting: Mutex<Waiting>,
    viewers: AtomicUsize,
}

#[derive(Debug, Default)]
struct Waiting {
    /// The connections by their numbers, oldest first.
    connections: VecDeque<(u64, TcpStream)>,
    next: u64,
}

impl Places {
    /// Gives a new connection a place among those that wait, and returns its number. If there is no place, the connection that has
    /// waited longest is closed, because a browser sends its request at once.
    ///
    /// # Errors
    /// The system gives no second handle of the connection.
    pub(super) fn begin(&self, stream: &TcpStream) -> io::Result<u64> {
        let handle = stream.try_clone()?;
        let mut waiting = self.waiting();
        if waiting.connections.len() >= WAITING
            && let Some((_, oldest)) = waiting.connections.pop_front()
        {
            // It may be closed already.
            let _ = oldest.shutdown(Shutdown::Both);
        }
        let number = waiting.next;
        waiting.next += 1;
        waiting.connections.push_back((number, handle));
        Ok(number)
    }

    /// Frees the place of a connection that waited. Its request has arrived, or it has ended.
    pub(super) fn end(&self, number: u64) {
        self.waiting().connections.retain(|&(other, _)| other != number);
    }

    /// Gives a permitted connection a place. Without a free one the result is false.
    pub(super) fn admit(&self) -> bool {
        let take = |count: usize| (count < VIEWERS).then_some(count + 1);
        self.viewers.fetch_update(Ordering::AcqRel, Ordering::Acquire, take).is_ok()
    }

    /// Frees the place of a permitted connection.
    pub(super) fn leave(&self) {
        self.viewers.fetch_sub(1, Ordering::AcqRel);
    }

    fn waiting(&self) -> MutexGuard<'_, Waiting> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
