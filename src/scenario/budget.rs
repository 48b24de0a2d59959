//! Limits for all objects of a scenario together.
//!
//! Why: docs/decisions/scenes.md#limits-are-checked-before-the-work.

use crate::outline::{MAX_PIECES, SIZE_LIMIT};

/// The largest total size of a scenario's outline files (bytes).
const MAX_BYTES: usize = 4 * SIZE_LIMIT;

/// The resources of a scenario's objects so far.
#[derive(Debug, Default)]
pub(super) struct Budget {
    pieces: usize,
    bytes: usize,
    is_exceeded: bool,
}

impl Budget {
    /// Counts pieces before they are created. Returns an error if there are too many. The first error contains the
    /// total.
    pub(super) fn make(&mut self, pieces: usize) -> Result<(), Option<usize>> {
        if self.is_exceeded {
            return Err(None);
        }
        self.pieces = self.pieces.saturating_add(pieces);
        self.is_exceeded = self.pieces > MAX_PIECES;
        if self.is_exceeded { Err(Some(self.pieces)) } else { Ok(()) }
    }

    /// Counts bytes that have been read.
    pub(super) fn read(&mut self, bytes: usize) {
        self.bytes = self.bytes.saturating_add(bytes);
    }

    /// Returns an error if no further file may be read.
    pub(super) fn check_files(&self) -> Result<(), String> {
        if self.is_exceeded {
            return Err("there are too many lines and arcs already".to_owned());
        }
        let limit = MAX_BYTES >> 20;
        if self.bytes > MAX_BYTES {
            Err(format!("the files before it have more than {limit} MiB together"))
        } else {
            Ok(())
        }
    }
}
