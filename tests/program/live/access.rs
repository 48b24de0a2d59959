//! Who may open the page.

use super::session::{SCENE, Session};
use crate::command::program::{directory, stderr, vibrissa};

fn session(name: &str, words: &[&str]) -> Session {
    let folder = directory(name);
    std::fs::write(folder.join("scene.yaml"), SCENE).unwrap();
    Session::start(&folder, &[&["run", "scene.yaml", "--paused"], words].concat())
}

const UPGRADE: &str = "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: \
    dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: vibrissa.live.v1\r\n";

#[test]
fn the_page_is_one_file_that_may_load_nothing() {
    let session = session("live-page", &["--live"]);
    assert!(session.url.starts_with("http://127.0.0.1:"), "{}", session.url);
    let page = session.request("/", &format!("Host: {}\r\n", session.host()));
    let (head, body) = page.split_once("\r\n\r\n").unwrap();
    assert!(head.starts_with("HTTP/1.1 200 ") && head.contains("default-src 'none'"), "{head}");
    assert!(body.contains("<script>") && !body.contains("src=\"http") && body.len() < 500_000);
}

#[test]
fn another_host_and_another_origin_are_refused() {
    let session = session("live-host", &["--live"]);
    let port = session.host().rsplit_once(':').unwrap().1;
    let status = |target: &str, headers: &str| session.request(target, headers)[9..12].to_owned();
    let own = format!("Host: {}\r\n", session.host());
    assert_eq!(status("/", &format!("Host: localhost:{port}\r\n")), "200");
    assert_eq!(status("/", &format!("Host: rebound.example:{port}\r\n")), "403");
    for port in [format!("+{port}"), format!("-{port}"), String::new(), format!("0x{port}")] {
        assert_eq!(status("/", &format!("Host: 127.0.0.1:{port}\r\n")), "403", "{port}");
    }
    assert_eq!(status("/", ""), "403");
    assert_eq!(status("/live", &format!("{own}{UPGRADE}Origin: http://site.example\r\n")), "403");
    assert_eq!(status("/live", &own), "400");
    assert_eq!(status("/other", &own), "404");
}

#[test]
fn other_machines_need_the_token() {
    let file = directory("live-token-file").join("token");
    std::fs::write(&file, "abcdefgh-ijkl-123\n").unwrap();
    let session = session("live-token", &["--live", "0.0.0.0:0", "--live-token-file", &file.display().to_string()]);
    assert!(session.url.ends_with("/?token=abcdefgh-ijkl-123"), "{}", session.url);
    let port = session.host().rsplit_once(':').unwrap().1.to_owned();
    let host = format!("Host: 127.0.0.1:{port}\r\n");
    let status = |target: &str, headers: &str| {
        let answer = session.request(target, headers);
        answer[9..12].to_owned()
    };
    assert_eq!(status("/", &host), "401");
    assert_eq!(status("/?token=abcdefgh-ijkl-124", &host), "401");
    assert_eq!(status("/live", &format!("{host}{UPGRADE}")), "401");
    assert_eq!(status("/?token=abcdefgh-ijkl-123", &host), "200");
}

#[test]
fn a_token_that_cannot_be_in_a_url_and_a_text_that_is_no_address_are_refused() {
    let folder = directory("live-refused");
    let token = |text: &str| {
        let path = folder.join(text.len().to_string());
        std::fs::write(&path, text).unwrap();
        path.display().to_string()
    };
    let (short, spaced) = (token("abcdefgh-123456"), token("abcdefgh 1234567"));
    for (words, message) in [
        (&["--live", "--live-token-file", &short][..], "at least 16 letters, digits"),
        (&["--live", "--live-token-file", &spaced][..], "at least 16 letters, digits"),
        (&["--live", "--live-token-file", "nowhere/token"][..], "nowhere/token"),
        (&["--live=here"][..], "is no address"),
        (&["--live=192.0.2.1:1"][..], "cannot listen on 192.0.2.1:1"),
    ] {
        let output = vibrissa(&[&["run", "scenarios/disk.yaml"], words].concat());
        assert_eq!(output.status.code(), Some(2), "{words:?}");
        assert!(stderr(&output).contains(message), "{}", stderr(&output));
    }
}

/// Connections that never send a request come from anybody. They must not keep out who may see the page.
#[test]
fn idle_connections_keep_nobody_out() {
    let session = session("live-idle", &["--live"]);
    let idle: Vec<_> = (0..100)
        .map(|_| {
            let mut stream = std::net::TcpStream::connect(session.host()).unwrap();
            std::io::Write::write_all(&mut stream, b"G").unwrap();
            stream
        })
        .collect();
    let page = session.request("/", &format!("Host: {}\r\n", session.host()));
    assert!(page.starts_with("HTTP/1.1 200 "), "{}", page.lines().next().unwrap_or_default());
    drop(idle);
}
