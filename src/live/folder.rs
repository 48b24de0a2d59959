//! The server of a folder of static files.

use std::collections::BTreeMap;
use std::io::Write;
use std::net::{Ipv4Addr, SocketAddr, TcpStream};

use super::error::LiveError;
use super::request::{Access, Refused};
use super::server::{refuse, serve_by};

/// The types of files by the ends of their names.
const TYPES: [(&str, &str); 4] = [
    (".html", "text/html; charset=utf-8"),
    (".js", "text/javascript; charset=utf-8"),
    (".css", "text/css; charset=utf-8"),
    (".wasm", "application/wasm"),
];
const NO_FILE: Refused = Refused("404 Not Found", "there is no such file; open the URL that the program has printed");

/// Begins to serve files by their names to this machine alone, at `port`. The port 0 stands for a free one. `/` is `index.html`. The
/// result is the URL.
///
/// # Errors
/// [`LiveError`] if the port cannot be used.
pub fn serve_folder(files: BTreeMap<String, Vec<u8>>, port: u16) -> Result<String, LiveError> {
    let address = SocketAddr::from((Ipv4Addr::LOCALHOST, port));
    let answer = move |stream: TcpStream, path: String| {
        let name = path.strip_prefix('/').unwrap_or_default();
        let name = if name.is_empty() { "index.html" } else { name };
        match files.get(name) {
            Some(content) => send(stream, name, content),
            None => refuse(stream, NO_FILE),
        }
    };
    let bound = serve_by(address, |address| Access { address, token: None }, Access::path, answer)?;
    Ok(format!("http://{bound}/"))
}

fn send(mut stream: TcpStream, name: &str, content: &[u8]) -> std::io::Result<()> {
    let kind = TYPES.iter().find(|(end, _)| name.ends_with(end)).map_or("application/octet-stream", |(_, kind)| kind);
    let head = format!(
        "HTTP/1.1 200 OK\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nCache-Control: no-cache\r\n\
         X-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\nConnection: close\r\n\r\n",
        content.len()
    );
    stream.write_all(head.as_bytes())?;
    stream.write_all(content)
}
