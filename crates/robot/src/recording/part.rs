//! One file of a recording.

use std::collections::{BTreeMap, HashMap, VecDeque};
use std::io::Read;

use super::attachment::Attachment;
use super::channel::{Channel, Message};
use super::error::ReadError;
use super::records::{FileRecord, Records};
use super::setup::{self, FORMAT, KIND, Setup, sha256};

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
        let (mut identity, mut attachments, mut early) = (None, HashMap::new(), VecDeque::new());
        while early.is_empty() || !is_complete(identity.as_ref(), &attachments) {
            match items.next_record()? {
                None => break,
                Some(FileRecord::Identity(entries)) => identity = Some(entries),
                Some(FileRecord::Attachment(Attachment { name, data })) => {
                    attachments.insert(name, data);
                }
                Some(FileRecord::Message(message)) => early.push_back(message),
            }
        }
        let identity = match (identity, items.is_cut()) {
            (Some(identity), _) => identity,
            (None, true) => return Err(ReadError::Empty),
            (None, false) => return Err(ReadError::Foreign),
        };
        check(&identity)?;
        let setup = read_setup(attachments, &identity)?;
        Ok(Self { setup, items, identity, early })
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
fn is_complete(identity: Option<&BTreeMap<String, String>>, attachments: &HashMap<String, Vec<u8>>) -> bool {
    let names = [setup::MACHINE, setup::CONFIGURATION, setup::CONFIGURATION_TEXT].map(|(name, _)| name);
    let is_read = |identity: &BTreeMap<String, String>, name: &str| {
        attachments.contains_key(name) || !identity.contains_key(&format!("{name}_sha256"))
    };
    identity.is_some_and(|identity| names.iter().all(|name| is_read(identity, name)))
}

/// Checks that this program can replay the recording.
fn check(identity: &BTreeMap<String, String>) -> Result<(), ReadError> {
    let entry = |key: &str| identity.get(key).cloned().unwrap_or_default();
    match (entry("kind"), entry("format")) {
        (kind, _) if kind != KIND => Err(ReadError::Kind { found: kind }),
        (_, format) if format != FORMAT => Err(ReadError::Format { found: format }),
        _ => Ok(()),
    }
}

/// The setup in the attachments. Their hashes are compared with the metadata.
fn read_setup(
    mut attachments: HashMap<String, Vec<u8>>,
    identity: &BTreeMap<String, String>,
) -> Result<Setup, ReadError> {
    let mut take = |name: &str| {
        let Some(content) = attachments.remove(name) else { return Ok(None) };
        if identity.get(&format!("{name}_sha256")) == Some(&sha256(&content)) {
            Ok(Some(content))
        } else {
            Err(ReadError::Damaged(format!("the attachment `{name}` has another hash than the metadata say")))
        }
    };
    let machine = take(setup::MACHINE.0)?.ok_or(ReadError::Empty)?;
    let configuration = take(setup::CONFIGURATION.0)?.ok_or(ReadError::Empty)?;
    let text = take(setup::CONFIGURATION_TEXT.0)?.and_then(|text| String::from_utf8(text).ok());
    Ok(Setup::from_attachments(machine, configuration, text)?)
}
