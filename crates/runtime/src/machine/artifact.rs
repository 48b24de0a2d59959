//! The artifact: a compiled policy as bytes, for a robot or for storage.
//!
//! | bytes | content |
//! |---|---|
//! | 8 | [`MAGIC`] |
//! | 4 | [`FORMAT`], little endian |
//! | 4 | length of the next part, little endian |
//! | length | an [`Artifact`] in postcard's wire format |
//! | 32 | SHA-256 of all preceding bytes |
//!
//! An artifact has exactly one encoding in a format. The reader trusts nothing. The checksum detects damage, but not manipulation,
//! so everything that the execution relies on is verified afterwards.

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::program::Program;
use super::source_map::SourceMap;
use super::unsound::Unsound;

/// The first bytes of every artifact. No text begins with them.
pub const MAGIC: [u8; 8] = *b"\x89FSM\r\n\x1a\n";
/// Number of the format. It covers the layout of [`Artifact`] and of everything in it, including the order of
/// operations and quantities.
pub const FORMAT: u32 = 13;
/// The oldest format that is read. Formats since then have only added operations behind the known ones, so machines on robots
/// and in recordings stay valid.
const OLDEST_FORMAT: u32 = 12;
/// Maximum size of an artifact in bytes. The largest program of the compiler has less than half of them.
pub const ARTIFACT_LIMIT: usize = 4 << 20;

/// Length of the SHA-256 checksum in bytes.
const CHECKSUM_LENGTH: usize = 32;
/// Maximum length of the texts in [`Origin`], in bytes.
const TEXT_LIMIT: usize = 255;

/// A compiled policy and its origin.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Artifact {
    /// Source and compiler of the policy.
    pub origin: Origin,
    /// The compiled policy. [`Program::initial_registers`] contains the values of the parameters that were set.
    pub program: Program,
    /// Work of a tick: the upper bound of its operations, [`Program::most_operations`]. A device compares it with its own
    /// speed.
    pub most_operations: usize,
    /// Positions of states and transitions in the text of the policy.
    pub positions: SourceMap,
}

/// The source and the compiler of a compiled policy.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Origin {
    /// Name of the policy's file, without its path.
    pub file: String,
    /// SHA-256 of the text of the policy and of the files that it uses, each followed by a line end.
    pub text_sha256: [u8; 32],
    /// Version of the compiler.
    pub compiler: String,
}

/// An error of reading or writing an artifact.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ArtifactError {
    /// The bytes do not begin with [`MAGIC`].
    #[error(
        "this file does not begin as compiled machines do: it is another file, or a copy in text mode has damaged it; copy \
         it in binary mode, or compile it from its policy with `vibrissa compile`"
    )]
    NotAnArtifact,
    /// The artifact has another format.
    #[error(
        "the machine is in format {found}, this program reads formats {OLDEST_FORMAT} to {FORMAT}; compile the policy with this \
         program"
    )]
    Format {
        /// Number of that format.
        found: u32,
    },
    /// Bytes are missing or follow the end.
    #[error("the machine is truncated or has bytes after its end; copy it again, or compile the policy again")]
    Length,
    /// It is larger than [`ARTIFACT_LIMIT`].
    #[error("the machine is larger than {ARTIFACT_LIMIT} bytes; make the policy smaller")]
    TooLarge,
    /// The checksum does not match the content.
    #[error("the machine is damaged, its checksum does not match; copy it again, or compile the policy again")]
    Checksum,
    /// The content cannot be decoded in this format.
    #[error("the machine cannot be decoded, although its checksum matches; compile the policy with this program")]
    Content,
    /// A text in [`Origin`] is too long or has control characters.
    #[error(
        "the machine names {0:?} as its origin, which is not one line of at most {TEXT_LIMIT} bytes; rename the policy"
    )]
    Origin(String),
    /// The number of positions differs from the number of states and transitions.
    #[error("the machine's source map belongs to another policy; compile the policy again")]
    Positions,
    /// The stated work of a tick is not that of the program.
    #[error("the machine states {stated} operations a tick, but its code has up to {actual}; compile the policy again")]
    Operations {
        /// Operations that it states.
        stated: usize,
        /// Upper bound of its code.
        actual: usize,
    },
    /// The program is not safe to run.
    #[error("the machine is not safe to run: {0}; compile the policy again")]
    Unsound(#[from] Unsound),
}

impl Artifact {
    /// True if `bytes` begin like an artifact. The text of a policy never does.
    #[must_use]
    pub fn is_in(bytes: &[u8]) -> bool {
        bytes.starts_with(&MAGIC)
    }

    /// Encodes the artifact.
    ///
    /// # Errors
    /// [`ArtifactError`] if the result could not be read again: the program is unsound or too large, or a text of the
    /// origin is invalid.
    pub fn to_bytes(&self) -> Result<Vec<u8>, ArtifactError> {
        self.verify()?;
        let content = self.content()?;
        let length = u32::try_from(content.len()).map_err(|_| ArtifactError::TooLarge)?;
        let mut bytes = [&MAGIC[..], &FORMAT.to_le_bytes(), &length.to_le_bytes(), &content].concat();
        let checksum = Sha256::digest(&bytes);
        bytes.extend(checksum);
        if bytes.len() > ARTIFACT_LIMIT { Err(ArtifactError::TooLarge) } else { Ok(bytes) }
    }

    /// Decodes and verifies an artifact from untrusted bytes. The result is safe to run.
    ///
    /// # Errors
    /// [`ArtifactError`] with the first problem found.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, ArtifactError> {
        let behind_magic = bytes.strip_prefix(&MAGIC).ok_or(ArtifactError::NotAnArtifact)?;
        if bytes.len() > ARTIFACT_LIMIT {
            return Err(ArtifactError::TooLarge);
        }
        let (format, rest) = number(behind_magic)?;
        if !(OLDEST_FORMAT..=FORMAT).contains(&format) {
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
        // postcard lets vectors grow only with the content, so a forged length cannot cause a large allocation.
        let artifact: Self = postcard::from_bytes(content).map_err(|_| ArtifactError::Content)?;
        // postcard accepts longer encodings of numbers and ignores bytes after the end. Both would give one artifact
        // several encodings.
        if artifact.content()? != content {
            return Err(ArtifactError::Content);
        }
        artifact.verify()?;
        Ok(artifact)
    }

    /// Encodes the content without header and checksum.
    fn content(&self) -> Result<Vec<u8>, ArtifactError> {
        postcard::to_allocvec(self).map_err(|_| ArtifactError::Content)
    }

    /// Checks the texts, the program, the stated work and the positions.
    fn verify(&self) -> Result<(), ArtifactError> {
        for text in [&self.origin.file, &self.origin.compiler] {
            if text.len() > TEXT_LIMIT || text.chars().any(char::is_control) {
                return Err(ArtifactError::Origin(text.chars().take(TEXT_LIMIT).collect()));
            }
        }
        self.program.verify()?;
        let (stated, actual) = (self.most_operations, self.program.most_operations());
        if stated != actual {
            return Err(ArtifactError::Operations { stated, actual });
        }
        if self.positions.fits(&self.program) { Ok(()) } else { Err(ArtifactError::Positions) }
    }
}

/// Splits `bytes` into the number at their start and the rest.
fn number(bytes: &[u8]) -> Result<(u32, &[u8]), ArtifactError> {
    let (number, rest) = bytes.split_first_chunk().ok_or(ArtifactError::Length)?;
    Ok((u32::from_le_bytes(*number), rest))
}
