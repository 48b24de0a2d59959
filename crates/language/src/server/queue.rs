//! Messages that were received and not yet answered.

use std::collections::VecDeque;
use std::io::{self, BufRead};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::thread::Builder;
use std::time::Duration;

use gen_lsp_types::json_rpc::{Id, RequestObject};
use gen_lsp_types::{LspErrorCodes, LspNotificationMethod as Method};
use serde_json::Value;

use super::transport::{self, Incoming, error};

/// The maximum number of messages that are read ahead. An editor that sends more must wait.
const READ_AHEAD: usize = 1024;

/// Messages in the order of their arrival. A thread reads them while others are answered.
pub(super) struct Queue {
    read: Receiver<io::Result<Incoming>>,
    waiting: VecDeque<io::Result<Incoming>>,
}

impl Queue {
    /// The messages of `input`.
    ///
    /// # Errors
    /// The system does not start a thread.
    pub(super) fn read_from(mut input: impl BufRead + Send + 'static) -> io::Result<Self> {
        let (sender, read) = sync_channel(READ_AHEAD);
        // The thread is never joined, because it may be blocked in a read when the server ends.
        Builder::new().spawn(move || {
            loop {
                let message = transport::read(&mut input);
                let is_last = matches!(message, Ok(Incoming::End) | Err(_));
                if sender.send(message).is_err() || is_last {
                    break;
                }
            }
        })?;
        Ok(Self { read, waiting: VecDeque::new() })
    }

    /// The next message. `None` if none arrives within `patience`.
    pub(super) fn next(&mut self, patience: Option<Duration>) -> Option<io::Result<Incoming>> {
        while self.waiting.len() < READ_AHEAD
            && let Ok(message) = self.read.try_recv()
        {
            self.add(message);
        }
        if let Some(message) = self.waiting.pop_front() {
            return Some(message);
        }
        let message = match patience {
            Some(patience) => self.read.recv_timeout(patience),
            None => self.read.recv().map_err(RecvTimeoutError::from),
        };
        match message {
            Ok(message) => Some(message),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => Some(Ok(Incoming::End)),
        }
    }

    /// Adds a message. A cancellation refuses the request that it names, if this request still waits.
    fn add(&mut self, message: io::Result<Incoming>) {
        let cancelled = match &message {
            Ok(Incoming::Message(message)) => cancelled(message),
            _ => None,
        };
        let refused = cancelled.and_then(|cancelled| {
            let is_meant = |waiting: &&mut io::Result<Incoming>| match waiting {
                Ok(Incoming::Message(request)) => request.id() == Some(&cancelled),
                _ => false,
            };
            self.waiting.iter_mut().find(is_meant).map(|request| (request, cancelled.clone()))
        });
        match refused {
            Some((request, id)) => {
                let refusal = error(LspErrorCodes::RequestCancelled, "the editor cancelled the request");
                *request = Ok(Incoming::Faulty(id, refusal));
            }
            None => self.waiting.push_back(message),
        }
    }
}

/// The request that a message cancels, if it is a cancellation.
fn cancelled(message: &RequestObject) -> Option<Id> {
    let is_cancellation = Method::from(message.method()) == Method::CancelRequest;
    let id = message.params().filter(|_| is_cancellation).and_then(|parameters: &Value| parameters.get("id"));
    id.and_then(|id| serde_json::from_value(id.clone()).ok())
}
