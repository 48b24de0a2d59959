//! Answers to commands.

/// The answer to the last command: a status without RS and SED, then data.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Answer {
    bytes: [u8; 9],
    length: usize,
}

impl Answer {
    /// An answer without data.
    pub(crate) fn status(status: u8) -> Self {
        let mut bytes = [0; 9];
        bytes[0] = status;
        Self { bytes, length: 1 }
    }

    /// Adds a word of data. An answer has at most four.
    pub(crate) fn push(&mut self, word: u16) {
        self.bytes[self.length..self.length + 2].copy_from_slice(&word.to_be_bytes());
        self.length += 2;
    }

    /// A byte. After the end of the answer, nobody drives the bus, so all bits are 1.
    pub(crate) fn byte(&self, index: usize) -> u8 {
        if index < self.length { self.bytes[index] } else { 0xFF }
    }
}
