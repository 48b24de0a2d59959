//! A page: what it is sent and what it asks for.

use std::collections::BTreeMap;
use std::net::TcpStream;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;

use tungstenite::protocol::WebSocket;
use tungstenite::{Error, Message};

use super::hub::Hub;
use super::log::RunLog;
use super::socket::Socket;
use vibrissa_lab::stream::message::{History, PageMessage, Piece, ServerMessage, Ticks};
use vibrissa_lab::stream::{Counterfactual, Question, breakpoints, breakpoints_with};

/// The largest number of ticks in a message. Of more that are new, the oldest are lost.
const BATCH: usize = 120;
/// The largest and the usual number of ticks of an answer about the past.
const RANGE_LIMIT: usize = 4000;
const RANGE: usize = 2000;
/// The largest number of counterfactuals of a page at a time.
const QUESTIONS: usize = 8;
/// The number of ticks of a counterfactual between two looks whether it is canceled.
const TICKS: usize = 60;
/// The largest number of breakpoints.
const BREAKPOINTS: usize = 64;

/// Serves a page until its connection ends.
pub(super) fn serve_page(socket: WebSocket<TcpStream>, hub: &Arc<Hub>) -> Result<(), Error> {
    let (sender, answers) = channel();
    let mut page = Page {
        socket: Socket::new(socket)?,
        hub: Arc::clone(hub),
        run: None,
        next: 0,
        status: None,
        questions: BTreeMap::new(),
        sender,
        answers,
    };
    let served = page.serve();
    page.cancel_all();
    served
}

/// A connection to a page.
struct Page {
    socket: Socket,
    hub: Arc<Hub>,
    /// The run that the page shows, and its number.
    run: Option<(u64, Arc<RunLog>)>,
    /// The next tick to send.
    next: usize,
    /// Version of the status that the page has.
    status: Option<u64>,
    /// The questions that are being answered, each with its cancellation.
    questions: BTreeMap<u64, Arc<AtomicBool>>,
    sender: Sender<ServerMessage>,
    answers: Receiver<ServerMessage>,
}

impl Page {
    fn serve(&mut self) -> Result<(), Error> {
        loop {
            if let Some(message) = self.socket.receive()? {
                self.receive(&message)?;
            }
            self.send_run()?;
            if !self.socket.is_ready() {
                continue;
            }
            self.send_answers()?;
            // A page that is told of a pause has all ticks before it.
            let number = self.run.as_ref().map(|(number, _)| *number);
            let status = number.and_then(|number| self.hub.status(number, self.status));
            self.send_ticks()?;
            if let Some((version, status)) = status {
                self.status = Some(version);
                self.send(&ServerMessage::Status(status))?;
            }
        }
    }

    fn send(&mut self, message: &ServerMessage) -> Result<(), Error> {
        // Messages have no maps with other keys than texts, and no values that cannot be written.
        let text = serde_json::to_string(message).unwrap_or_default();
        self.socket.send(Message::text(text))
    }

    /// Sends the first message of a new run.
    fn send_run(&mut self) -> Result<(), Error> {
        let Some((number, log)) = self.hub.run() else { return Ok(()) };
        if self.run.as_ref().is_some_and(|(known, _)| *known == number) {
            return Ok(());
        }
        self.cancel_all();
        let hello = ServerMessage::Hello(Arc::clone(&log.facts.hello));
        (self.run, self.next, self.status) = (Some((number, log)), 0, None);
        self.send(&hello)
    }

    /// Sends the newest ticks.
    fn send_ticks(&mut self) -> Result<(), Error> {
        let Some((_, log)) = &self.run else { return Ok(()) };
        let frames = log.past().newest(self.next, BATCH);
        let (Some(first), Some(last)) = (frames.first(), frames.last()) else { return Ok(()) };
        let lost = first.tick - self.next.min(first.tick);
        self.next = last.tick + 1;
        self.send(&ServerMessage::Ticks(Ticks { lost, frames }))?;
        self.socket.end_batch()
    }

    /// Sends pieces of counterfactuals.
    fn send_answers(&mut self) -> Result<(), Error> {
        while let Ok(message) = self.answers.try_recv() {
            match &message {
                ServerMessage::Counterfactual(Piece { id, done: true, .. })
                | ServerMessage::Error { id: Some(id), .. } => {
                    self.questions.remove(id);
                }
                _ => {}
            }
            self.send(&message)?;
        }
        Ok(())
    }

    fn refuse(&mut self, message: impl Into<String>, id: Option<u64>) -> Result<(), Error> {
        self.send(&ServerMessage::Error { message: message.into(), id })
    }

