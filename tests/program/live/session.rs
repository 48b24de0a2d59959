//! A program with a live page, and connections to it.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::Duration;

use serde_json::Value;
use tungstenite::client::IntoClientRequest;
use tungstenite::protocol::WebSocket;
use tungstenite::{Message, client};

pub(super) const SCENE: &str = "name: scene\nworld: quasistatic\nobjects: [{circle: {centre: [40 cm, 40 cm], radius: 30 cm}}]\n\
    start: {position: [0 mm, 72 mm], heading: 90 deg}\nstop: {time: 25 s}\nrig: {sensing: {angle_noise: 0.5 urad}}\n";

/// A program that is ended with the test.
pub(super) struct Session {
    child: Child,
    /// What it prints to its standard output and to its standard error.
    out: Receiver<String>,
    told: Receiver<String>,
    /// The URL of the page.
    pub(super) url: String,
}

impl Session {
    /// Starts the program in a folder and reads the URL that it prints.
    pub(super) fn start(folder: &Path, words: &[&str]) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_vibrissa"));
        command.args(words).current_dir(folder).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let (out, told) = (lines(child.stdout.take().unwrap()), lines(child.stderr.take().unwrap()));
        let mut session = Self { child, out, told, url: String::new() };
        let line = session.until("live page: ");
        line.split_once("live page: ").unwrap().1.clone_into(&mut session.url);
        session
    }

    /// Reads the messages of the program until a line has `text` in it.
    pub(super) fn until(&self, text: &str) -> String {
        loop {
            let line = self.told.recv().unwrap_or_else(|_| panic!("the program ended before it printed {text:?}"));
            if line.contains(text) {
                return line;
            }
        }
    }

    /// Reads the JSON that the program prints at the end of its run.
    pub(super) fn json(&self) -> Value {
        let mut text = String::new();
        loop {
            text += &self.out.recv().unwrap();
            if let Ok(value) = serde_json::from_str(&text) {
                return value;
            }
        }
    }

    /// Host and port of the page.
    pub(super) fn host(&self) -> &str {
        self.url.strip_prefix("http://").unwrap().split_once('/').unwrap().0
    }

    /// The answer to a plain request for `target` with these headers.
    pub(super) fn request(&self, target: &str, headers: &str) -> String {
        let mut stream = TcpStream::connect(self.host()).unwrap();
        write!(stream, "GET {target} HTTP/1.1\r\n{headers}\r\n").unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        answer
    }

    /// A connection to the stream.
    pub(super) fn connect(&self, protocol: &str) -> Viewer {
        let query = self.url.split_once('?').map_or(String::new(), |(_, query)| format!("?{query}"));
        let mut request = format!("ws://{}/live{query}", self.host()).into_client_request().unwrap();
        request.headers_mut().insert("Sec-WebSocket-Protocol", protocol.parse().unwrap());
        let stream = TcpStream::connect(self.host()).unwrap();
        // A test that waits for a message that never comes fails, and does not hang.
        stream.set_read_timeout(Some(Duration::from_mins(5))).unwrap();
        let (socket, answer) = client(request, stream).unwrap();
        assert_eq!(answer.headers()["Sec-WebSocket-Protocol"], protocol);
        Viewer { socket }
    }

    /// A connection as the page has it, with its first message.
    pub(super) fn page(&self) -> (Viewer, Value) {
        let mut viewer = self.connect("vibrissa.live.v1");
        let hello = viewer.next();
        assert_eq!(hello["type"], "hello", "{hello}");
        (viewer, hello)
    }
}

/// The lines of a stream.
fn lines(stream: impl Read + Send + 'static) -> Receiver<String> {
    let (sender, lines) = channel();
    thread::spawn(move || BufReader::new(stream).lines().try_for_each(|line| sender.send(line.unwrap())));
    lines
}

impl Drop for Session {
    fn drop(&mut self) {
        self.child.kill().unwrap();
        self.child.wait().unwrap();
    }
}

/// A connection.
pub(super) struct Viewer {
    pub(super) socket: WebSocket<TcpStream>,
}

impl Viewer {
    /// The next message with content.
    pub(super) fn receive(&mut self) -> Message {
        loop {
            match self.socket.read().unwrap() {
                Message::Ping(_) | Message::Pong(_) => self.socket.flush().unwrap(),
                message => return message,
            }
        }
    }

    /// The next message of the page's protocol.
    pub(super) fn next(&mut self) -> Value {
        serde_json::from_str(self.receive().to_text().unwrap()).unwrap()
    }

    pub(super) fn send(&mut self, message: &Value) {
        self.socket.send(Message::text(message.to_string())).unwrap();
    }

    /// Reads on until a message is of interest. The result is that message, and all ticks until then.
    pub(super) fn until(&mut self, is_wanted: impl Fn(&Value) -> bool) -> (Value, Ticks) {
        let mut ticks = Ticks::default();
        loop {
            let message = self.next();
            if message["type"] == "ticks" {
                ticks.lost += message["lost"].as_u64().unwrap();
                ticks.frames.extend(message["frames"].as_array().unwrap().iter().cloned());
            }
            if is_wanted(&message) {
                return (message, ticks);
            }
        }
    }

    /// Reads on until the run has this state.
    pub(super) fn until_status(&mut self, state: &str) -> (Value, Ticks) {
        self.until(|message| message["type"] == "status" && message["state"] == state)
    }

    /// Asks a question about another policy. The result is its frames, and its last piece.
    pub(super) fn ask(&mut self, question: &Value) -> (Vec<Value>, Value) {
        self.send(question);
        let mut frames = Vec::new();
        loop {
            let mut message = self.next();
            assert_ne!(message["type"], "error", "{message}");
            if message["type"] == "counterfactual" {
                frames.append(message["frames"].as_array_mut().unwrap());
                if message["done"] == true {
                    return (frames, message);
                }
            }
        }
    }
}

/// Ticks that a viewer got, and the number of those that it has missed.
#[derive(Default)]
pub(super) struct Ticks {
    pub(super) frames: Vec<Value>,
    pub(super) lost: u64,
}
