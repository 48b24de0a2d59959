//! The server: one thread that accepts connections, and one for each connection.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

use tungstenite::handshake::derive_accept_key;
use tungstenite::protocol::{Role, WebSocket, WebSocketConfig};

use super::client::serve_page;
use super::error::LiveError;
use super::foxglove::{PROTOCOLS, serve_viewer};
use super::hub::Hub;
use super::page::{POLICY, page};
use super::places::Places;
use super::request::{Access, HEAD_LIMIT, Refused, Request};
use vibrissa_lab::stream::message::PROTOCOL;

/// The head of a request has to arrive as a whole within this time.
const REQUEST_TIMEOUT: Duration = Duration::from_secs(5);
/// The longest message of a page (bytes).
const MESSAGE_LIMIT: usize = 1 << 20;

/// Begins to serve the page of runs. The result is the address with its port.
pub(super) fn serve(
    address: SocketAddr,
    access: impl FnOnce(SocketAddr) -> Access,
    hub: &Arc<Hub>,
) -> Result<SocketAddr, LiveError> {
    let hub = Arc::clone(hub);
    serve_by(address, access, Access::check, move |stream, request| answer(stream, request, &hub))
}

/// Begins to serve connections. `check` reads the head of a request, and `answer` answers one that is permitted. The result is the
/// address with its port.
pub(super) fn serve_by<R: 'static>(
    address: SocketAddr,
    access: impl FnOnce(SocketAddr) -> Access,
    check: fn(&Access, &[u8]) -> Result<R, Refused>,
    answer: impl Fn(TcpStream, R) -> std::io::Result<()> + Send + Sync + 'static,
) -> Result<SocketAddr, LiveError> {
    let listen = |cause| LiveError::Listen { address, cause };
    let listener = TcpListener::bind(address).map_err(listen)?;
    let bound = listener.local_addr().map_err(listen)?;
    let (access, answer) = (Arc::new(access(bound)), Arc::new(answer));
    let accept = move || {
        let places = Arc::new(Places::default());
        for stream in listener.incoming().flatten() {
            let Ok(number) = places.begin(&stream) else { continue };
            let (access, answer, held) = (Arc::clone(&access), Arc::clone(&answer), Arc::clone(&places));
            let connection = move || {
                // A connection that breaks ends its thread alone.
                let _ = connect(stream, (number, &held), |head| check(&access, head), &*answer);
                held.end(number);
            };
            if thread::Builder::new().name("live connection".to_owned()).spawn(connection).is_err() {
                places.end(number);
            }
        }
    };
    thread::Builder::new().name("live server".to_owned()).spawn(accept).map_err(LiveError::Thread)?;
    Ok(bound)
}

/// Answers one connection.
fn connect<R>(
    mut stream: TcpStream,
    (number, places): (u64, &Places),
    check: impl FnOnce(&[u8]) -> Result<R, Refused>,
    answer: impl FnOnce(TcpStream, R) -> std::io::Result<()>,
) -> std::io::Result<()> {
    stream.set_write_timeout(Some(REQUEST_TIMEOUT))?;
    let head = head(&mut stream, Instant::now() + REQUEST_TIMEOUT)?;
    stream.set_read_timeout(Some(REQUEST_TIMEOUT))?;
    let request = check(&head);
    places.end(number);
    match request {
        Err(refused) => refuse(stream, refused),
        Ok(_) if !places.admit() => {
            refuse(stream, Refused("503 Service Unavailable", "too many pages are open; close some of them"))
        }
        Ok(request) => {
            let answered = answer(stream, request);
            places.leave();
            answered
        }
    }
}

/// Answers a request that is permitted.
fn answer(mut stream: TcpStream, request: Request, hub: &Arc<Hub>) -> std::io::Result<()> {
    match request {
        Request::Page => {
            let page = page();
            let security =
                "Cache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\n";
            let head = format!(
                "HTTP/1.1 200 OK\r\nContent-Type: text/html; charset=utf-8\r\nContent-Length: {}\r\nContent-Security-Policy: {POLICY}\r\n\
                 {security}Connection: close\r\n\r\n",
                page.len()
            );
            stream.write_all(head.as_bytes())?;
            stream.write_all(page.as_bytes())
        }
        Request::Socket { key, protocols } => {
            let known = |protocol: &&String| *protocol == PROTOCOL || PROTOCOLS.contains(&protocol.as_str());
            let Some(protocol) = protocols.iter().find(known) else {
                let advice = "the stream speaks vibrissa.live.v1, foxglove.sdk.v1 and foxglove.websocket.v1; ask for one of them";
                return refuse(stream, Refused("400 Bad Request", advice));
            };
            let accepted = format!(
                "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: {}\r\n\
                 Sec-WebSocket-Protocol: {protocol}\r\n\r\n",
                derive_accept_key(key.as_bytes())
            );
            stream.write_all(accepted.as_bytes())?;
            stream.set_nodelay(true)?;
            // A viewer may be stalled for any time. Its thread waits, and nothing else does.
            stream.set_write_timeout(None)?;
            let config =
                WebSocketConfig::default().max_message_size(Some(MESSAGE_LIMIT)).max_frame_size(Some(MESSAGE_LIMIT));
            let socket = WebSocket::from_raw_socket(stream, Role::Server, Some(config));
            // Its errors are those of a connection that ends.
            let _ = if protocol == PROTOCOL { serve_page(socket, hub) } else { serve_viewer(socket, hub) };
            Ok(())
        }
    }
}

/// Reads the head of a request. It may be cut off at the limit, and is then refused. One deadline holds for the whole head, so that
/// single bytes do not prolong it.
fn head(stream: &mut TcpStream, deadline: Instant) -> std::io::Result<Vec<u8>> {
    let (mut head, mut part) = (Vec::new(), [0; 2048]);
    while !head.windows(4).any(|end| end == b"\r\n\r\n") && head.len() < HEAD_LIMIT {
        let left = deadline.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(std::io::ErrorKind::TimedOut.into());
        }
        stream.set_read_timeout(Some(left))?;
        let count = stream.read(&mut part)?;
        if count == 0 {
            break;
        }
        head.extend_from_slice(part.get(..count).unwrap_or_default());
    }
    Ok(head)
}

/// Answers a request that is refused.
pub(super) fn refuse(mut stream: TcpStream, Refused(status, advice): Refused) -> std::io::Result<()> {
    let length = advice.len() + 1;
    let answer = format!(
        "HTTP/1.1 {status}\r\nContent-Type: text/plain; charset=utf-8\r\nContent-Length: {length}\r\nConnection: close\r\n\r\n{advice}\n"
    );
    stream.write_all(answer.as_bytes())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;

    #[test]
    fn single_bytes_do_not_prolong_the_deadline_of_a_head() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let mut sender = TcpStream::connect(listener.local_addr().unwrap()).unwrap();
        let (mut stream, _) = listener.accept().unwrap();
        // It ends when the other side is closed.
        let sending = thread::spawn(move || {
            while sender.write_all(b"G").is_ok() {
                thread::sleep(Duration::from_millis(20));
            }
        });
        let deadline = Instant::now() + Duration::from_millis(200);
        assert!(head(&mut stream, deadline).is_err());
        assert!(Instant::now() >= deadline);
        drop(stream);
        sending.join().unwrap();
    }
}
