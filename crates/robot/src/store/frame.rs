//! The frame: a signed machine as it is sent to the robot.
//!
//! | bytes | content |
//! |---|---|
//! | 8 | [`MAGIC`] |
//! | 4 | [`FORMAT`], little endian |
//! | 4 | length of the artifact, little endian |
//! | 4 | length of the signature, little endian |
//! | length | the artifact |
//! | length | the signature, in the text format of minisign |
//!
//! The stream ends there.

use std::io::{self, ErrorKind, Read, Write};
use vibrissa_text::system::in_words;

use vibrissa_runtime::machine::ARTIFACT_LIMIT;

use super::signed_machine::SignedMachine;

/// The first bytes of a frame. No text begins with them.
const MAGIC: [u8; 8] = *b"\x89PSH\r\n\x1a\n";
/// Number of the format of the frame.
const FORMAT: u32 = 1;
/// Maximum size of a signature in bytes.
pub const SIGNATURE_LIMIT: usize = 4 << 10;

/// An error of reading a frame.
#[derive(Debug, thiserror::Error)]
pub enum FrameError {
    /// The stream does not begin as a frame.
    #[error("the input is not a push: it does not begin as one; send it with the push command of this project")]
    NotAFrame,
    /// The frame has another format.
    #[error(
        "the push is in format {found}, this program reads format {FORMAT}; use the same version on both computers"
    )]
    Format {
        /// Number of that format.
        found: u32,
    },
    /// The stream ends too soon.
    #[error("the push ended too soon, so nothing was changed; push the machine again")]
    Truncated,
    /// Bytes follow the end.
    #[error("bytes follow the end of the push, so nothing was changed; send one machine in each push")]
    Trailing,
    /// The artifact is larger than [`ARTIFACT_LIMIT`].
    #[error("the machine has {found} bytes, the limit is {ARTIFACT_LIMIT}; make the policy smaller")]
    ArtifactTooLarge {
        /// Its size in bytes.
        found: u64,
    },
    /// The signature is larger than [`SIGNATURE_LIMIT`].
    #[error(
        "the signature has {found} bytes, the limit is {SIGNATURE_LIMIT}; sign the machine with `minisign -Sm FILE`"
    )]
    SignatureTooLarge {
        /// Its size in bytes.
        found: u64,
    },
    /// The signature is not UTF-8.
    #[error("the signature is not text; sign the machine with `minisign -Sm FILE`")]
    NotText,
    /// The stream cannot be read.
    #[error("the push cannot be read: {words}; push the machine again", words = in_words(.0))]
    Read(#[source] io::Error),
}

impl SignedMachine {
    /// Writes a frame to a stream and flushes it.
    ///
    /// # Errors
    /// The stream cannot be written.
    pub fn write_frame(&self, mut to: impl Write) -> io::Result<()> {
        let length = |part: &[u8]| u32::try_from(part.len()).map_err(|_| ErrorKind::InvalidInput);
        let (artifact, signature) = (self.artifact(), self.signature().as_bytes());
        to.write_all(&MAGIC)?;
        for number in [FORMAT, length(artifact)?, length(signature)?] {
            to.write_all(&number.to_le_bytes())?;
        }
        to.write_all(artifact)?;
        to.write_all(signature)?;
        to.flush()
    }

    /// Reads a frame up to the end of the stream. It allocates no more than the limits.
    ///
    /// # Errors
    /// The stream is not exactly one frame.
    pub fn read_frame(mut from: impl Read) -> Result<Self, FrameError> {
        if bytes(&mut from, MAGIC.len())? != MAGIC {
            return Err(FrameError::NotAFrame);
        }
        let format = number(&mut from)?;
        if format != FORMAT {
            return Err(FrameError::Format { found: format });
        }
        let artifact = number(&mut from)? as usize;
        let signature = number(&mut from)? as usize;
        if artifact > ARTIFACT_LIMIT {
            return Err(FrameError::ArtifactTooLarge { found: artifact as u64 });
        }
        if signature > SIGNATURE_LIMIT {
            return Err(FrameError::SignatureTooLarge { found: signature as u64 });
        }
        let artifact = bytes(&mut from, artifact)?;
        let signature = String::from_utf8(bytes(&mut from, signature)?).map_err(|_| FrameError::NotText)?;
        match bytes(&mut from, 1) {
            Err(FrameError::Truncated) => Ok(Self::new(artifact, signature)),
            Ok(_) => Err(FrameError::Trailing),
            Err(cause) => Err(cause),
        }
    }
}

/// Reads exactly `length` bytes.
fn bytes(from: &mut impl Read, length: usize) -> Result<Vec<u8>, FrameError> {
    let mut bytes = Vec::with_capacity(length);
    from.take(length as u64).read_to_end(&mut bytes).map_err(FrameError::Read)?;
    if bytes.len() == length { Ok(bytes) } else { Err(FrameError::Truncated) }
}

fn number(from: &mut impl Read) -> Result<u32, FrameError> {
    let bytes = bytes(from, size_of::<u32>())?;
    let number = <[u8; size_of::<u32>()]>::try_from(bytes).map_err(|_| FrameError::Truncated)?;
    Ok(u32::from_le_bytes(number))
}
