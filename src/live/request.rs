//! Requests of browsers and viewers: what they ask for, and whether they may have it.

use std::net::{IpAddr, SocketAddr};

use super::token::Token;

/// The longest head of a request (bytes).
pub(super) const HEAD_LIMIT: usize = 16 << 10;
/// The largest number of headers.
const HEADER_LIMIT: usize = 64;

/// A request that may be answered.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Request {
    /// The page.
    Page,
    /// A WebSocket.
    Socket {
        /// The key of its handshake.
        key: String,
        /// The protocols that the viewer speaks, the best one first.
        protocols: Vec<String>,
    },
}

/// A request that is refused: the status, and what to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Refused(pub(super) &'static str, pub(super) &'static str);

const BAD: Refused = Refused("400 Bad Request", "this is no request for a page or a WebSocket");
const NO_PAGE: Refused = Refused("404 Not Found", "the page is at / and its stream at /live");
const NO_TOKEN: Refused = Refused("401 Unauthorized", "open the URL that the program has printed; it contains a token");
const OTHER_HOST: Refused =
    Refused("403 Forbidden", "the name of the host is not that of the printed URL; open the printed URL");
const OTHER_ORIGIN: Refused = Refused("403 Forbidden", "another site asks for the stream; open the printed URL itself");

/// What requests have to fulfil.
#[derive(Debug, Clone)]
pub(super) struct Access {
    /// The address at which the server listens.
    pub(super) address: SocketAddr,
    /// The token, if one is needed.
    pub(super) token: Option<Token>,
}

impl Access {
    /// Reads the head of a request.
    ///
    /// # Errors
    /// [`Refused`] with the answer.
    pub(super) fn check(&self, head: &[u8]) -> Result<Request, Refused> {
        let mut headers = [httparse::EMPTY_HEADER; HEADER_LIMIT];
        let mut request = httparse::Request::new(&mut headers);
        let path = self.admit(&mut request, head)?;
        let header = |name: &str| header(&request, name);
        match path {
            "/" => Ok(Request::Page),
            "/live" => {
                let key = header("sec-websocket-key").filter(|_| {
                    header("upgrade").is_some_and(|upgrade| upgrade.eq_ignore_ascii_case("websocket"))
                        && header("sec-websocket-version") == Some("13")
                });
                let key = key.ok_or(BAD)?;
                // Other programs than browsers send no origin. With a token, also a viewer from another site may ask.
                let is_own = |origin: &str| origin.split_once("://").is_some_and(|(_, host)| self.is_own(host));
                if self.token.is_none() && header("origin").is_some_and(|origin| !is_own(origin)) {
                    return Err(OTHER_ORIGIN);
                }
                let protocols = header("sec-websocket-protocol").unwrap_or_default().split(',');
                let protocols = protocols.map(|protocol| protocol.trim().to_owned()).collect();
                Ok(Request::Socket { key: key.to_owned(), protocols })
            }
            _ => Err(NO_PAGE),
        }
    }

    /// The path that the head of a request asks for.
    ///
    /// # Errors
    /// [`Refused`] with the answer.
    pub(super) fn path(&self, head: &[u8]) -> Result<String, Refused> {
        let mut headers = [httparse::EMPTY_HEADER; HEADER_LIMIT];
        self.admit(&mut httparse::Request::new(&mut headers), head).map(str::to_owned)
    }

    /// Reads the head of a request into `request`. The result is its path, if the request may be answered.
    fn admit<'h>(&self, request: &mut httparse::Request<'_, 'h>, head: &'h [u8]) -> Result<&'h str, Refused> {
        let Ok(httparse::Status::Complete(_)) = request.parse(head) else { return Err(BAD) };
        let (Some("GET"), Some(target)) = (request.method, request.path) else { return Err(BAD) };
        // A page of another site whose name was made to lead here has that name in `Host`.
        if !header(request, "host").is_some_and(|host| self.is_own(host)) {
            return Err(OTHER_HOST);
        }
        let (path, query) = target.split_once('?').unwrap_or((target, ""));
        if let Some(token) = &self.token {
            let given = query.split('&').find_map(|pair| pair.strip_prefix("token="));
            if !given.is_some_and(|given| token.is(given)) {
                return Err(NO_TOKEN);
            }
        }
        Ok(path)
    }

    /// True if a host and its port name this server: by an IP address, or by `localhost` if only this machine is served.
    fn is_own(&self, host: &str) -> bool {
        let (name, port) = match host.rsplit_once(':') {
            Some((name, port)) if !port.ends_with(']') => {
                // Only as browsers write it: a sign and leading zeros would be parsed too.
                (name, port.parse().ok().filter(|number: &u16| number.to_string() == port))
            }
            _ => (host, Some(80)),
        };
        let address = name.trim_start_matches('[').trim_end_matches(']').parse::<IpAddr>();
        let is_own_name = match address {
            Ok(address) if self.address.ip().is_unspecified() => !address.is_unspecified(),
            Ok(address) => address == self.address.ip(),
            Err(_) => name.eq_ignore_ascii_case("localhost") && self.address.ip().is_loopback(),
        };
        // Behind the tunnel of a token, names of other machines are allowed.
        port == Some(self.address.port()) && (is_own_name || (self.token.is_some() && address.is_err()))
    }
}

