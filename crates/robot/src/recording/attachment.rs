//! Attachments of MCAP files.

use super::error::ReadError;

/// An attachment. The library's own parser panics if the length of the record is damaged.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Attachment {
    /// Its name.
    pub name: String,
    /// Its content.
    pub data: Vec<u8>,
}

/// Bytes of the two times.
const TIMES: usize = 16;

impl Attachment {
    /// Reads the body of a record: two times, name, media type, content and checksum. The checksum is not compared.
    pub(super) fn parse(body: &[u8]) -> Result<Self, ReadError> {
        let damaged = || ReadError::Damaged("an attachment is shorter than its own length".to_owned());
        let rest = body.get(TIMES..).ok_or_else(damaged)?;
        let (name, rest) = text(rest).ok_or_else(damaged)?;
        let (_, rest) = text(rest).ok_or_else(damaged)?;
        let (length, rest) = rest.split_first_chunk().ok_or_else(damaged)?;
        let length = usize::try_from(u64::from_le_bytes(*length)).map_err(|_| damaged())?;
        let data = rest.get(..length).ok_or_else(damaged)?.to_owned();
        Ok(Self { name, data })
    }
}

/// A text behind its length, and the bytes after it.
fn text(bytes: &[u8]) -> Option<(String, &[u8])> {
    let (length, rest) = bytes.split_first_chunk()?;
    let (text, rest) = rest.split_at_checked(u32::from_le_bytes(*length) as usize)?;
    Some((String::from_utf8(text.to_owned()).ok()?, rest))
}
