//! One file of a recording.

use std::collections::{BTreeMap, VecDeque};
use std::io::Read;

use super::channel::{Channel, Message};
use super::error::ReadError;
use super::head::Head;
use super::records::{FileRecord, Records};
use super::setup::{self, KIND, Setup};

/// A file of a recording. It is read up to its end, or up to the last complete chunk if its end is missing.
pub struct Part<R> {
    setup: Setup,
    items: Records<R, Channel>,
    identity: BTreeMap<String, String>,
    /// The messages that were read before the header was complete. There is at least one, unless the file has none.
    early: VecDeque<Message>,
}

impl<R: Read> Part<R> {
    /// Reads the header of a file. It is before the messages, or behind them if another program has written the file anew.
    ///
    /// # Errors
    /// [`ReadError`] if it is no recording that this program can replay.
    pub fn open(input: R) -> Result<Self, ReadError> {
        let mut items = Records::new(input, Channel::named);
        let (mut head, mut early) = (Head::default(), VecDeque::new());
        while early.is_empty() || !is_complete(&head) {
            match items.next_record()? {
                None => break,
                Some(record) => early.extend(head.add(record)),
            }
        }
        if head.identity.is_empty() {
            return Err(if items.is_cut() { ReadError::Empty } else { ReadError::Foreign });
        }
        if head.entry("kind") != KIND {
            return Err(ReadError::Kind { found: head.entry("kind").to_owned() });
        }
        head.check_format()?;
        let setup = read_setup(&mut head)?;
        Ok(Self { setup, items, identity: head.identity, early })
    }

    /// The machine and the configuration.
    pub(super) fn setup(&self) -> &Setup {
        &self.setup
    }

    /// The metadata.
    pub(super) fn identity(&self) -> &BTreeMap<String, String> {
        &self.identity
    }

    /// True if the end of the file is missing. It is known once all messages have been read.
    pub(super) fn is_cut(&self) -> bool {
        self.items.is_cut()
    }

    /// The next message.
    pub(super) fn next_message(&mut self) -> Result<Option<Message>, ReadError> {
        if let Some(message) = self.early.pop_front() {
            return Ok(Some(message));
        }
        while let Some(item) = self.items.next_record()? {
            if let FileRecord::Message(message) = item {
                return Ok(Some(message));
            }
        }
        Ok(None)
    }
}

/// True if the metadata and the attachments that they name have been read.
fn is_complete(head: &Head) -> bool {
    let names = [setup::MACHINE, setup::CONFIGURATION, setup::CONFIGURATION_TEXT].map(|(name, _)| name);
    let is_read =
        |name: &str| head.attachments.contains_key(name) || !head.identity.contains_key(&format!("{name}_sha256"));
    !head.identity.is_empty() && names.into_iter().all(is_read)
}

/// The setup in the attachments.
fn read_setup(head: &mut Head) -> Result<Setup, ReadError> {
    let mut take = |(name, _): (&str, &str)| head.take(name, &format!("{name}_sha256"));
    let machine = take(setup::MACHINE)?.ok_or(ReadError::Empty)?;
    let configuration = take(setup::CONFIGURATION)?.ok_or(ReadError::Empty)?;
    let text = take(setup::CONFIGURATION_TEXT)?.and_then(|text| String::from_utf8(text).ok());
    Ok(Setup::from_attachments(machine, configuration, text)?)
}
