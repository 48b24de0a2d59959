//! A WebSocket whose viewer may be slow.

use std::io::ErrorKind;
use std::net::TcpStream;
use std::time::{Duration, Instant};

use tungstenite::protocol::WebSocket;
use tungstenite::{Bytes, Error, Message};

/// A thread waits this long for a message of its viewer, before it looks for news.
const LOOK: Duration = Duration::from_millis(5);
/// The largest number of batches that a viewer has not confirmed. A slow one then gets newer ticks, and not old ones from buffers of the
/// network.
const IN_FLIGHT: u64 = 2;

/// A WebSocket. Each batch is followed by a ping, and the viewer's pong confirms it.
pub(super) struct Socket {
    inner: WebSocket<TcpStream>,
    sent: u64,
    confirmed: u64,
}

impl Socket {
    /// A socket after its handshake.
    pub(super) fn new(inner: WebSocket<TcpStream>) -> Result<Self, Error> {
        inner.get_ref().set_read_timeout(Some(LOOK))?;
        Ok(Self { inner, sent: 0, confirmed: 0 })
    }

    /// The next message of the viewer. `None` if there is none for a short time.
    pub(super) fn receive(&mut self) -> Result<Option<Message>, Error> {
        let until = Instant::now() + LOOK;
        loop {
            match self.inner.read() {
                Ok(Message::Pong(number)) => {
                    let number = <[u8; 8]>::try_from(number.as_ref()).map(u64::from_be_bytes);
                    self.confirmed = self.confirmed.max(number.unwrap_or(0).min(self.sent));
                }
                Ok(Message::Ping(_) | Message::Frame(_)) => {}
                Ok(message @ (Message::Text(_) | Message::Binary(_))) => return Ok(Some(message)),
                Ok(Message::Close(_)) => return Err(Error::ConnectionClosed),
                Err(Error::Io(error)) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {
                    return Ok(None);
                }
                Err(error) => return Err(error),
            }
            if Instant::now() >= until {
                return Ok(None);
            }
        }
    }

    /// True if the viewer keeps pace, so that it may get another batch.
    pub(super) fn is_ready(&self) -> bool {
        self.sent < self.confirmed + IN_FLIGHT
    }

    /// Sends a message.
    pub(super) fn send(&mut self, message: Message) -> Result<(), Error> {
        self.inner.send(message)
    }

    /// Asks the viewer to confirm everything until now.
    pub(super) fn end_batch(&mut self) -> Result<(), Error> {
        self.sent += 1;
        self.inner.send(Message::Ping(Bytes::copy_from_slice(&self.sent.to_be_bytes())))
    }
}
