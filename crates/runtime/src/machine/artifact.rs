//! The artifact: a compiled policy as bytes, for a robot or an archive.
//!
//! | bytes | hold |
//! |---|---|
//! | 8 | [`MAGIC`] |
//! | 4 | the format's number, little endian |
//! | 4 | length of the content, little endian |
//! | length | the content: an [`Artifact`] in postcard's wire format |
//! | 32 | SHA-256 of all before |
//!
//! The same artifact always gives the same bytes, and no other bytes give it. Reading trusts nothing: a checksum tells damage,
//! not malice, so that everything that running relies on is verified behind it.

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::program::Program;
use super::source_map::SourceMap;
use super::verify::Unsound;

/// How every artifact begins; no text does.
pub const MAGIC: [u8; 8] = *b"\x89FSM\r\n\x1a\n";
/// The number of the format that is written and read. It counts the layout of [`Artifact`] and everything in it, the order of
/// operations and quantities too.
pub const FORMAT: u32 = 5;
/// The most bytes that an artifact may have; the largest program that the compiler writes has less than half of them.
pub const ARTIFACT_LIMIT: usize = 4 << 20;

const CHECKSUM_LENGTH: usize = 32;
/// The most bytes of the texts in [`Origin`].
const TEXT_LIMIT: usize = 255;

/// A compiled policy and where it comes from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Artifact {
    /// Where it comes from.
    pub origin: Origin,
    /// The compiled policy; [`Program::initial_registers`] has the parameters as they were set.
    pub program: Program,
    /// Where in its text the policy's states and transitions are.
    pub positions: SourceMap,
}

/// Where a compiled policy comes from.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Origin {
    /// Name of the policy's file, without a path.
    pub file: String,
    /// SHA-256 of the policy's text and those of the files that it uses, each behind a line end.
    pub text_sha256: [u8; 32],
    /// Version of the compiler.
    pub compiler: String,
}

/// Why bytes are no artifact, or an artifact cannot be written.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ArtifactError {
    /// The bytes do not begin with [`MAGIC`].
    #[error(
        "this does not begin as compiled machines do: it is another file, or was damaged, as by a copy that took it for text; \
         copy it again as it is, or make it from its policy with `vibrissa compile`"
    )]
    NotAnArtifact,
    /// It is in another format.
    #[error(
        "the machine is in format {found}, this program reads format {FORMAT}; compile the policy with this program"
    )]
    Format {
        /// The format's number.
        found: u32,
    },
    /// Bytes are missing, or there are too many.
    #[error("the machine is cut off or has something behind its end; copy it again, or compile the policy again")]
    Length,
    /// It is larger than [`ARTIFACT_LIMIT`].
    #[error("the machine is larger than {ARTIFACT_LIMIT} bytes; make the policy smaller")]
    TooLarge,
    /// The checksum is that of other bytes.
    #[error("the machine is damaged, its checksum does not hold; copy it again, or compile the policy again")]
    Checksum,
    /// The content is none of this format.
    #[error("the machine cannot be decoded, although its checksum holds; compile the policy with this program")]
    Content,
    /// A text in [`Origin`] is long or has characters that cannot be shown.
    #[error("the machine names {0:?} as its origin, which is no single line of {TEXT_LIMIT} bytes; rename the policy")]
    Origin(String),
    /// There are more or fewer places than states and transitions.
    #[error("the machine's source map is that of another policy; compile the policy again")]
    Positions,
    /// The program is not safe to run.
    #[error("the machine is not safe to run: {0}; compile the policy again")]
    Unsound(#[from] Unsound),
}

impl Artifact {
    /// Whether `bytes` claim to be an artifact: a policy's text never does.
    #[must_use]
    pub fn is_in(bytes: &[u8]) -> bool {
        bytes.starts_with(&MAGIC)
    }

    /// The artifact as bytes.
    ///
    /// # Errors
    /// [`ArtifactError`] if the bytes could not be read again: the program is unsound or too large, or a text of its origin is
    /// unfit.
    pub fn to_bytes(&self) -> Result<Vec<u8>, ArtifactError> {
        self.verify()?;
        let content = self.content()?;
        let length = u32::try_from(content.len()).map_err(|_| ArtifactError::TooLarge)?;
        let mut bytes = [&MAGIC[..], &FORMAT.to_le_bytes(), &length.to_le_bytes(), &content].concat();
        let checksum = Sha256::digest(&bytes);
        bytes.extend(checksum);
        if bytes.len() > ARTIFACT_LIMIT { Err(ArtifactError::TooLarge) } else { Ok(bytes) }
    }

    /// The artifact in `bytes`, which may come from anywhere: what is returned is safe to run.
    ///
    /// # Errors
    /// [`ArtifactError`] with the first thing that is wrong.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, ArtifactError> {
        let behind_magic = bytes.strip_prefix(&MAGIC).ok_or(ArtifactError::NotAnArtifact)?;
        if bytes.len() > ARTIFACT_LIMIT {
            return Err(ArtifactError::TooLarge);
        }
        let (format, rest) = number(behind_magic)?;
        if format != FORMAT {
            return Err(ArtifactError::Format { found: format });
        }
        let (length, rest) = number(rest)?;
        let (content, checksum) = rest.split_at_checked(length as usize).ok_or(ArtifactError::Length)?;
        if checksum.len() != CHECKSUM_LENGTH {
            return Err(ArtifactError::Length);
        }
        if *Sha256::digest(&bytes[..bytes.len() - CHECKSUM_LENGTH]) != *checksum {
            return Err(ArtifactError::Checksum);
        }
        // Vectors in it grow only as far as the content does: nothing is allocated on the word of a length.
        let artifact: Self = postcard::from_bytes(content).map_err(|_| ArtifactError::Content)?;
        // There are longer spellings of numbers, and bytes behind the end are not looked at.
        if artifact.content()? != content {
            return Err(ArtifactError::Content);
        }
        artifact.verify()?;
        Ok(artifact)
    }

    fn content(&self) -> Result<Vec<u8>, ArtifactError> {
        postcard::to_allocvec(self).map_err(|_| ArtifactError::Content)
    }

    fn verify(&self) -> Result<(), ArtifactError> {
        for text in [&self.origin.file, &self.origin.compiler] {
            if text.len() > TEXT_LIMIT || text.chars().any(char::is_control) {
                return Err(ArtifactError::Origin(text.chars().take(TEXT_LIMIT).collect()));
            }
        }
        self.program.verify()?;
        if self.positions.fits(&self.program) { Ok(()) } else { Err(ArtifactError::Positions) }
    }
}

/// The number at the beginning of `bytes`, and what is behind it.
fn number(bytes: &[u8]) -> Result<(u32, &[u8]), ArtifactError> {
    let (number, rest) = bytes.split_first_chunk().ok_or(ArtifactError::Length)?;
    Ok((u32::from_le_bytes(*number), rest))
}
