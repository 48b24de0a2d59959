//! The lines of a file of results, read.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use serde::Deserialize;

use crate::results::Document;

use super::header::Header;
use super::results::ResultsError;

/// The most bytes of a line. A header holds the text of its sweep, of up to 1 MiB, and names what that depends on; the line of a run has a few
/// thousand bytes.
pub(super) const LINE_LIMIT: usize = 16 << 20;

/// How every file of results begins.
const BEGINNING: &[u8] = br#"{"format":"sweep""#;

/// What a first line says before it is known to be of this version.
#[derive(Deserialize)]
struct Preamble {
    version: Option<u32>,
}

/// A reader of results, from the first line on.
pub(super) struct Lines<'f> {
    path: &'f Path,
    reader: BufReader<&'f File>,
    /// How many lines were read.
    number: usize,
    /// How many bytes those have.
    whole: u64,
}

impl<'f> Lines<'f> {
    /// Of a file that has just been opened.
    pub(super) fn new(path: &'f Path, file: &'f File) -> Self {
        Self { path, reader: BufReader::new(file), number: 0, whole: 0 }
    }

    /// What the first line says; `None` if it is not there as a whole.
    pub(super) fn header(&mut self) -> Result<Option<Header>, ResultsError> {
        let no_results = |cause: String| ResultsError::NoResults { path: self.path.to_owned(), cause };
        let text = self.read()?;
        let is_whole = text.ends_with(b"\n");
        if is_whole {
            let preamble: Preamble = serde_json::from_slice(&text).map_err(|cause| no_results(cause.to_string()))?;
            if preamble.version != Some(Header::VERSION) {
                let version = preamble.version.map_or("no version".to_owned(), |version| format!("version {version}"));
                let this = Header::VERSION;
                return Err(no_results(format!(
                    "it has {version} of the format, and this program reads version {this}"
                )));
            }
            let header = serde_json::from_slice(&text);
            return header.map(Some).map_err(|cause| no_results(cause.to_string()));
        }
        // Something else that just has no end of line is not to be taken for a torn header.
        let is_torn = text.starts_with(BEGINNING) || BEGINNING.starts_with(&text);
        if is_torn { Ok(None) } else { Err(no_results("it has no first line".to_owned())) }
    }

    /// The next line with its number; `None` if there is none, or only the torn end of one.
    pub(super) fn next(&mut self) -> Result<Option<(usize, String)>, ResultsError> {
        let text = self.read()?;
        Ok(text.ends_with(b"\n").then(|| (self.number, String::from_utf8_lossy(&text).into_owned())))
    }

    /// How many bytes there are without a torn end, when all has been read.
    pub(super) fn whole(&self) -> u64 {
        self.whole
    }

    fn read(&mut self) -> Result<Vec<u8>, ResultsError> {
        let mut text = Vec::new();
        let limit = LINE_LIMIT as u64 + 1;
        let read = self.reader.by_ref().take(limit).read_until(b'\n', &mut text);
        let length = read.map_err(ResultsError::file(self.path))?;
        self.number += 1;
        if length > LINE_LIMIT {
            return Err(ResultsError::LongLine { path: self.path.to_owned(), line: self.number });
        }
        if text.ends_with(b"\n") {
            self.whole += length as u64;
        }
        Ok(text)
    }
}
