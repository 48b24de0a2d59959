//! What all objects of a scenario may have together.

use crate::outline::{MOST_PIECES, SIZE_LIMIT};

/// The most bytes of all files that a scenario has outlines from.
const MOST_BYTES: usize = 4 * SIZE_LIMIT;

/// What the objects of a scenario have so far.
#[derive(Debug, Default)]
pub(super) struct Budget {
    pieces: usize,
    bytes: usize,
    is_exceeded: bool,
}

impl Budget {
    /// Counts pieces that are to be made. An error if they are too many, with how many that makes if it is the first one.
    pub(super) fn make(&mut self, pieces: usize) -> Result<(), Option<usize>> {
        if self.is_exceeded {
            return Err(None);
        }
        self.pieces = self.pieces.saturating_add(pieces);
        self.is_exceeded = self.pieces > MOST_PIECES;
        if self.is_exceeded { Err(Some(self.pieces)) } else { Ok(()) }
    }

    /// Counts bytes that have been read.
    pub(super) fn read(&mut self, bytes: usize) {
        self.bytes = self.bytes.saturating_add(bytes);
    }

    /// Whether another file may be read.
    pub(super) fn check_files(&self) -> Result<(), String> {
        if self.is_exceeded {
            return Err("there are too many lines and arcs already".to_owned());
        }
        let limit = MOST_BYTES >> 20;
        if self.bytes > MOST_BYTES {
            Err(format!("the files before it have more than {limit} MiB together"))
        } else {
            Ok(())
        }
    }
}
