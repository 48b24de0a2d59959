//! A recorded run, from one or several files.

use std::collections::{BTreeMap, VecDeque};
use std::io::Read;

use super::channel::{Channel, Message};
use super::error::ReadError;
use super::part::Part;
use super::setup::{PART, Setup};

/// A recorded run. Its parts are read one after the other.
pub struct Recording<R> {
    setup: Setup,
    identity: BTreeMap<String, String>,
    parts: VecDeque<Part<R>>,
    is_cut: bool,
    /// The next sequence number of each channel.
    sequences: [u32; Channel::ALL.len()],
}

impl<R: Read> Recording<R> {
    /// Joins the files of a run, which may be in any order.
    ///
    /// # Errors
    /// [`ReadError`] if there is no file, or if the files belong to different runs.
    pub fn join(mut parts: Vec<Part<R>>) -> Result<Self, ReadError> {
        let first = parts.first().ok_or(ReadError::Empty)?;
        let (setup, identity) = (first.setup().clone(), of_run(first.identity()));
        if parts.iter().any(|part| of_run(part.identity()) != identity) {
            return Err(ReadError::OtherRun);
        }
        parts.sort_by_key(number);
        if let Some(part) = parts.windows(2).find_map(|pair| same_number(pair)) {
            return Err(ReadError::Twice { part });
        }
        Ok(Self { setup, identity, parts: parts.into(), is_cut: false, sequences: [0; Channel::ALL.len()] })
    }

    /// Opens a run in one file.
    ///
    /// # Errors
    /// [`ReadError`] if it is no recording that this program can replay.
    pub fn open(file: R) -> Result<Self, ReadError> {
        Self::join(vec![Part::open(file)?])
    }

    /// The machine and the configuration.
    #[must_use]
    pub fn setup(&self) -> &Setup {
        &self.setup
    }

    /// The metadata of the run, such as the hashes of the machine and of the program.
    #[must_use]
    pub fn identity(&self) -> &BTreeMap<String, String> {
        &self.identity
    }

    /// True if the end of the last file is missing. It is known once all messages have been read.
    #[must_use]
    pub fn is_cut(&self) -> bool {
        self.is_cut
    }

    /// The next message. Messages of steps and ticks are complete from the start of the run.
    pub(super) fn next_message(&mut self) -> Result<Option<Message>, ReadError> {
        while let Some(part) = self.parts.front_mut() {
            if let Some(message) = part.next_message()? {
                self.check(&message)?;
                return Ok(Some(message));
            }
            self.is_cut = part.is_cut();
            self.parts.pop_front();
        }
        Ok(None)
    }

    /// Looks for a gap before a message that a replay needs.
    fn check(&mut self, message: &Message) -> Result<(), ReadError> {
        let has_begun = self.sequences.get(Channel::Steps.index()).is_some_and(|&next| next > 0);
        let Some(expected) = self.sequences.get_mut(message.channel.index()) else { return Ok(()) };
        let missing = message.sequence.wrapping_sub(*expected);
        *expected = message.sequence.wrapping_add(1);
        if missing == 0 || matches!(message.channel, Channel::Events | Channel::Packets) {
            return Ok(());
        }
        let time_s = message.time_ns as f64 * 1e-9;
        Err(if has_begun {
            ReadError::Gap { channel: message.channel.topic(), time_s, missing }
        } else {
            ReadError::NoStart { time_s }
        })
    }
}

/// The metadata that all parts of a run share.
fn of_run(identity: &BTreeMap<String, String>) -> BTreeMap<String, String> {
    let mut identity = identity.clone();
    identity.remove(PART);
    identity
}

fn number<R: Read>(part: &Part<R>) -> u32 {
    part.identity().get(PART).and_then(|number| number.parse().ok()).unwrap_or(0)
}

/// The number that two neighbouring parts share.
fn same_number<R: Read>(pair: &[Part<R>]) -> Option<u32> {
    let [first, second] = pair else { return None };
    (number(first) == number(second)).then(|| number(first))
}