/// The first header of a request with a name.
fn header<'h>(request: &httparse::Request<'_, 'h>, name: &str) -> Option<&'h str> {
    let mut found = request.headers.iter().filter(|header| header.name.eq_ignore_ascii_case(name));
    found.next().and_then(|header| std::str::from_utf8(header.value).ok()).map(str::trim)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;

    fn access(address: &str, token: Option<&str>) -> Access {
        Access { address: address.parse().unwrap(), token: token.map(|token| Token::given(token).unwrap()) }
    }

    fn head(target: &str, host: &str, more: &str) -> String {
        format!("GET {target} HTTP/1.1\r\nHost: {host}\r\n{more}\r\n")
    }

    const UPGRADE: &str = "Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: a2V5\r\n";

    #[test]
    fn a_page_is_served_only_under_the_names_of_this_machine() {
        let access = access("127.0.0.1:8080", None);
        let status = |host: &str| access.check(head("/", host, "").as_bytes());
        assert_eq!(status("127.0.0.1:8080"), Ok(Request::Page));
        assert_eq!(status("localhost:8080"), Ok(Request::Page));
        for host in
            ["evil.example:8080", "127.0.0.1:81", "127.0.0.1", "10.0.0.1:8080", "", "localhost.evil.example:8080"]
        {
            assert_eq!(status(host), Err(OTHER_HOST), "{host}");
        }
        for port in
            ["+8080", "-8080", "08080", "0008080", "8080 ", " 8080", "80 80", "0x1f90", "８080", "8080.", "73616", ""]
        {
            let host = format!("127.0.0.1:{port}");
            // White space around a header is not a part of it.
            let due = if host.trim() == "127.0.0.1:8080" { Ok(Request::Page) } else { Err(OTHER_HOST) };
            assert_eq!(status(&host), due, "{host}");
        }
        assert_eq!(access.check(b"GET / HTTP/1.1\r\n\r\n"), Err(OTHER_HOST));
    }

    #[test]
    fn a_token_is_needed_where_there_is_one() {
        let access = access("0.0.0.0:8080", Some("t1-0123456789abc"));
        let status = |target| access.check(head(target, "192.168.1.2:8080", "").as_bytes());
        assert_eq!(status("/?token=t1-0123456789abc"), Ok(Request::Page));
        assert_eq!(status("/?x=1&token=t1-0123456789abc"), Ok(Request::Page));
        for target in ["/", "/?token=", "/?token=t2-0123456789abc", "/?token=t1-0123456789abcd", "/live"] {
            assert_eq!(status(target), Err(NO_TOKEN), "{target}");
        }
        assert_eq!(status("/other?token=t1-0123456789abc"), Err(NO_PAGE));
    }

    #[test]
    fn a_stream_is_refused_to_pages_of_other_sites() {
        let access = access("127.0.0.1:8080", None);
        let check = |origin: &str| {
            let more = format!("{UPGRADE}{origin}Sec-WebSocket-Protocol: a, b\r\n");
            access.check(head("/live", "127.0.0.1:8080", &more).as_bytes())
        };
        let socket = Ok(Request::Socket { key: "a2V5".to_owned(), protocols: vec!["a".to_owned(), "b".to_owned()] });
        assert_eq!(check(""), socket);
        assert_eq!(check("Origin: http://127.0.0.1:8080\r\n"), socket);
        assert_eq!(check("Origin: http://evil.example\r\n"), Err(OTHER_ORIGIN));
        assert_eq!(check("Origin: null\r\n"), Err(OTHER_ORIGIN));
        assert_eq!(access.check(head("/live", "127.0.0.1:8080", "").as_bytes()), Err(BAD));
    }

    #[test]
    fn whatever_is_no_request_is_refused() {
        let access = access("127.0.0.1:8080", None);
        for head in [&b"\xff\xfe"[..], b"", b"POST / HTTP/1.1\r\n\r\n", b"GET /"] {
            assert_eq!(access.check(head), Err(BAD));
        }
    }
}