    fn receive(&mut self, message: &Message) -> Result<(), Error> {
        let asked = message.to_text().map_err(|error| error.to_string());
        let asked = asked.and_then(|text| serde_json::from_str(text).map_err(|error| error.to_string()));
        let asked: PageMessage = match asked {
            Ok(asked) => asked,
            Err(error) => return self.refuse(format!("this is no message of the protocol: {error}"), None),
        };
        let Some((_, log)) = self.run.clone() else { return self.refuse("no run has begun yet", None) };
        match asked {
            PageMessage::Pause => {
                self.hub.pause();
                Ok(())
            }
            PageMessage::Run => {
                self.hub.resume();
                Ok(())
            }
            PageMessage::Step { ticks } => {
                self.hub.step(ticks);
                Ok(())
            }
            PageMessage::Range { from, to, most } => {
                let frames = log.past().range(from, to, most.unwrap_or(RANGE).min(RANGE_LIMIT));
                self.send(&ServerMessage::History(History { from, to, frames }))
            }
            PageMessage::Break { add, remove } => self.change_breakpoints(&log, add.as_ref(), remove.as_deref()),
            PageMessage::Counterfactual { id, tick, kind, set } => {
                self.ask(log, Question { id, tick, kind, values: set })
            }
            PageMessage::Cancel { id } => {
                if let Some(canceled) = self.questions.get(&id) {
                    canceled.store(true, Ordering::Relaxed);
                }
                Ok(())
            }
        }
    }

    fn change_breakpoints(&mut self, log: &RunLog, add: Option<&String>, remove: Option<&str>) -> Result<(), Error> {
        let Some(source) = &log.policy else {
            return self.refuse("this run has no breakpoints, because its policy has no text", None);
        };
        let mut texts = self.hub.breakpoints().texts;
        texts.retain(|text| Some(text.as_str()) != remove);
        if let Some(add) = add
            && !texts.contains(add)
        {
            texts.push(add.clone());
        }
        if texts.len() > BREAKPOINTS {
            return self.refuse(format!("there are {BREAKPOINTS} breakpoints; remove some of them"), None);
        }
        match breakpoints_with(source, &texts, add) {
            Ok(policy) => {
                self.hub.set_breakpoints(texts, breakpoints(&policy));
                Ok(())
            }
            Err(fault) => self.refuse(format!("this is no breakpoint: {fault}"), None),
        }
    }

    /// Answers a question in a thread of its own.
    fn ask(&mut self, log: Arc<RunLog>, question: Question) -> Result<(), Error> {
        let id = question.id;
        if self.questions.contains_key(&id) {
            return self.refuse("this number belongs to another question; take a new one", None);
        }
        if self.questions.len() >= QUESTIONS {
            return self.refuse(format!("{QUESTIONS} questions are being answered; cancel some of them"), Some(id));
        }
        let (sender, canceled) = (self.sender.clone(), Arc::new(AtomicBool::new(false)));
        let is_canceled = Arc::clone(&canceled);
        let work = move || {
            let send = |piece| sender.send(ServerMessage::Counterfactual(piece)).is_ok();
            if let Err(message) = answer(&log, question, &is_canceled, send) {
                // Nobody waits if the page is gone.
                let _ = sender.send(ServerMessage::Error { message, id: Some(id) });
            }
        };
        match thread::Builder::new().name("counterfactual".to_owned()).spawn(work) {
            Ok(_) => {
                self.questions.insert(id, canceled);
                Ok(())
            }
            Err(cause) => self.refuse(format!("the system starts no thread for the answer: {cause}"), Some(id)),
        }
    }

    fn cancel_all(&mut self) {
        for canceled in std::mem::take(&mut self.questions).values() {
            canceled.store(true, Ordering::Relaxed);
        }
    }
}

/// Answers a question in pieces, which `send` receives. It returns false if nobody waits for them. `is_canceled` ends the answer.
///
/// # Errors
/// What cannot be done, for people.
fn answer(
    log: &RunLog,
    question: Question,
    is_canceled: &AtomicBool,
    mut send: impl FnMut(Piece) -> bool,
) -> Result<(), String> {
    let mut answer = Counterfactual::begin(log, question)?;
    loop {
        if let Some(piece) = answer.advance(log, TICKS)? {
            let is_last = piece.done;
            if !send(piece) || is_last {
                return Ok(());
            }
        }
        if is_canceled.load(Ordering::Relaxed) {
            send(answer.cancel());
            return Ok(());
        }
    }
}
