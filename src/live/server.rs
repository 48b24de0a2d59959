//! The server: one thread that accepts connections, and one for each connection.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

use tungstenite::handshake::derive_accept_key;
use tungstenite::protocol::{Role, WebSocket, WebSocketConfig};

use super::client::serve_page;
use super::error::LiveError;
use super::foxglove::{PROTOCOLS, serve_viewer};
use super::hub::Hub;
use super::message::PROTOCOL;
use super::page::{POLICY, page};
use super::request::{Access, HEAD_LIMIT, Refused, Request};

/// The largest number of connections at a time.
const CONNECTIONS: usize = 64;
/// A request has to arrive within this time.
const REQUEST_TIMEOUT: Duration = Duration::from_secs(5);
/// The longest message of a page (bytes).
const MESSAGE_LIMIT: usize = 1 << 20;

/// Begins to serve connections. The result is the address with its port.
pub(super) fn serve(
    address: SocketAddr,
    access: impl FnOnce(SocketAddr) -> Access,
    hub: &Arc<Hub>,
) -> Result<SocketAddr, LiveError> {
    let listen = |cause| LiveError::Listen { address, cause };
    let listener = TcpListener::bind(address).map_err(listen)?;
    let bound = listener.local_addr().map_err(listen)?;
    let (access, hub) = (Arc::new(access(bound)), Arc::clone(hub));
    let accept = move || {
        let open = Arc::new(AtomicUsize::new(0));
        for stream in listener.incoming().flatten() {
            let (access, hub, counted) = (Arc::clone(&access), Arc::clone(&hub), Arc::clone(&open));
            if open.fetch_add(1, Ordering::AcqRel) >= CONNECTIONS {
                open.fetch_sub(1, Ordering::AcqRel);
                let busy = Refused("503 Service Unavailable", "too many pages are open; close some of them");
                let _ = refuse(stream, busy);
                continue;
            }
            let connection = move || {
                // A connection that breaks ends its thread alone.
                let _ = connect(stream, &access, &hub);
                counted.fetch_sub(1, Ordering::AcqRel);
            };
            if thread::Builder::new().name("live connection".to_owned()).spawn(connection).is_err() {
                open.fetch_sub(1, Ordering::AcqRel);
            }
        }
    };
    thread::Builder::new().name("live server".to_owned()).spawn(accept).map_err(LiveError::Thread)?;
    Ok(bound)
}

/// Answers one connection.
fn connect(mut stream: TcpStream, access: &Access, hub: &Arc<Hub>) -> std::io::Result<()> {
    stream.set_read_timeout(Some(REQUEST_TIMEOUT))?;
    stream.set_write_timeout(Some(REQUEST_TIMEOUT))?;
    let head = head(&mut stream)?;
    match access.check(&head) {
        Err(refused) => refuse(stream, refused),
        Ok(Request::Page) => {
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
        Ok(Request::Socket { key, protocols }) => {
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

/// Reads the head of a request. It may be cut off at the limit, and is then refused.
fn head(stream: &mut TcpStream) -> std::io::Result<Vec<u8>> {
    let (mut head, mut part) = (Vec::new(), [0; 2048]);
    while !head.windows(4).any(|end| end == b"\r\n\r\n") && head.len() < HEAD_LIMIT {
        let count = stream.read(&mut part)?;
        if count == 0 {
            break;
        }
        head.extend_from_slice(part.get(..count).unwrap_or_default());
    }
    Ok(head)
}

/// Answers a request that is refused.
fn refuse(mut stream: TcpStream, Refused(status, advice): Refused) -> std::io::Result<()> {
    let length = advice.len() + 1;
    let answer = format!(
        "HTTP/1.1 {status}\r\nContent-Type: text/plain; charset=utf-8\r\nContent-Length: {length}\r\nConnection: close\r\n\r\n{advice}\n"
    );
    stream.write_all(answer.as_bytes())
}
