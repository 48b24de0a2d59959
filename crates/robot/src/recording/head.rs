//! Everything in a file beside its messages.

use std::collections::BTreeMap;

use super::attachment::Attachment;
use super::error::ReadError;
use super::records::{FileMessage, FileRecord};
use super::setup::sha256;

/// Version of the format of recordings.
pub const FORMAT: &str = "1";

/// The metadata that identify a recording, and its attachments by their names.
#[derive(Debug, Default)]
pub struct Head {
    /// The metadata. Empty without any.
    pub identity: BTreeMap<String, String>,
    /// The attachments.
    pub attachments: BTreeMap<String, Vec<u8>>,
}

impl Head {
    /// Adds a record. The result is its message, if it has one.
    pub fn add<C>(&mut self, record: FileRecord<C>) -> Option<FileMessage<C>> {
        match record {
            FileRecord::Identity(identity) => self.identity = identity,
            FileRecord::Attachment(Attachment { name, data }) => {
                self.attachments.insert(name, data);
            }
            FileRecord::Message(message) => return Some(message),
        }
        None
    }

    /// An entry of the metadata. Empty if there is none.
    #[must_use]
    pub fn entry(&self, key: &str) -> &str {
        self.identity.get(key).map_or("", String::as_str)
    }

    /// Checks that this program can read the format.
    ///
    /// # Errors
    /// [`ReadError::Format`] if it cannot.
    pub fn check_format(&self) -> Result<(), ReadError> {
        let found = self.entry("format");
        if found == FORMAT { Ok(()) } else { Err(ReadError::Format { found: found.to_owned() }) }
    }

    /// Removes an attachment and returns its content. The entry `hash` of the metadata has its hash.
    ///
    /// # Errors
    /// [`ReadError::Damaged`] if the content has another hash.
    pub fn take(&mut self, name: &str, hash: &str) -> Result<Option<Vec<u8>>, ReadError> {
        let Some(content) = self.attachments.remove(name) else { return Ok(None) };
        if self.entry(hash) == sha256(&content) {
            return Ok(Some(content));
        }
        Err(ReadError::Damaged(format!("the attachment `{name}` has another hash than the metadata say")))
    }
}
